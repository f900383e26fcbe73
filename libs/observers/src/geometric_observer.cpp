#include "djpete/observers/geometric_observer.h"

#include <algorithm>
#include <cmath>

#include "candidate.h"
#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"
#include "object_mask.h"

namespace djpete::observers {

namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

/// Best first; drops each candidate that overlaps a better one.
std::vector<Candidate> withoutOverlaps(std::vector<Candidate> candidates, double overlapMax) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    std::vector<Candidate> kept;
    for (auto& c : candidates) {
        const bool free = std::none_of(kept.begin(), kept.end(), [&](const Candidate& k) {
            return overlapOfSmaller(c.box, k.box) > overlapMax;
        });
        if (free) kept.push_back(std::move(c));
    }
    return kept;
}

/// Of the two lengthwise directions the one nearer to the vehicle's forward axis.
Vec2 headingOf(const Candidate& c, const SE3& T_vehicle_velo) {
    const Vec2 along = c.box.axis(c.lengthAxis);
    const Vec3 inVehicle = T_vehicle_velo.rotation() * Vec3(along.x(), along.y(), 0);
    const bool forward = std::abs(inVehicle.x()) > 1e-9 ? inVehicle.x() > 0 : inVehicle.y() > 0;
    return forward ? along : Vec2(-along);
}

SE3 poseOf(const Candidate& c, const GroundModel& ground, const SE3& T_vehicle_velo) {
    const Vec2 centre = c.box.centre(), heading = headingOf(c, T_vehicle_velo);
    const Vec3 up = ground.normal();
    Vec3 x(heading.x(), heading.y(), 0);
    x = (x - up.dot(x) * up).normalized();
    geometry::Mat3 R;
    R << x, up.cross(x), up;
    const Vec3 foot(centre.x(), centre.y(), ground.heightAt(centre.x(), centre.y()));
    return SE3(R, foot + 0.5 * c.height_m * up);
}

void addMask(obs::ObjectDetection& d, const Candidate& c, const GroundPlan& plan,
             const SE3& T_cam_velo, const geometry::StereoCamera& camera, double reach_m) {
    std::vector<Vec3> p_cam;
    for (uint32_t i : c.obstacles) {
        const auto& p = plan.obstacles()[i];
        p_cam.push_back(T_cam_velo * Vec3(p.x, p.y, p.z));
    }
    if (auto found = maskOfPoints(p_cam, camera, reach_m)) {
        d.mask = std::move(found->mask);
        d.box = found->box;
    }
}

void requireUsable(const GeometricObserverOptions& o) {
    const bool good = o.rangeMin_m >= 0 && o.rangeMax_m > o.rangeMin_m && o.rangeMax_m <= 200 &&
                      o.cell_m >= 0.05 && o.cell_m <= 1 && o.toleranceLevels >= 1 &&
                      o.toleranceLevels <= 8 && o.toleranceNear_m > 0 && o.tolerancePerRange >= 0;
    if (!good) {
        throw obs::InputError(
            "geometric observer: expected 0 <= rangeMin_m < rangeMax_m <= 200, cell_m in "
            "0.05..1, toleranceLevels in 1..8, toleranceNear_m > 0 and tolerancePerRange >= 0");
    }
}

}  // namespace

GeometricObserver::GeometricObserver(GeometricObserverOptions options)
    : options_(std::move(options)) {
    requireUsable(options_);
}

std::vector<obs::ObjectDetection> GeometricObserver::detect(const obs::LidarScan& scan,
                                                            const obs::RigCamera* camera) const {
    const Vec3 up = scan.T_vehicle_velo.rotation().transpose() * Vec3::UnitZ();
    const auto ground = GroundModel::fit(scan.points, up, options_.groundSlopeMax_deg,
                                         options_.rangeMin_m, options_.rangeMax_m);
    if (!ground) return {};
    const GroundPlan plan(scan, *ground, options_);
    std::vector<Candidate> candidates;
    for (const auto& cluster : clusterCells(plan, options_)) {
        auto c = judge(cluster, plan, options_);
        if (c && c->score >= options_.scoreMin) candidates.push_back(std::move(*c));
    }
    std::vector<obs::ObjectDetection> out;
    for (const auto& c : withoutOverlaps(std::move(candidates), options_.overlapMax)) {
        obs::ObjectDetection d;
        d.objectClass =
            c.height_m > options_.vanHeight_m ? obs::ObjectClass::Van : obs::ObjectClass::Car;
        d.score = static_cast<float>(c.score);
        d.size_m = Vec3(c.length_m(), c.width_m(), c.height_m);
        d.T_sensor_obj = poseOf(c, *ground, scan.T_vehicle_velo);
        d.information = obs::diagonalInformation(c.sigma_m, c.sigma_rad);
        d.source = name();
        if (camera != nullptr) {
            addMask(d, c, plan, camera->T_vehicle_cam.inverse() * scan.T_vehicle_velo,
                    camera->model, options_.maskDilation_m);
        }
        out.push_back(std::move(d));
    }
    return out;
}

obs::CObservationDetectedObjects::Ptr GeometricObserver::observe(const obs::SensorFrame& frame,
                                                                 const obs::LidarScan* scan,
                                                                 const obs::RigCamera* camera) {
    if (scan == nullptr) return nullptr;
    auto out = obs::CObservationDetectedObjects::Create();
    out->timestamp = frame.stamp;
    out->sensorLabel = obs::label::kDetections;
    out->sensorPose = geometry::toCPose3D(scan->T_vehicle_velo);
    out->detections = detect(*scan, camera);
    return out;
}

}  // namespace djpete::observers
