/// What a map consists of: plain data, no scratch fields of any algorithm.
#pragma once

#include <mrpt/core/Clock.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"
#include "djpete/obs/CObservationVisualKeyframe.h"
#include "djpete/obs/detection.h"
#include "djpete/obs/ids.h"

namespace djpete::map {

using obs::FrameId;
using KeyframeId = obs::Id<struct KeyframeTag>;
using LandmarkId = obs::Id<struct LandmarkTag>;
using ObjectId = obs::Id<struct ObjectTag>;
/// Counts every change of the map.
using MapRevision = obs::Id<struct RevisionTag>;

/// A map may hold several drives, one after the other; the frames of drive s have the numbers
/// s * kFramesPerDrive + the drive's own.
constexpr uint64_t kFramesPerDrive = 1'000'000;

struct Keyframe {
    KeyframeId id;
    /// Within a segment odometry went on without a break; ids of segments rise with those of
    /// keyframes. A new drive, or one that was lost, begins a new one.
    uint32_t segment = 0;
    /// T_world_cam of keyframes of one world can be compared. A new segment is a world of its own
    /// until its place is known again in an older one.
    uint32_t world = 0;
    FrameId frame;
    mrpt::Clock::time_point stamp;
    geometry::StereoCamera camera;
    geometry::SE3 T_vehicle_cam;
    geometry::SE3 T_odom_cam;   ///< as the front end gave it; never changed
    geometry::SE3 T_world_cam;  ///< the estimate
    std::vector<obs::KeyframeFeature> features;
    /// Landmark of each feature; same length as features.
    std::vector<std::optional<LandmarkId>> landmarks;
    /// Motion since an earlier keyframe, as scans measured it; never changed.
    std::optional<obs::ScanMotion> scanMotion;
};

/// Where a frame's camera is: on its reference keyframe plus odometry. Every frame has one,
/// keyframes too (with T_ref_cam identity), so the whole trajectory follows the optimised
/// keyframes.
struct FramePose {
    FrameId frame;
    mrpt::Clock::time_point stamp;
    KeyframeId reference;
    geometry::SE3 T_ref_cam;
    bool tracked = true;
};

/// Two views of one place that the map believes to be so.
struct LoopRecord {
    KeyframeId older, newer;
    FrameId olderFrame, newerFrame;
    geometry::SE3 T_older_newer;  ///< as measured, cameras
    std::size_t features = 0;     ///< that agree
    bool near = false;            ///< found where the map said, not by its look
    bool joined = false;          ///< two worlds became one
    /// How far the newer keyframe was from where the pair puts it.
    double correction_m = 0, correction_rad = 0;
};

struct Landmark {
    LandmarkId id;
    geometry::Vec3 p_world{0, 0, 0};
    std::array<uint8_t, 3> rgb{128, 128, 128};
    std::map<KeyframeId, uint32_t> observations;  ///< keyframe -> index of the feature in it
};

/// One detection that belongs to an object: the camera-object edge.
struct ObjectObservation {
    FrameId frame;
    geometry::SE3 T_cam_obj;     ///< measured, after any heading flip chosen by the association
    geometry::Mat6 information;  ///< of T_cam_obj, frame obj
    geometry::Vec3 size_m{0, 0, 0};
    float score = 0;
    obs::ObjectClass objectClass = obs::ObjectClass::Car;
    std::optional<obs::ImageBox> box;
    std::optional<obs::RleMask> mask;
    obs::ObjectPointsPtr points;  ///< of a scan, frame cam; may be null; map files do not keep them
    std::string source;
};

/// Where an object is at the time of one frame. The pose is stored relative to the camera of a
/// keyframe, so that an object moves along when that camera is corrected.
struct ObjectState {
    FrameId frame;
    KeyframeId anchor;
    geometry::SE3 T_anchor_obj;                     ///< anchor = camera of the anchor keyframe
    geometry::Vec6 twist = geometry::Vec6::Zero();  ///< (m/s, rad/s) in obj; zero when static
    geometry::Mat6 covariance =
        geometry::Mat6::Identity();  ///< of the pose given the cameras, frame obj
};

struct ObjectTrack {
    ObjectId id;
    obs::ObjectClass objectClass = obs::ObjectClass::Car;
    geometry::Vec3 size_m{0, 0, 0};  ///< (length, width, height)
    bool moving = false;
    std::map<FrameId, ObjectObservation> observations;
    /// Estimates at every observed frame; a static object has the same world pose in all of them.
    std::map<FrameId, ObjectState> states;
    /// Of a standing object, once the drive is over: T_cam_obj in the frames that saw it, smoothed
    /// in time with cameras that may err by a small share of their way. What the one world pose is
    /// for all views together, this is for each. Not kept in map files.
    std::map<FrameId, geometry::SE3> views;
};

}  // namespace djpete::map
