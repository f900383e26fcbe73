/// What the front end hands to the back end: one frame's pose and the features it followed.
#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/opengl/Visualizable.h>
#include <mrpt/poses/CPose3D.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"
#include "djpete/obs/ids.h"

namespace djpete::obs {

/// 256 comparisons of grey levels about a corner; two views of one corner differ in few bits.
using Descriptor = std::array<uint64_t, 4>;

/// One followed corner in a keyframe.
struct KeyframeFeature {
    TrackId track;                   ///< same track in other keyframes: same physical point
    float u_px = 0, v_px = 0;        ///< left image
    float sigma_px = 1;              ///< standard deviation of u, v
    std::optional<float> uRight_px;  ///< matching column in the rectified right image
    float uRightSigma_px = 1;        ///< of the column in the right image
    std::optional<float> depth_m;    ///< z in cam, measured by LiDAR (not from disparity)
    float depthSigma_m = 0;          ///< of depth_m
    std::array<uint8_t, 3> rgb{128, 128, 128};  ///< colour at the corner, for display
    std::optional<Descriptor> descriptor;       ///< how the corner looks, to know it again
};

/// The camera's motion since an earlier keyframe, measured by matching their LiDAR scans.
struct ScanMotion {
    FrameId from;              ///< frame of that keyframe
    geometry::SE3 T_from_cam;  ///< cam now in cam then
    /// Of T_from_cam, in the frame of the camera now (size 6 as everywhere).
    geometry::Mat6 information = geometry::Mat6::Zero();
};

/// A frame of visual odometry. Keyframes carry features; other frames carry their pose only
/// (isKeyframe false, no features), so that the whole trajectory can be replayed without images.
/// The pose is in `odom`: the front end's own world, never corrected by the map.
class CObservationVisualKeyframe : public mrpt::obs::CObservation,
                                   public mrpt::opengl::Visualizable {
    DEFINE_SERIALIZABLE(CObservationVisualKeyframe, djpete::obs)

  public:
    FrameId frame;
    bool isKeyframe = true;
    /// False when odometry could not measure this frame and only predicted it.
    bool tracked = true;
    geometry::StereoCamera camera;
    geometry::SE3 T_odom_cam;
    std::vector<KeyframeFeature> features;
    std::optional<ScanMotion> scanMotion;  ///< keyframes only, if there are scans
    mrpt::poses::CPose3D sensorPose;       ///< T_vehicle_cam

    void getSensorPose(mrpt::poses::CPose3D& out_sensorPose) const override {
        out_sensorPose = sensorPose;
    }
    void setSensorPose(const mrpt::poses::CPose3D& newSensorPose) override {
        sensorPose = newSensorPose;
    }
    void getDescriptionAsText(std::ostream& o) const override;
    bool exportTxtSupported() const override { return true; }
    std::string exportTxtHeader() const override;
    std::string exportTxtDataRow() const override;
    /// Features with depth as a point cloud in the vehicle frame.
    void getVisualizationInto(mrpt::opengl::CSetOfObjects& o) const override;
};

}  // namespace djpete::obs
