#include "association_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "djpete/solver/assignment.h"

namespace djpete::backend {

namespace {

using geometry::Mat3;
using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using map::ObjectObservation;

/// Farther from where it was, a thing cannot be.
constexpr double kFar_m = 60;
/// Frames without a detection after which a thing counts as lost.
constexpr unsigned kLostMisses = 3;

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

bool sameKind(obs::ObjectClass a, obs::ObjectClass b) {
    return a == b || (obs::isVehicle(a) && obs::isVehicle(b));
}

double sizeDifference(const Vec3& a, const Vec3& b) {
    return (a.array() / b.array()).log().abs().sum();
}

/// Groups of things and detections that candidates join, as union-find over both.
class Groups {
  public:
    explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
    std::size_t root(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::size_t a, std::size_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::size_t> parent_;
};

/// Numbers in order of first use.
class Numbering {
  public:
    Eigen::Index of(std::size_t key) {
        return index_.emplace(key, static_cast<Eigen::Index>(index_.size())).first->second;
    }
    Eigen::Index size() const { return static_cast<Eigen::Index>(index_.size()); }

  private:
    std::map<std::size_t, Eigen::Index> index_;
};

}  // namespace

bool opposite(double yaw_rad, double heading_rad) {
    return std::abs(geometry::wrapAngle(yaw_rad - heading_rad)) > M_PI / 2;
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

std::optional<MatchCost> matchCost(const TrackedThing& thing, const Seen& seen,
                                   const AssociationOptions& options) {
    if (!sameKind(thing.objectClass, seen.observation.objectClass)) return std::nullopt;
    if ((thing.filter.p_world() - seen.z.p_world).squaredNorm() > kFar_m * kFar_m) {
        return std::nullopt;
    }
    const auto match = thing.filter.match(seen.z);
    if (!(match.distance2 <= options.gate)) return std::nullopt;
    double yawError = geometry::wrapAngle(seen.z.yaw_rad - thing.filter.yaw_rad());
    if (std::abs(yawError) > M_PI / 2) yawError = geometry::wrapAngle(yawError + M_PI);
    const double yawVariance = thing.filter.yawVariance() + seen.z.yawVariance;
    const double yawDistance = std::min(yawError * yawError / yawVariance, options.maxYawDistance);
    const double distance = match.distance2 + yawDistance;
    if (!(distance <= options.gate)) return std::nullopt;

    const obs::UprightBox predicted{match.p_world, thing.filter.yaw_rad(), thing.size_m};
    if (thing.hits >= 2 && obs::birdsEyeOverlap(predicted.grown(options.overlapMargin_m),
                                                seen.box.grown(options.overlapMargin_m)) <= 0) {
        return std::nullopt;
    }
    MatchCost out;
    out.logDensity =
        -0.5 * (distance + match.logDeterminant + std::log(yawVariance) + 4 * std::log(2 * M_PI));
    // Who was lost may be anywhere: what is found there is more likely something new.
    if (thing.misses >= kLostMisses && out.logDensity < std::log(options.newDensity)) {
        return std::nullopt;
    }
    out.cost = distance + match.logDeterminant - 2 * match.logWeight;
    out.cost += options.overlapWeight * (1 - obs::volumeOverlap(predicted, seen.box));
    out.cost += options.sizeWeight * sizeDifference(thing.size_m, seen.observation.size_m);
    if (thing.looks && seen.observation.appearance) {
        out.cost += options.appearanceWeight *
                    obs::appearanceDistance(*thing.looks, *seen.observation.appearance);
    }
    if (thing.lastBox && seen.observation.box && thing.misses == 0) {
        out.cost += options.imageOverlapWeight *
                    (1 - obs::imageOverlap(*thing.lastBox, *seen.observation.box));
    }
    return out;
}

std::vector<std::optional<std::size_t>> choose(const std::vector<Candidate>& candidates,
                                               std::size_t things, std::size_t detections,
                                               double unassignedCost) {
    Groups groups(things + detections);
    for (const auto& c : candidates) groups.join(c.thing, things + c.detection);
    std::map<std::size_t, std::vector<std::size_t>> members;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        members[groups.root(candidates[i].thing)].push_back(i);
    }
    std::vector<std::optional<std::size_t>> chosen(things);
    for (const auto& [root, indices] : members) {
        Numbering rows, columns;
        for (const auto i : indices) {
            rows.of(candidates[i].thing);
            columns.of(candidates[i].detection);
        }
        Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(rows.size(), columns.size(),
                                                         std::numeric_limits<double>::infinity());
        for (const auto i : indices) {
            cost(rows.of(candidates[i].thing), columns.of(candidates[i].detection)) =
                candidates[i].match.cost;
        }
        const auto columnOf = solver::assign(cost, unassignedCost);
        for (const auto i : indices) {
            const auto column = columnOf[static_cast<std::size_t>(rows.of(candidates[i].thing))];
            if (column &&
                static_cast<Eigen::Index>(*column) == columns.of(candidates[i].detection)) {
                chosen[candidates[i].thing] = i;
            }
        }
    }
    return chosen;
}

}  // namespace djpete::backend
