/// What is true of an object in chosen frames. Private to the room.
#pragma once

#include <optional>
#include <vector>

#include "djpete/evaluation/texture_evaluation.h"

namespace djpete::evaluation {

/// Makes views of one object and its actor; keeps the instance images it has read.
class TruthViews {
  public:
    TruthViews(const EstimatedDrive& estimate, const TrueDrive& truth)
        : estimate_(estimate), truth_(truth) {}

    /// The mask of the actor; read from the file the first time.
    MaskImage mask(int64_t actor, std::size_t frame);
    /// Nothing if either pose is unknown in that frame or the actor is not before the camera.
    std::optional<TruthView> view(int64_t object, int64_t actor, const TruthMesh& mesh,
                                  std::size_t frame);
    /// Frames that are no keyframes, with the actor large enough and within range, at most
    /// criteria.heldOut of them, nearest to the middle of all frames that see it so.
    std::vector<std::size_t> heldOutFrames(int64_t object, int64_t actor,
                                           const TextureCriteria& criteria);

  private:
    const EstimatedDrive& estimate_;
    const TrueDrive& truth_;
    std::map<std::size_t, InstanceImage> instances_;
};

}  // namespace djpete::evaluation
