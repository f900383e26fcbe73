#include "input_check.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "detection_noise.h"
#include "djpete/geometry/information.h"
#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"

namespace djpete::backend {

namespace {

using geometry::SE3;
using map::ObjectObservation;

constexpr double kLargestSize_m = 50;
/// Weight of a detection beyond this (1 mm, 0.06 degrees) is not believed, only used up to here.
constexpr double kLargestInformation = 1e6;
constexpr double kOrthonormal = 1e-4;

bool isMotion(const SE3& T) {
    if (!T.matrix().allFinite()) return false;
    const geometry::Mat3 E = T.rotation().transpose() * T.rotation() - geometry::Mat3::Identity();
    return E.cwiseAbs().maxCoeff() < kOrthonormal && T.rotation().determinant() > 0;
}

[[noreturn]] void bad(const obs::CObservationVisualKeyframe& frame, const std::string& what) {
    throw obs::InputError("frame " + std::to_string(frame.frame.value) + ": " + what);
}

bool finite(float x) { return std::isfinite(x); }

/// Why a detection cannot be used; null if it can.
const char* fault(const obs::ObjectDetection& d, const AssociationOptions& options) {
    if (options.vehiclesOnly && !obs::isVehicle(d.objectClass)) {
        return "detection of something that is not a vehicle";
    }
    if (!std::isfinite(d.score)) return "detection with a score that is not finite";
    if (static_cast<double>(d.score) < options.minScore) return "detection below the least score";
    if (!isMotion(d.T_sensor_obj)) return "detection with a pose that is not a rigid motion";
    if (!d.size_m.allFinite() || d.size_m.minCoeff() <= 0 || d.size_m.maxCoeff() > kLargestSize_m) {
        return "detection with an impossible size";
    }
    if (!geometry::sqrtInformation<6>(d.information) || d.information(0, 0) <= 0 ||
        d.information(1, 1) <= 0) {
        return "detection whose information is not a positive matrix";
    }
    return nullptr;
}

ObjectObservation observationOf(const obs::CObservationVisualKeyframe& frame,
                                const obs::ObjectDetection& d, const SE3& T_cam_sensor) {
    ObjectObservation o;
    o.frame = frame.frame;
    o.T_cam_obj = (T_cam_sensor * d.T_sensor_obj).normalised();
    const double largest = d.information.diagonal().maxCoeff();
    o.information = std::min(1.0, kLargestInformation / largest) *
                    (0.5 * (d.information + d.information.transpose()));
    o.size_m = d.size_m;
    o.score = d.score;
    o.objectClass = d.objectClass;
    if (d.box && finite(d.box->left) && finite(d.box->top) && finite(d.box->right) &&
        finite(d.box->bottom)) {
        o.box = d.box;
    }
    if (d.mask && d.mask->consistent()) o.mask = d.mask;
    o.appearance = d.appearance;
    if (d.points) o.points = std::make_shared<obs::ObjectPoints>(d.points->in(T_cam_sensor));
    o.source = d.source;
    return o;
}

}  // namespace

void requireGoodFrame(const obs::CObservationVisualKeyframe& frame, const map::SlamMap& map,
                      bool firstOfDrive) {
    const auto& c = frame.camera;
    if (!c.valid() || !std::isfinite(c.fx + c.fy + c.cx + c.cy + c.baseline_m)) {
        bad(frame, "its camera has no focal length, expected positive fx and fy");
    }
    if (!isMotion(frame.T_odom_cam)) {
        bad(frame, "its odometry pose is not a rigid motion, expected a finite pose");
    }
    if (!isMotion(geometry::fromCPose3D(frame.sensorPose))) {
        bad(frame, "the camera's pose on the vehicle is not finite");
    }
    if (frame.scanMotion && (!isMotion(frame.scanMotion->T_from_cam) ||
                             !geometry::sqrtInformation<6>(frame.scanMotion->information))) {
        bad(frame,
            "the motion measured by its scan is not usable, expected a rigid motion with a "
            "positive semi-definite information");
    }
    if (frame.timestamp == INVALID_TIMESTAMP) bad(frame, "it has no time stamp");
    if (map.frames().empty()) return;
    const auto& last = map.frames().rbegin()->second;
    if (frame.frame <= last.frame) {
        bad(frame, "comes after frame " + std::to_string(last.frame.value) +
                       ", expected frame numbers to rise");
    }
    if (!firstOfDrive && frame.timestamp <= last.stamp) {
        bad(frame,
            "its time stamp is not later than that of frame " + std::to_string(last.frame.value));
    }
}

std::vector<obs::KeyframeFeature> goodFeatures(const obs::CObservationVisualKeyframe& frame,
                                               BackendStatistics& statistics) {
    std::vector<obs::KeyframeFeature> out;
    std::set<obs::TrackId> tracks;
    for (obs::KeyframeFeature f : frame.features) {
        if (!finite(f.u_px) || !finite(f.v_px) || !(f.sigma_px > 0) || !finite(f.sigma_px)) {
            ++statistics.rejected["feature that is not finite"];
            continue;
        }
        if (!tracks.insert(f.track).second) {
            ++statistics.rejected["feature with the track of another one"];
            continue;
        }
        if (f.uRight_px && !(finite(*f.uRight_px) && f.uRightSigma_px > 0 &&
                             finite(f.uRightSigma_px) && *f.uRight_px <= f.u_px)) {
            ++statistics.rejected["right column that is not left of the left one"];
            f.uRight_px.reset();
        }
        if (f.depth_m && !(finite(*f.depth_m) && *f.depth_m > 0 && finite(f.depthSigma_m) &&
                           f.depthSigma_m > 0)) {
            ++statistics.rejected["depth that is not positive"];
            f.depth_m.reset();
        }
        out.push_back(f);
    }
    return out;
}

std::vector<ObjectObservation> goodDetections(const obs::CObservationVisualKeyframe& frame,
                                              const obs::CObservationDetectedObjects& detections,
                                              const AssociationOptions& options,
                                              BackendStatistics& statistics) {
    std::vector<ObjectObservation> out;
    statistics.detections += detections.detections.size();
    const SE3 T_vehicle_sensor = geometry::fromCPose3D(detections.sensorPose);
    if (!isMotion(T_vehicle_sensor)) {
        statistics.rejected["detection of a sensor whose pose is not finite"] +=
            detections.detections.size();
        return out;
    }
    const SE3 T_cam_sensor = geometry::fromCPose3D(frame.sensorPose).inverse() * T_vehicle_sensor;
    for (const auto& d : detections.detections) {
        if (const char* why = fault(d, options)) {
            ++statistics.rejected[why];
            continue;
        }
        auto o = observationOf(frame, d, T_cam_sensor);
        if (o.T_cam_obj.translation().norm() > options.maxRange_m) {
            ++statistics.rejected["detection beyond the range"];
            continue;
        }
        out.push_back(std::move(o));
    }
    if (out.size() > options.maxDetections) {
        std::stable_sort(out.begin(), out.end(),
                         [](const auto& a, const auto& b) { return a.score > b.score; });
        statistics.rejected["detection more than a frame may have"] +=
            out.size() - options.maxDetections;
        out.resize(options.maxDetections);
    }
    widen(out, options);
    return out;
}

}  // namespace djpete::backend
