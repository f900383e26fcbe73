/// Silhouettes of a result's models against masks or boxes that a detector or a person gave to the
/// images of the drive. For real drives, of which no true shapes are known.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "djpete/evaluation/estimated_drive.h"
#include "djpete/evaluation/saved_models.h"
#include "djpete/evaluation/silhouette_pairs.h"

namespace djpete::evaluation {

/// What counts.
struct SilhouetteCriteria {
    double maxRange_m = 25;       ///< from the camera to the object, also in views
    std::size_t minViews = 3;     ///< of the model within the range
    double minInside = 0.8;       ///< share of the projected box's area that is in the image
    std::size_t minPixels = 400;  ///< of the visible silhouette; fewer: hidden
    double minVisible = 0.25;     ///< share of the silhouette that no other model hides
    double gap_m = 0.06;          ///< twice as wide ones between points are closed
    double minOverlap = 0.2;      ///< of the boxes of a pair, IoU
};

/// One silhouette in one frame with its truth, if it has one.
struct SilhouetteCase {
    int64_t object = 0;
    std::size_t frame = 0;
    geometry::SE3 T_cam_obj;           ///< camera of the masks
    std::optional<SilhouetteFit> fit;  ///< against a mask
    std::optional<double> cuboidIou;   ///< of the object's projected cuboid's box and the mask's
    std::optional<double> boxIou;      ///< of the silhouette's box and a box without mask
    obs::RleMask silhouette;           ///< visible part
    obs::RleMask ignored;              ///< masks of other instances
    std::optional<obs::RleMask> mask;  ///< with fit
    obs::ImageBox truthBox;
};

struct ObjectSilhouettes {
    int64_t object = 0;
    bool moving = false;
    std::size_t nearViews = 0;
    std::vector<SilhouetteCase> masked;  ///< rising frames; likewise the next
    std::vector<SilhouetteCase> boxed;   ///< in frames that have no masks at all
    std::vector<SilhouetteCase> alone;   ///< no truth's box overlaps
    std::size_t frames() const { return masked.size() + boxed.size() + alone.size(); }
    std::optional<double> iou, cuboidIou, excess, missing, boxIou;  ///< medians
    /// The case with the middle IoU; the middle one of those alone if there is no other. Null if
    /// there is none.
    const SilhouetteCase* typical() const;
};

struct DriveSilhouettes {
    std::vector<ObjectSilhouettes> objects;  ///< by id; only those with a frame that counts
    std::size_t fewViews = 0, noVehicle = 0, withoutFrame = 0;  ///< models left out
    std::size_t keyframes = 0;                                  ///< in the drive: never compared
    std::size_t framesWithMasks = 0, framesWithBoxes = 0;
    std::size_t framesEmpty = 0;                 ///< looked at, nothing detected
    std::size_t framesWithoutTruth = 0;          ///< nobody looked
    std::size_t hidden = 0, cut = 0;             ///< frames of an object that do not count, and why
    std::map<std::string, std::size_t> sources;  ///< what the truths call themselves, how many

    std::vector<double> ious() const;     ///< medians of the objects that have one
    std::vector<double> boxIous() const;  ///< likewise
};

/// Every frame from which no texture was made (no keyframe, and in no view of the object), all
/// models with one z-buffer. Truths are the detections of `detections` (a rawlog; may be the
/// drive's own) in that frame, except those of the GeometricObserver: they come from the scans that
/// made the models. Vehicles are paired with vehicles by their boxes. Only frames with no mask at
/// all compare boxes. Throws obs::InputError if a file cannot be read or has no truth for any frame
/// of the result.
DriveSilhouettes evaluateSilhouettes(const ObjectModels& models, const EstimatedDrive& estimate,
                                     const std::string& rawlog, const std::string& detections,
                                     const SilhouetteCriteria& criteria);

}  // namespace djpete::evaluation
