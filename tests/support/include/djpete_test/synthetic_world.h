/// A street that stands still: a stereo camera drives along a curve past points on the facades.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"

namespace djpete_test {

using djpete::geometry::SE3;
using djpete::geometry::StereoCamera;
using djpete::geometry::Vec2;
using djpete::geometry::Vec3;
using djpete::geometry::Vec6;

struct StreetOptions {
    int cameras = 10;
    int points = 300;
    double spacing_m = 1.0;  ///< between neighbouring cameras
    double turn_rad_per_m = 0.01;
    double maxDepth_m = 40;        ///< farther points are not observed
    int maxCamerasPerPoint = 100;  ///< an unobserved point is one seen by fewer than two cameras
    double sigma_px = 0;           ///< noise of u_left, v, u_right
    double outliers = 0;           ///< fraction of observations thrown anywhere into the image
    unsigned seed = 1;
};

struct StereoObservation {
    int camera = 0, point = 0;
    Vec3 uvu;  ///< u_left, v, u_right
    bool outlier = false;
};

/// The truth and what was seen of it. `world`: x forward, y left, z up; cameras look along the
/// street.
struct StreetWorld {
    StereoCamera camera;
    std::vector<SE3> T_world_cam;
    std::vector<Vec3> p_world;                    ///< each seen by two cameras at least
    std::vector<StereoObservation> observations;  ///< by point, then by camera
};

/// KITTI's grey pair.
inline StereoCamera kittiLikeCamera() {
    StereoCamera camera;
    camera.fx = camera.fy = 718.856;
    camera.cx = 607.1928;
    camera.cy = 185.2157;
    camera.baseline_m = 0.5372;
    camera.width_px = 1241;
    camera.height_px = 376;
    return camera;
}

/// Arc length `s` along the street's middle line: the vehicle's pose there.
inline SE3 streetPose(double s, double turn_rad_per_m) {
    Vec6 xi = Vec6::Zero();
    xi[0] = s;
    xi[5] = s * turn_rad_per_m;
    return SE3::exp(xi);
}

inline SE3 opticalOnVehicle() {
    djpete::geometry::Mat3 R;
    R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return {R, Vec3(0, 0, 1.65)};
}

inline Vec6 gaussianTwist(std::mt19937& rng, double sigma_m, double sigma_rad) {
    std::normal_distribution<double> n;
    Vec6 xi;
    for (int i = 0; i < 6; ++i) xi[i] = n(rng) * (i < 3 ? sigma_m : sigma_rad);
    return xi;
}

inline Vec3 gaussianVec3(std::mt19937& rng, double sigma) {
    std::normal_distribution<double> n;
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = sigma * n(rng);
    return v;
}

namespace detail {

/// A point on a facade or on the ground, at most 40 m ahead of the last camera.
inline Vec3 facadePoint(const StreetOptions& o, std::mt19937& rng) {
    std::uniform_real_distribution<double> u(0, 1);
    const double s = 4 + u(rng) * (o.cameras * o.spacing_m + 36);
    const double side = u(rng) < 0.5 ? -1 : 1;
    const bool ground = u(rng) < 0.25;
    const double lateral = ground ? 5 * u(rng) : 5 + 4 * u(rng);
    const double height = ground ? 0 : 5 * u(rng);
    return streetPose(s, o.turn_rad_per_m) * Vec3(0, side * lateral, height);
}

inline std::vector<StereoObservation> observe(const StreetWorld& w, const StreetOptions& o,
                                              const Vec3& p_world) {
    std::vector<StereoObservation> out;
    for (int c = 0; c < o.cameras && int(out.size()) < o.maxCamerasPerPoint; ++c) {
        const Vec3 p_cam = w.T_world_cam[std::size_t(c)].inverse() * p_world;
        if (p_cam.z() < 2 || p_cam.z() > o.maxDepth_m) continue;
        const Vec3 uvu = w.camera.projectStereo(p_cam);
        if (!w.camera.contains(uvu.head<2>()) || uvu.z() < 0) continue;
        StereoObservation seen;
        seen.camera = c;
        seen.uvu = uvu;
        out.push_back(seen);
    }
    return out;
}

}  // namespace detail

/// Builds the street; the same options give the same street.
inline StreetWorld makeStreet(const StreetOptions& o) {
    std::mt19937 rng(o.seed);
    std::uniform_real_distribution<double> u(0, 1);
    StreetWorld w;
    w.camera = kittiLikeCamera();
    for (int c = 0; c < o.cameras; ++c) {
        w.T_world_cam.push_back(streetPose(c * o.spacing_m, o.turn_rad_per_m) * opticalOnVehicle());
    }
    while (int(w.p_world.size()) < o.points) {
        const Vec3 p = detail::facadePoint(o, rng);
        auto seen = detail::observe(w, o, p);
        if (seen.size() < 2) continue;
        for (StereoObservation& z : seen) {
            z.point = int(w.p_world.size());
            z.uvu += gaussianVec3(rng, o.sigma_px);
            z.outlier = u(rng) < o.outliers;
            if (z.outlier) {
                const double u_left = u(rng) * w.camera.width_px;
                z.uvu = Vec3(u_left, u(rng) * w.camera.height_px, u_left - 60 * u(rng));
            }
            w.observations.push_back(z);
        }
        w.p_world.push_back(p);
    }
    return w;
}

}  // namespace djpete_test
