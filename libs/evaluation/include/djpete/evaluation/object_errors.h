/// How well a map's objects agree with labelled ones.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "djpete/evaluation/camera_path.h"
#include "djpete/evaluation/label_reader.h"
#include "djpete/evaluation/objects_csv.h"
#include "djpete/evaluation/statistics.h"

namespace djpete::evaluation {

enum class MotionSelection { All, StaticOnly, MovingOnly };

/// What counts as what.
struct ObjectCriteria {
    /// Labels that should be found. Labels of other classes only excuse: an object that lies on one
    /// is not false.
    std::set<obs::ObjectClass> classes{obs::ObjectClass::Car, obs::ObjectClass::Van,
                                       obs::ObjectClass::Truck};
    double gate_m = 2.0;        ///< farthest distance of two centres, from above, that are a match
    std::size_t minFrames = 5;  ///< a labelled track counts if it has so many boxes (in range)
    /// Boxes farther from the camera than this, from above, neither count nor are measured.
    std::optional<double> maxRange_m;
    MotionSelection motion = MotionSelection::All;
    /// A track is static if it never is so far from where it started. Real labels and reference
    /// cameras disagree by 0.4 to 0.8 m on KITTI's parked cars: take 2 m there.
    double staticBelow_m = 0.5;
    /// Labels exist only for what the camera sees (KITTI: 81 degrees wide). Objects outside this
    /// angle to both sides of its axis are not called false.
    double halfFieldOfView_deg = 40;
    /// A static track that has no box in range for so many frames is left; its next box is a second
    /// visit.
    std::size_t minGapFrames = 50;
};

/// One labelled object. Errors are medians over its matched rows.
struct TrackErrors {
    int64_t trackId = 0;
    obs::ObjectClass objectClass = obs::ObjectClass::Car;
    std::size_t labelledFrames = 0;
    bool moving = false;
    std::vector<int64_t> objectIds;  ///< objects of the map that are this one: none, one, or more
    std::size_t matchedRows = 0;
    std::size_t switches = 0;    ///< of the matched object, from one paired frame to the next
    std::size_t seenAgain = 0;   ///< second visits with a pair before and after the gap
    std::size_t knownAgain = 0;  ///< those whose object is the same
    std::optional<double> centre_m, bev_m, yaw_deg, yawModPi_deg;
};

/// Errors are over all matched rows of all counted tracks. Angles are absolute.
struct ObjectErrors {
    std::size_t labelled = 0, matchedOneToOne = 0, duplicated = 0, missed = 0;
    std::vector<int64_t> falseObjectIds;
    std::size_t withoutSwitch = 0;  ///< tracks found that keep one object over all their rows
    std::size_t switches = 0, seenAgain = 0, knownAgain = 0;  ///< of all counted tracks
    Summary centre_m, bev_m, yaw_deg, yawModPi_deg;
    Summary length_m, width_m, height_m;  ///< absolute differences of size
    /// Length of the velocity difference, of moving tracks where frames before and after are
    /// labelled; label velocities are finite differences.
    Summary velocity_mps;
    std::vector<TrackErrors> tracks;  ///< by track id
};

/// In each frame objects and boxes of the counted classes are paired one to one, nearest pairs
/// first (as seen from above, within the gate); an object left over votes for the nearest box
/// within the gate all the same, counted classes before others. Over the run each object belongs to
/// the track that got most of its votes. A track with one object is matched one to one, with more
/// duplicated, with none missed; identities follow the pairs themselves, whomever an object belongs
/// to; an object without any vote is false, unless it always was out of
/// view or range. Objects of a class that can be no counted one (a pedestrian among vehicles) are
/// left out.
/// `cameras` place the labels in the world; frames outside it are ignored. `motionCameras` tell
/// what moves: the true ones if there are any, else the same.
ObjectErrors evaluateObjects(const std::vector<ObjectRow>& objects,
                             const std::vector<LabelBox>& labels, const CameraPath& cameras,
                             const CameraPath& motionCameras, const ObjectCriteria& criteria);

}  // namespace djpete::evaluation
