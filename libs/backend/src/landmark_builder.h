/// From tracks of features to landmarks.
#pragma once

#include <deque>
#include <map>

#include "djpete/backend/backbone.h"
#include "djpete/backend/statistics.h"

namespace djpete::backend {

/// Connects each new keyframe's features with the landmarks of their tracks, and begins landmarks
/// from measured depth or by triangulation.
class LandmarkBuilder {
  public:
    void connect(map::SlamMap& map, map::KeyframeId keyframe, const BackboneOptions& options,
                 BackendStatistics& statistics);

    /// Keyframes before this one are of another drive, whose track numbers mean other tracks.
    void startAt(map::KeyframeId first) { first_ = first; }
    /// Later features of this feature's track are of `landmark`.
    void known(const map::Keyframe& keyframe, uint32_t feature, map::LandmarkId landmark) {
        if (keyframe.id >= first_) landmarkOf_[keyframe.features[feature].track] = landmark;
    }
    /// Call before `gone` is merged into `kept`: its tracks go on as `kept`.
    void merged(const map::SlamMap& map, map::LandmarkId kept, map::LandmarkId gone);

  private:
    struct Sighting {
        map::KeyframeId keyframe;
        uint32_t feature = 0;
    };
    void begin(map::SlamMap& map, const geometry::Vec3& p_world, const Sighting& now);
    void cullUnseen(map::SlamMap& map, BackendStatistics& statistics);

    map::KeyframeId first_;
    std::map<obs::TrackId, map::LandmarkId> landmarkOf_;  // may name landmarks that are gone
    std::map<obs::TrackId, Sighting> waiting_;            // first sighting of mono tracks
    std::deque<std::vector<map::LandmarkId>> begun_;      // per keyframe, the last few
};

}  // namespace djpete::backend
