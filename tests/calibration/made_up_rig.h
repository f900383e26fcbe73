/// A street of painted planes, seen by a stereo pair and a scanner whose true rig is known.
#pragma once

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "djpete/frontend/visual_odometry.h"

namespace djpete_test {

using djpete::geometry::SE3;
using djpete::geometry::StereoCamera;
using djpete::geometry::Vec3;

/// What is true of the rig beside its StereoCamera.
struct TrueRig {
    double rowOffset_px = 0;     ///< right image: row there minus row in the left image
    double rowPerColumn_px = 0;  ///< per unit of (u - cx) / fx
    double columnOffset_px = 0;  ///< right image's points lie this much farther left
    double baselineFactor = 1;   ///< true baseline over the stated one
    SE3 T_stated_true;           ///< true camera in the stated one
    double scanSigma_m = 0.01, imageSigma = 1.0;
};

class MadeUpStreet {
  public:
    MadeUpStreet() {
        camera.fx = camera.fy = 500;
        camera.cx = 399.5;
        camera.cy = 119.5;
        camera.baseline_m = 0.54;
        camera.width_px = 800;
        camera.height_px = 240;
        djpete::geometry::Mat3 R;
        R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
        T_vehicle_cam = SE3(R, Vec3(0.27, 0, -0.08));
    }
    StereoCamera camera;  ///< as stated
    SE3 T_vehicle_cam;    ///< as stated

    struct Frame {
        djpete::frontend::OdometryInput input;
        djpete::obs::LidarScan scan;
        djpete::obs::CObservationVisualKeyframe odometry;
    };

    /// Frame `k`; the vehicle drives 2 m per frame.
    Frame frame(unsigned k, const TrueRig& rig) const {
        Frame out;
        const Vec3 at(2.0 * k, 0.2 * std::sin(k), 0);
        const SE3 T_world_vehicle = SE3::fromYaw(0.02 * std::sin(1.7 * k), at);
        const SE3 T_world_cam = T_world_vehicle * T_vehicle_cam * rig.T_stated_true;
        StereoCamera truth = camera;
        truth.baseline_m *= rig.baselineFactor;
        cv::Mat left(camera.height_px, camera.width_px, CV_8UC1), right = left.clone();
        for (int v = 0; v < left.rows; ++v) {
            for (int u = 0; u < left.cols; ++u) {
                left.at<uchar>(v, u) = shade(T_world_cam, camera.ray({u, v}), 0, k, rig);
                // Where the right image shows what an aligned one has at (x, y).
                const double x = u + rig.columnOffset_px;
                const double y =
                    v - rig.rowOffset_px - rig.rowPerColumn_px * (u - camera.cx) / camera.fx;
                right.at<uchar>(v, u) =
                    shade(T_world_cam, camera.ray({x, y}), truth.baseline_m, k + 1000, rig);
            }
        }
        auto& images = out.input.images;
        images.left = mrpt::img::CImage(left, mrpt::img::DEEP_COPY);
        images.right = mrpt::img::CImage(right, mrpt::img::DEEP_COPY);
        images.camera = {camera, T_vehicle_cam};
        out.input.frame = out.odometry.frame = {k};
        addFeatures(left, T_world_cam, truth, rig, out.odometry);
        out.scan = scanAt(T_world_vehicle, k, rig);
        return out;
    }

  private:
    /// Distance along the ray to the street: ground, two walls, a wall across, and two bays.
    static double distance(const Vec3& from, const Vec3& direction) {
        double best = 80;
        const auto plane = [&](int axis, double value, auto inside) {
            const double t = (value - from[axis]) / direction[axis];
            if (t > 0.5 && t < best && inside(Vec3(from + t * direction))) best = t;
        };
        const auto all = [](const Vec3&) { return true; };
        plane(2, -1.7, all);
        plane(1, 6, all);
        plane(1, -7, all);
        plane(0, 45, all);
        for (const double x : {9.0, 16.0, 24.0, 33.0}) {
            const double side = std::fmod(x, 2) < 0.5 ? 1 : -1;
            plane(0, x, [&](const Vec3& p) { return side * p.y() > 2.5 && p.z() < 1.5; });
        }
        return best;
    }

    static double hash(int64_t x, int64_t y, uint64_t z) {
        uint64_t h = uint64_t(x) * 0x9E3779B97F4A7C15ULL ^ uint64_t(y) * 0xC2B2AE3D27D4EB4FULL ^
                     (z + 1) * 0x165667B19E3779F9ULL;
        h = (h ^ (h >> 29)) * 0xBF58476D1CE4E5B9ULL;
        h = (h ^ (h >> 32)) * 0x94D049BB133111EBULL;
        return double(h >> 40) * 0x1p-24;
    }
    /// Mean 0, deviation about 1.
    static double noise(uint64_t a, uint64_t b, uint64_t c) {
        double sum = 0;
        for (uint64_t i = 0; i < 4; ++i) sum += hash(int64_t(a), int64_t(b), 8 * c + i) - 0.5;
        return sum * std::sqrt(3.0);
    }
    static double smooth(double x, double y, uint64_t layer) {
        const double fx = std::floor(x), fy = std::floor(y);
        const auto i = int64_t(fx), j = int64_t(fy);
        double a = x - fx, b = y - fy;
        a = a * a * a * (a * (6 * a - 15) + 10);
        b = b * b * b * (b * (6 * b - 15) + 10);
        return (1 - b) * ((1 - a) * hash(i, j, layer) + a * hash(i + 1, j, layer)) +
               b * ((1 - a) * hash(i, j + 1, layer) + a * hash(i + 1, j + 1, layer));
    }

    uchar shade(const SE3& T_world_cam, const Vec3& ray, double right_m, unsigned k,
                const TrueRig& rig) const {
        const Vec3 from = T_world_cam * Vec3(right_m, 0, 0);
        const Vec3 direction = T_world_cam.rotation() * ray;
        const double t = distance(from, direction);
        const Vec3 p = from + t * direction;
        double value = 0;
        for (uint64_t layer = 0; layer < 6; ++layer) {
            const double wave_m = 0.08 * double(1U << layer);
            const double blur = 2.5 * t / camera.fx / wave_m;
            if (blur > 3) continue;
            const double s = 1 / wave_m;
            value += std::exp(-blur * blur) *
                     (smooth(s * (p.x() + 0.37 * p.y()), s * (p.z() + 0.61 * p.y()), layer) - 0.5);
        }
        const auto pixel = uint64_t(ray.x() * 1e4 + 1e6) * 4096 + uint64_t(ray.y() * 1e4 + 1e5);
        const double grey = 128 + 130 * value + rig.imageSigma * noise(pixel, k, 3);
        return uchar(std::min(255.0, std::max(0.0, grey)));
    }

    /// Corners, with right columns about where odometry would find them along the same row.
    void addFeatures(const cv::Mat& left, const SE3& T_world_cam, const StereoCamera& truth,
                     const TrueRig& rig, djpete::obs::CObservationVisualKeyframe& out) const {
        std::vector<cv::Point2f> corners;
        cv::goodFeaturesToTrack(left, corners, 900, 0.02, 9);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const cv::Point2f c = corners[i];
            const Vec3 ray = camera.ray({double(c.x), double(c.y)});
            const double z = distance(T_world_cam.translation(), T_world_cam.rotation() * ray);
            djpete::obs::KeyframeFeature f;
            f.u_px = c.x;
            f.v_px = c.y;
            f.uRight_px = c.x - float(truth.fx * truth.baseline_m / z + rig.columnOffset_px) +
                          0.3F * float(int(i % 5) - 2) / 2;
            if (*f.uRight_px > 16) out.features.push_back(f);
        }
    }

    static djpete::obs::LidarScan scanAt(const SE3& T_world_vehicle, unsigned k,
                                         const TrueRig& rig) {
        djpete::obs::LidarScan scan;
        for (int beam = 0; beam < 64; ++beam) {
            const double up = (2.0 - 26.8 * beam / 63) * 0.0174533;
            for (int step = -270; step <= 270; ++step) {
                const double a = step * 0.17 * 0.0174533;
                const Vec3 ray(std::cos(up) * std::cos(a), std::cos(up) * std::sin(a),
                               std::sin(up));
                const double t =
                    distance(T_world_vehicle.translation(), T_world_vehicle.rotation() * ray) +
                    rig.scanSigma_m * noise(uint64_t(beam), uint64_t(step + 1000), k);
                const Vec3 p = t * ray;
                scan.points.push_back({float(p.x()), float(p.y()), float(p.z()), 0.3F});
            }
        }
        return scan;
    }
};

}  // namespace djpete_test
