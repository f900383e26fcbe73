/// A made-up drive at the level of keyframes and detections: no images, exact truth.
#pragma once

#include <mrpt/core/Clock.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/CObservationDetectedObjects.h"
#include "djpete/obs/CObservationVisualKeyframe.h"
#include "djpete_test/random.h"

namespace djpete_test {

using djpete::geometry::SE3;
using djpete::geometry::Vec2;
using djpete::geometry::Vec3;
using djpete::geometry::Vec6;

struct DriveOptions {
    uint64_t seed = 1;
    unsigned frames = 100, keyframeEvery = 3;
    double dt_s = 0.1, speed_mps = 8, yawRate_radps = 0.03;
    // Features.
    double pointsPerMetre = 6, maxPointRange_m = 60, pixelSigma_px = 0.5, outlierShare = 0.02;
    enum class Depth { Stereo, Lidar, None } depth = Depth::Stereo;
    /// Features carry descriptors that depend on the point, with this share of bits wrong, and a
    /// point that comes into view again is a new track.
    bool descriptors = false;
    double wrongBitShare = 0.06;
    /// The road is a circle and points and cars stand along its first lap only.
    bool circle = false;
    // Odometry: noise per frame, and a share of the way that is always too long.
    double odometrySigma_m = 0.02, odometrySigma_rad = 0.002, odometryScaleError = 0.01;
    // Detections.
    double spacing_m = 9, range_m = 40;  ///< parked cars on both sides
    unsigned movingCars = 3;             ///< ahead; oncoming; turning off
    double detectionSigma_m = 0.3, detectionSigma_rad = 5 * M_PI / 180, sizeSigma_m = 0.1;
    double missShare = 0, falsePerFrame = 0, headingFlipShare = 0;
};

/// A car that keeps its body twist.
struct TrueCar {
    SE3 T_world_start;
    Vec6 twist = Vec6::Zero();
    Vec3 size_m{4.2, 1.7, 1.5};
    SE3 T_world_obj(double t_s) const { return T_world_start * SE3::exp(t_s * twist); }
    bool moving() const { return twist.norm() > 0; }
};

struct DriveFrame {
    djpete::obs::CObservationVisualKeyframe::Ptr keyframe;
    djpete::obs::CObservationDetectedObjects::Ptr detections;
    SE3 T_world_cam;         ///< truth
    std::vector<int> carOf;  ///< car of each detection, -1: false alarm
    double time_s = 0;
};

struct SyntheticDrive {
    std::vector<TrueCar> cars;
    std::vector<DriveFrame> frames;
    std::vector<unsigned> seen;  ///< detections of each car
};

inline djpete::geometry::StereoCamera kittiCamera() {
    return {718.856, 718.856, 607.1928, 185.2157, 0.537, 1241, 376};
}
inline SE3 kittiCameraOnVehicle() {
    return {djpete::geometry::opticalToVehicleAxes().rotation(), Vec3(0.27, 0, -0.08)};
}

class DriveMaker {
  public:
    explicit DriveMaker(const DriveOptions& options) : o_(options), random_(options.seed) {}

    SyntheticDrive make() {
        double length = o_.speed_mps * o_.dt_s * o_.frames + o_.maxPointRange_m;
        if (o_.circle) length = std::min(length, lap_m() + 22);
        makePoints(length);
        makeCars(length);
        drive_.seen.assign(drive_.cars.size(), 0);
        for (unsigned i = 0; i < o_.frames; ++i) makeFrame(i);
        return std::move(drive_);
    }

  private:
    double lap_m() const { return 2 * M_PI * o_.speed_mps / o_.yawRate_radps; }

    /// The vehicle after driving `s` metres: an arc. `side`, `up`: beside it.
    SE3 onRoad(double s_m, double side_m = 0, double up_m = 0) const {
        Vec6 twist = Vec6::Zero();
        twist[0] = s_m;
        twist[5] = s_m / o_.speed_mps * o_.yawRate_radps;
        return SE3::exp(twist) * SE3::fromYaw(0, Vec3(0, side_m, up_m));
    }

    void makePoints(double length_m) {
        const auto n = static_cast<unsigned>(o_.pointsPerMetre * length_m);
        for (unsigned i = 0; i < n; ++i) {
            const double s = random_.uniform(2, length_m), height = random_.uniform(-1.6, 6);
            const double side = random_.uniform(6, 18) * (random_.uniform() < 0.5 ? -1 : 1);
            points_.push_back(onRoad(s, side, height).translation());
        }
    }

    void makeCars(double length_m) {
        const double up = -1.73 + 0.75;
        for (double s = 10; s < length_m - 20; s += o_.spacing_m) {
            const double side = drive_.cars.size() % 2 == 0 ? 6 : -6;
            TrueCar car;
            const double yaw = random_.normal(0.05) + (random_.uniform() < 0.5 ? M_PI : 0);
            car.T_world_start =
                onRoad(s, side + random_.normal(0.2), up) * SE3::fromYaw(yaw, Vec3::Zero());
            car.size_m += random_.normal3(0.1);
            drive_.cars.push_back(car);
        }
        const double turn = o_.yawRate_radps / o_.speed_mps;  // of the road, rad per metre
        for (unsigned i = 0; i < o_.movingCars; ++i) {
            TrueCar car;
            if (i % 3 == 0) {
                car.T_world_start = onRoad(14, 0, up);
                car.twist << o_.speed_mps + 1, 0, 0, 0, 0, (o_.speed_mps + 1) * turn;
            } else if (i % 3 == 1) {
                car.T_world_start = onRoad(100, 3, up) * SE3::fromYaw(M_PI, Vec3::Zero());
                car.twist << 12, 0, 0, 0, 0, -12 * turn;
            } else {
                car.T_world_start = onRoad(30, -2.5, up);
                car.twist << 5, 0, 0, 0, 0, -0.25;
            }
            drive_.cars.push_back(car);
        }
    }

    void makeFrame(unsigned i) {
        DriveFrame frame;
        frame.time_s = i * o_.dt_s;
        const SE3 T_vehicle_cam = kittiCameraOnVehicle();
        const SE3 T_world_vehicle = onRoad(o_.speed_mps * frame.time_s);
        frame.T_world_cam = T_world_vehicle * T_vehicle_cam;
        advanceOdometry(frame.T_world_cam, i == 0);

        auto kf = djpete::obs::CObservationVisualKeyframe::Create();
        kf->frame = {i};
        kf->timestamp = mrpt::Clock::fromDouble(1.3e9 + frame.time_s);
        kf->isKeyframe = i % o_.keyframeEvery == 0;
        kf->camera = kittiCamera();
        if (o_.depth != DriveOptions::Depth::Stereo) kf->camera.baseline_m = 0;
        kf->sensorPose = djpete::geometry::toCPose3D(T_vehicle_cam);
        kf->T_odom_cam = T_odom_cam_;
        if (kf->isKeyframe) addFeatures(frame.T_world_cam, *kf);
        frame.keyframe = kf;
        addDetections(T_world_vehicle, frame);
        T_world_camBefore_ = frame.T_world_cam;
        drive_.frames.push_back(std::move(frame));
    }

    void advanceOdometry(const SE3& T_world_cam, bool first) {
        if (first) return;
        SE3 step = T_world_camBefore_.inverse() * T_world_cam;
        Vec6 noise;
        noise << random_.normal3(o_.odometrySigma_m), random_.normal3(o_.odometrySigma_rad);
        step.translation() *= 1 + o_.odometryScaleError;
        T_odom_cam_ = (T_odom_cam_ * step * SE3::exp(noise)).normalised();
    }

    void addFeatures(const SE3& T_world_cam, djpete::obs::CObservationVisualKeyframe& kf) {
        const auto camera = kittiCamera();
        const SE3 T_cam_world = T_world_cam.inverse();
        for (std::size_t j = 0; j < points_.size(); ++j) {
            const Vec3 p_cam = T_cam_world * points_[j];
            if (p_cam.z() < 2 || p_cam.z() > o_.maxPointRange_m) continue;
            const Vec3 uvu = camera.projectStereo(p_cam);
            if (!camera.contains(uvu.head<2>(), 5) || uvu.z() < 5) continue;
            djpete::obs::KeyframeFeature f;
            const bool outlier = random_.uniform() < o_.outlierShare;
            Vec3 noise = random_.normal3(o_.pixelSigma_px);
            if (outlier) {  // a wrong track, with a right stereo match
                const double du = random_.normal(30), dv = random_.normal(30);
                noise += Vec3(du, dv, du);
            }
            f.track = {j};
            if (o_.descriptors) knowAgain(j, kf.frame.value, f);
            f.u_px = static_cast<float>(uvu.x() + noise.x());
            f.v_px = static_cast<float>(uvu.y() + noise.y());
            f.sigma_px = f.uRightSigma_px = static_cast<float>(o_.pixelSigma_px);
            if (o_.depth == DriveOptions::Depth::Stereo) {
                f.uRight_px = static_cast<float>(uvu.z() + noise.z());
            } else if (o_.depth == DriveOptions::Depth::Lidar && j % 2 == 0) {
                f.depth_m = static_cast<float>(p_cam.z() + random_.normal(0.03));
                f.depthSigma_m = 0.03F;
            }
            kf.features.push_back(f);
        }
    }

    /// Gives the feature its descriptor and the number of the point's present track.
    void knowAgain(std::size_t point, uint64_t frame, djpete::obs::KeyframeFeature& f) {
        auto& seen = sightings_[point];
        const bool gone = seen.lastFrame + 2 * o_.keyframeEvery < frame;
        if (seen.tracks == 0 || gone) ++seen.tracks;
        seen.lastFrame = frame;
        f.track.value = point + 1'000'000 * (seen.tracks - 1);
        std::mt19937_64 ofPoint(point + 77);
        f.descriptor.emplace();
        for (uint64_t& bits : *f.descriptor) {
            bits = ofPoint();
            for (unsigned b = 0; b < 64; ++b) {
                if (random_.uniform() < o_.wrongBitShare) bits ^= uint64_t{1} << b;
            }
        }
    }

    djpete::obs::ObjectDetection detection(const SE3& T_sensor_obj, const Vec3& size_m) {
        djpete::obs::ObjectDetection d;
        Vec6 noise;
        const double tilt = 0.02;
        noise << random_.normal3(o_.detectionSigma_m), random_.normal(tilt), random_.normal(tilt),
            random_.normal(o_.detectionSigma_rad);
        d.T_sensor_obj = T_sensor_obj * SE3::exp(noise);
        if (random_.uniform() < o_.headingFlipShare) {
            d.T_sensor_obj = d.T_sensor_obj * SE3::fromYaw(M_PI, Vec3::Zero());
        }
        d.size_m = size_m + random_.normal3(o_.sizeSigma_m);
        d.information = djpete::obs::diagonalInformation(Vec3::Constant(o_.detectionSigma_m),
                                                         Vec3(tilt, tilt, o_.detectionSigma_rad));
        d.score = 0.9F;
        d.source = "synthetic";
        return d;
    }

    void addDetections(const SE3& T_world_vehicle, DriveFrame& frame) {
        auto out = djpete::obs::CObservationDetectedObjects::Create();
        out->timestamp = frame.keyframe->timestamp;
        const SE3 T_vehicle_world = T_world_vehicle.inverse();
        for (std::size_t c = 0; c < drive_.cars.size(); ++c) {
            const SE3 T_vehicle_obj = T_vehicle_world * drive_.cars[c].T_world_obj(frame.time_s);
            const Vec3& p = T_vehicle_obj.translation();
            const bool visible =
                p.x() > 3 && p.norm() < o_.range_m && std::abs(p.y()) < 0.9 * p.x();
            if (!visible || random_.uniform() < o_.missShare) continue;
            out->detections.push_back(detection(T_vehicle_obj, drive_.cars[c].size_m));
            frame.carOf.push_back(static_cast<int>(c));
            ++drive_.seen[c];
        }
        if (random_.uniform() < o_.falsePerFrame) {
            const Vec3 p(random_.uniform(5, 40), random_.uniform(-15, 15), -1);
            out->detections.push_back(
                detection(SE3::fromYaw(random_.uniform(-3, 3), p), Vec3(4, 1.7, 1.5)));
            frame.carOf.push_back(-1);
        }
        frame.detections = out;
    }

    DriveOptions o_;
    Random random_;
    SyntheticDrive drive_;
    std::vector<Vec3> points_;
    struct Sightings {
        uint64_t lastFrame = 0, tracks = 0;
    };
    std::map<std::size_t, Sightings> sightings_;
    SE3 T_odom_cam_ = kittiCameraOnVehicle(), T_world_camBefore_;
};

/// The same drive for the same options.
inline SyntheticDrive makeDrive(const DriveOptions& options) { return DriveMaker(options).make(); }

}  // namespace djpete_test
