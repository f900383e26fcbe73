#include "djpete/backend/association.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "djpete/map/object_rules.h"
#include "djpete/obs/overlap.h"
#include "djpete/solver/assignment.h"

namespace djpete::backend {

namespace {

using geometry::Mat3;
using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using map::ObjectObservation;
using obs::UprightBox;

/// Cost of leaving a thing without a detection; above any cost that the gate lets through.
constexpr double kUnassigned = 200;
/// Farther from where it was, a thing cannot be.
constexpr double kFar_m = 60;
constexpr double kBig = std::numeric_limits<double>::infinity();
/// New size = old + this share of the difference, once a few were averaged.
constexpr double kSizeMemory = 0.05;

/// Covariance of an information matrix; what it says nothing of gets 1-sigma of 10 (m, rad).
Mat6 covarianceOf(const Mat6& information) {
    return (information + 0.01 * Mat6::Identity()).inverse();
}

PositionYaw positionYaw(const SE3& T_world_obj, const Mat6& information,
                        const AssociationOptions& options) {
    const Mat6 covariance = covarianceOf(information);
    const Mat3& R = T_world_obj.rotation();
    const double floor2 = options.positionFloor_m * options.positionFloor_m;
    PositionYaw z;
    z.p_world = T_world_obj.translation();
    z.covariance = R * covariance.topLeftCorner<3, 3>() * R.transpose() + floor2 * Mat3::Identity();
    z.yaw_rad = T_world_obj.yaw_rad();
    z.yawVariance = covariance(5, 5) + options.yawFloor_rad * options.yawFloor_rad;
    return z;
}

/// True if `yaw_rad` points more backward than forward along `heading_rad`.
bool opposite(double yaw_rad, double heading_rad) {
    return std::abs(geometry::wrapAngle(yaw_rad - heading_rad)) > M_PI / 2;
}

bool sameKind(obs::ObjectClass a, obs::ObjectClass b) {
    return a == b || (obs::isVehicle(a) && obs::isVehicle(b));
}

double sizeDifference(const Vec3& a, const Vec3& b) {
    return (a.array() / b.array()).log().abs().sum();
}

struct Seen {
    ObjectObservation observation;
    SE3 T_world_obj;
    PositionYaw z;
    UprightBox box;
};

/// Cost of giving `seen` to `thing`; infinite outside the gates.
double costOf(const TrackedThing& thing, const Seen& seen, const AssociationOptions& options) {
    if (!sameKind(thing.objectClass, seen.observation.objectClass)) return kBig;
    if ((thing.filter.p_world() - seen.z.p_world).squaredNorm() > kFar_m * kFar_m) return kBig;
    const auto match = thing.filter.match(seen.z);
    double yawError = geometry::wrapAngle(seen.z.yaw_rad - thing.filter.yaw_rad());
    if (std::abs(yawError) > M_PI / 2) yawError = geometry::wrapAngle(yawError + M_PI);
    const double yawDistance =
        yawError * yawError / (thing.filter.yawVariance() + seen.z.yawVariance);
    const double distance = match.distance2 + std::min(yawDistance, options.maxYawDistance);
    if (!(distance <= options.gate)) return kBig;

    const UprightBox predicted{match.p_world, thing.filter.yaw_rad(), thing.size_m};
    if (thing.hits >= 2 && obs::birdsEyeOverlap(predicted.grown(options.overlapMargin_m),
                                                seen.box.grown(options.overlapMargin_m)) <= 0) {
        return kBig;
    }
    double cost = distance + match.logDeterminant - 2 * match.logWeight;
    cost += options.overlapWeight * (1 - obs::volumeOverlap(predicted, seen.box));
    cost += options.sizeWeight * sizeDifference(thing.size_m, seen.observation.size_m);
    if (thing.lastBox && seen.observation.box && thing.misses == 0) {
        cost += options.imageOverlapWeight *
                (1 - obs::imageOverlap(*thing.lastBox, *seen.observation.box));
    }
    return cost;
}

void hit(TrackedThing& thing, Seen& seen, const ObjectAssociator::Frame& frame,
         const AssociationOptions& options) {
    if (thing.hits > 0) {
        if (opposite(seen.z.yaw_rad, thing.filter.yaw_rad())) {
            seen.observation = map::turnedRound(std::move(seen.observation));
            seen.z.yaw_rad = geometry::wrapAngle(seen.z.yaw_rad + M_PI);
        }
        thing.filter.update(seen.z, options.filter);
        const double share = std::max(1.0 / (thing.hits + 1.0), kSizeMemory);
        thing.size_m += share * (seen.observation.size_m - thing.size_m);
    } else {
        thing.filter = ObjectFilter(seen.z, options.filter);
        thing.size_m = seen.observation.size_m;
        thing.objectClass = seen.observation.objectClass;
    }
    ++thing.hits;
    ++thing.frames;
    thing.misses = 0;
    thing.lastSeen_s = frame.time_s;
    thing.lastBox = seen.observation.box;
    thing.anchor = frame.anchor;
    thing.T_world_anchor = frame.T_world_anchor;
    thing.waiting.push_back(std::move(seen.observation));
}

std::vector<Seen> prepare(const ObjectAssociator::Frame& frame,
                          std::vector<ObjectObservation> detections,
                          const AssociationOptions& options) {
    std::vector<Seen> out;
    for (auto& d : detections) {
        Seen s;
        s.T_world_obj = frame.T_world_cam * d.T_cam_obj;
        s.z = positionYaw(s.T_world_obj, d.information, options);
        s.box = obs::uprightBox(s.T_world_obj, d.size_m);
        s.observation = std::move(d);
        out.push_back(std::move(s));
    }
    return out;
}

}  // namespace

bool ObjectAssociator::confirmed(const TrackedThing& thing) const {
    return thing.hits >= options_.minDetections && 2 * thing.hits >= thing.frames;
}

std::vector<uint64_t> ObjectAssociator::associate(const Frame& frame,
                                                  std::vector<ObjectObservation> detections) {
    std::vector<Seen> seen = prepare(frame, std::move(detections), options_);

    std::vector<uint64_t> keys;
    std::vector<std::vector<double>> rows;
    for (auto& [key, thing] : things_) {
        thing.filter.predict(frame.time_s - thing.lastPredicted_s, options_.filter);
        thing.lastPredicted_s = frame.time_s;
        std::vector<double> row(seen.size(), kBig);
        bool any = false;
        for (std::size_t j = 0; j < seen.size(); ++j) {
            row[j] = costOf(thing, seen[j], options_);
            any = any || row[j] < kUnassigned;
        }
        if (!any) continue;
        keys.push_back(key);
        rows.push_back(std::move(row));
    }
    Eigen::MatrixXd cost(static_cast<Eigen::Index>(rows.size()),
                         static_cast<Eigen::Index>(seen.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t j = 0; j < seen.size(); ++j) {
            cost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows[i][j];
        }
    }
    const auto assigned = solver::assign(cost, kUnassigned);

    std::set<uint64_t> hits;
    std::vector<bool> used(seen.size(), false);
    std::vector<UprightBox> taken;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (!assigned[i]) continue;
        used[*assigned[i]] = true;
        taken.push_back(seen[*assigned[i]].box);
        hit(things_.at(keys[i]), seen[*assigned[i]], frame, options_);
        hits.insert(keys[i]);
    }
    for (auto& [key, thing] : things_) {
        if (hits.count(key) != 0) continue;
        ++thing.frames;
        ++thing.misses;
    }
    for (std::size_t j = 0; j < seen.size(); ++j) {
        if (used[j]) continue;
        const auto doubled = [&](const UprightBox& box) {
            return obs::birdsEyeOverlap(box, seen[j].box) > options_.doubleOverlap;
        };
        if (std::any_of(taken.begin(), taken.end(), doubled)) {
            ++doubles_;
            continue;
        }
        taken.push_back(seen[j].box);
        TrackedThing thing;
        thing.key = nextKey_++;
        thing.lastPredicted_s = frame.time_s;
        hit(thing, seen[j], frame, options_);
        hits.insert(thing.key);
        things_.emplace(thing.key, std::move(thing));
    }
    forget(frame.time_s);
    return {hits.begin(), hits.end()};
}

void ObjectAssociator::forget(double time_s) {
    for (auto it = things_.begin(); it != things_.end();) {
        const TrackedThing& t = it->second;
        const bool lost =
            t.object ? !t.filter.likelyStatic() && time_s - t.lastSeen_s > options_.maxOcclusion_s
                     : t.misses > options_.maxMisses;
        it = lost ? things_.erase(it) : std::next(it);
    }
}

void ObjectAssociator::follow(const std::function<SE3(map::KeyframeId)>& T_world_anchor) {
    for (auto& [key, thing] : things_) {
        const SE3 now = T_world_anchor(thing.anchor);
        if (now.matrix() == thing.T_world_anchor.matrix()) continue;
        thing.filter.transform(now * thing.T_world_anchor.inverse());
        thing.T_world_anchor = now;
    }
}

void ObjectAssociator::turnRound(uint64_t key) {
    auto& thing = things_.at(key);
    thing.filter.turnRound();
    for (auto& o : thing.waiting) o = map::turnedRound(std::move(o));
}

}  // namespace djpete::backend
