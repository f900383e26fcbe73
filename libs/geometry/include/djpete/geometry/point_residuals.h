/// Residuals between a rectified camera and a map point: mono, stereo, and with a measured depth.
///
/// Variables: T_world_cam, p_world. Error: measured minus predicted, e = z - pi(T_world_cam^-1
/// p_world). With p_cam = T_world_cam^-1 p_world and the right perturbation d = (rho, phi) of
/// T_world_cam,
///     d p_cam = -rho + [p_cam]x phi + R_cam_world dp,   so   J_cam = dpi [I | -[p_cam]x],
///     J_point = -dpi R_cam_world.
/// A point nearer than kMinDepth_m (or behind the camera) has no error: std::nullopt.
#pragma once

#include <optional>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"

namespace djpete::geometry {

/// Depth below which a point counts as behind the camera.
constexpr double kMinDepth_m = 0.01;

namespace detail {

/// A point in normalised image coordinates: x = X/Z, y = Y/Z, w = 1/Z.
struct NormalisedPoint {
    Vec3 p_cam;
    double x, y, w;
};

inline std::optional<NormalisedPoint> normalise(const SE3& T_world_cam, const Vec3& p_world) {
    const Vec3 p_cam = T_world_cam.rotation().transpose() * (p_world - T_world_cam.translation());
    if (!(p_cam.z() >= kMinDepth_m)) {
        // NaN is no point behind a camera: let it through to show itself in the residual.
        if (p_cam.z() < kMinDepth_m) return std::nullopt;
    }
    const double w = 1.0 / p_cam.z();
    return NormalisedPoint{p_cam, p_cam.x() * w, p_cam.y() * w, w};
}

/// J_cam and J_point of e from its whitened derivative D = W dpi / d p_cam.
template <int N>
void pointJacobians(const Eigen::Matrix<double, N, 3>& D, const NormalisedPoint& n,
                    const SE3& T_world_cam, Eigen::Matrix<double, N, 6>* J_cam,
                    Eigen::Matrix<double, N, 3>* J_point) {
    const Vec3& p = n.p_cam;
    if (J_cam) {
        J_cam->template leftCols<3>() = D;
        // -D [p]x, column by column.
        J_cam->col(3) = p.y() * D.col(2) - p.z() * D.col(1);
        J_cam->col(4) = p.z() * D.col(0) - p.x() * D.col(2);
        J_cam->col(5) = p.x() * D.col(1) - p.y() * D.col(0);
    }
    if (J_point) J_point->noalias() = -D.lazyProduct(T_world_cam.rotation().transpose());
}

}  // namespace detail

/// Left image only: z = (u, v) in pixels.
class MonoPointResidual {
  public:
    static constexpr int kDim = 2;
    static constexpr const char* kName = "MonoPointResidual";

    /// `sqrt_information`: 1/sigma of u and v, per pixel.
    MonoPointResidual(const StereoCamera& camera, const Vec2& uv, const Vec2& sqrt_information)
        : ray_((uv.x() - camera.cx) / camera.fx, (uv.y() - camera.cy) / camera.fy),
          weight_(sqrt_information.x() * camera.fx, sqrt_information.y() * camera.fy) {}
    MonoPointResidual(const StereoCamera& camera, const Vec2& uv, double sqrt_information = 1)
        : MonoPointResidual(camera, uv, Vec2::Constant(sqrt_information)) {}

    std::optional<Vec2> operator()(const SE3& T_world_cam, const Vec3& p_world,
                                   Mat26* J_cam = nullptr, Mat23* J_point = nullptr) const {
        const auto n = detail::normalise(T_world_cam, p_world);
        if (!n) return std::nullopt;
        if (J_cam || J_point) {
            const double a = weight_.x() * n->w, b = weight_.y() * n->w;
            Mat23 D;
            D << a, 0, -a * n->x, 0, b, -b * n->y;
            detail::pointJacobians<2>(D, *n, T_world_cam, J_cam, J_point);
        }
        return Vec2(weight_.x() * (ray_.x() - n->x), weight_.y() * (ray_.y() - n->y));
    }

  private:
    Vec2 ray_;     // the measurement at z = 1
    Vec2 weight_;  // 1/sigma per unit of ray_
};

/// Rectified stereo pair: z = (u_left, v, u_right) in pixels.
class StereoPointResidual {
  public:
    static constexpr int kDim = 3;
    static constexpr const char* kName = "StereoPointResidual";

    /// `sqrt_information`: 1/sigma of u_left, v, u_right, per pixel. The camera must have a
    /// baseline.
    StereoPointResidual(const StereoCamera& camera, const Vec3& uvu, const Vec3& sqrt_information)
        : ray_((uvu.x() - camera.cx) / camera.fx, (uvu.y() - camera.cy) / camera.fy,
               (uvu.z() - camera.cx) / camera.fx),
          weight_(sqrt_information.x() * camera.fx, sqrt_information.y() * camera.fy,
                  sqrt_information.z() * camera.fx),
          baseline_m_(camera.baseline_m) {}
    StereoPointResidual(const StereoCamera& camera, const Vec3& uvu, double sqrt_information = 1)
        : StereoPointResidual(camera, uvu, Vec3::Constant(sqrt_information)) {}

    std::optional<Vec3> operator()(const SE3& T_world_cam, const Vec3& p_world,
                                   Mat36* J_cam = nullptr, Mat3* J_point = nullptr) const {
        const auto n = detail::normalise(T_world_cam, p_world);
        if (!n) return std::nullopt;
        const double x_right = n->x - baseline_m_ * n->w;
        if (J_cam || J_point) {
            const double a = weight_.x() * n->w, b = weight_.y() * n->w, c = weight_.z() * n->w;
            Mat3 D;
            D << a, 0, -a * n->x, 0, b, -b * n->y, c, 0, -c * x_right;
            detail::pointJacobians<3>(D, *n, T_world_cam, J_cam, J_point);
        }
        return Vec3(weight_.x() * (ray_.x() - n->x), weight_.y() * (ray_.y() - n->y),
                    weight_.z() * (ray_.z() - x_right));
    }

  private:
    Vec3 ray_;     // the measurement at z = 1: x_left, y, x_right
    Vec3 weight_;  // 1/sigma per unit of ray_
    double baseline_m_;
};

/// Left image and a measured depth (LiDAR): z = (u, v in pixels, 1/depth in 1/m). The inverse depth
/// is what an image constrains; near points then weigh as a stereo pair would weigh them.
class DepthPointResidual {
  public:
    static constexpr int kDim = 3;
    static constexpr const char* kName = "DepthPointResidual";

    /// `depth_m` > 0 along the optical axis, with its 1-sigma; `sqrt_information`: 1/sigma of u, v
    /// per pixel. To first order the inverse depth has sigma = sigma_depth_m / depth_m^2.
    DepthPointResidual(const StereoCamera& camera, const Vec2& uv, double depth_m,
                       double sigma_depth_m, const Vec2& sqrt_information)
        : ray_((uv.x() - camera.cx) / camera.fx, (uv.y() - camera.cy) / camera.fy, 1.0 / depth_m),
          weight_(sqrt_information.x() * camera.fx, sqrt_information.y() * camera.fy,
                  depth_m * depth_m / sigma_depth_m) {}
    DepthPointResidual(const StereoCamera& camera, const Vec2& uv, double depth_m,
                       double sigma_depth_m, double sqrt_information = 1)
        : DepthPointResidual(camera, uv, depth_m, sigma_depth_m, Vec2::Constant(sqrt_information)) {
    }

    std::optional<Vec3> operator()(const SE3& T_world_cam, const Vec3& p_world,
                                   Mat36* J_cam = nullptr, Mat3* J_point = nullptr) const {
        const auto n = detail::normalise(T_world_cam, p_world);
        if (!n) return std::nullopt;
        if (J_cam || J_point) {
            const double a = weight_.x() * n->w, b = weight_.y() * n->w;
            Mat3 D;
            D << a, 0, -a * n->x, 0, b, -b * n->y, 0, 0, -weight_.z() * n->w * n->w;
            detail::pointJacobians<3>(D, *n, T_world_cam, J_cam, J_point);
        }
        return Vec3(weight_.x() * (ray_.x() - n->x), weight_.y() * (ray_.y() - n->y),
                    weight_.z() * (ray_.z() - n->w));
    }

  private:
    Vec3 ray_;     // x, y at z = 1, and 1/depth
    Vec3 weight_;  // 1/sigma of each
};

}  // namespace djpete::geometry
