/// A rectified pinhole camera, alone or as the left of a stereo pair.
#pragma once

#include "djpete/geometry/types.h"

namespace djpete::geometry {

/// Rectified camera(s) without distortion. Frame `cam`: left optical, z forward, x right, y down.
/// Pixel centres are at integer coordinates (KITTI's and OpenCV's convention).
struct StereoCamera {
    double fx = 0, fy = 0, cx = 0, cy = 0;  ///< pixels
    double baseline_m = 0;  ///< left to right optical centre along +x; 0 means: no right camera
    int width_px = 0, height_px = 0;

    bool hasRight() const { return baseline_m > 0; }
    bool valid() const { return fx > 0 && fy > 0; }

    /// pi(X): pixel (u, v) of X in `cam`. Requires X.z() != 0.
    Vec2 project(const Vec3& p_cam) const {
        return {fx * p_cam.x() / p_cam.z() + cx, fy * p_cam.y() / p_cam.z() + cy};
    }
    /// (u_left, v, u_right). Requires X.z() != 0.
    Vec3 projectStereo(const Vec3& p_cam) const {
        const Vec2 uv = project(p_cam);
        return {uv.x(), uv.y(), uv.x() - fx * baseline_m / p_cam.z()};
    }
    /// Direction with z = 1 through pixel (u, v).
    Vec3 ray(const Vec2& uv) const { return {(uv.x() - cx) / fx, (uv.y() - cy) / fy, 1.0}; }
    Vec3 backProject(const Vec2& uv, double depth_m) const { return depth_m * ray(uv); }
    /// Depth of a disparity u_left - u_right in pixels, which must be > 0.
    double depthFromDisparity(double disparity_px) const { return fx * baseline_m / disparity_px; }
    bool contains(const Vec2& uv, double border_px = 0) const {
        return uv.x() >= border_px && uv.y() >= border_px && uv.x() <= width_px - 1 - border_px &&
               uv.y() <= height_px - 1 - border_px;
    }
};

}  // namespace djpete::geometry
