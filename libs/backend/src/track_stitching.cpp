#include "track_stitching.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

namespace djpete::backend {

namespace {

using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;
using map::ObjectState;
using map::ObjectTrack;
using map::SlamMap;

/// Of the ends of a track: what neither states nor covariances tell, and what a twist is known to.
constexpr double kEndSigma_m = 0.3, kSpeedSigma_mps = 0.7, kCrossSpeedSigma_mps = 0.25;
constexpr double kEndYawSigma_rad = 0.1, kTurnSigma_radps = 0.08;
/// Lengths and so on may differ by so much (1-sigma of the logarithm).
constexpr double kSizeSigma = 0.15;
/// Looks that differ by more speak against it.
constexpr double kLooksAlike = 0.25, kLooksWeight = 8;
/// Log-odds against one that drives standing when it is seen again, or the other way round.
constexpr double kStopOdds = 3;
/// New objects per m^2 and radian of heading where one is lost.
constexpr double kNewDensity = 1e-3;

struct End {
    SE3 T_world_obj;
    Vec6 twist;
    double time_s;
};

End endOf(const SlamMap& map, const ObjectState& state) {
    const auto since = map.frames().at(state.frame).stamp - map.frames().begin()->second.stamp;
    return {map.T_world_obj(state), state.twist, std::chrono::duration<double>(since).count()};
}

/// ln of the density of a normal error.
double logNormal(double error, double variance) {
    return -0.5 * (error * error / variance + std::log(2 * M_PI * variance));
}

/// Position and twist errors of the bridge: with both twists known, white noise on acceleration of
/// power q leaves q dt^3 / 12 of the way and q dt of the change of twist, independent of each
/// other.
double bridge(double way, double change, double dt, double q, double endSigma, double twistSigma) {
    const double twist2 = twistSigma * twistSigma;
    const double wayVariance =
        q * dt * dt * dt / 12 + 2 * endSigma * endSigma + 0.5 * twist2 * dt * dt;
    const double changeVariance = q * dt + 2 * twist2;
    // Of the twist only how well it fits counts, not how likely it is among others.
    return logNormal(way, wayVariance) - 0.5 * change * change / changeVariance;
}

std::optional<double> logOdds(const SlamMap& map, const ObjectTrack& a, const ObjectTrack& b,
                              const ObjectOptions& options) {
    const End from = endOf(map, a.states.rbegin()->second);
    End to = endOf(map, b.states.begin()->second);
    const double dt = to.time_s - from.time_s;
    if (!(dt > 0) || dt > options.stitchGap_s) return std::nullopt;
    if (std::abs(geometry::wrapAngle(from.T_world_obj.yaw_rad() - to.T_world_obj.yaw_rad())) >
        M_PI / 2) {
        const SE3 T_half_turn = SE3::fromYaw(M_PI, Vec3::Zero());
        to.T_world_obj = to.T_world_obj * T_half_turn;
        to.twist = T_half_turn.inverse().adjoint() * to.twist;
    }
    const Vec6 way = (from.T_world_obj.inverse() * to.T_world_obj).log();
    const Vec6 missed = way - 0.5 * dt * (from.twist + to.twist), change = to.twist - from.twist;
    const auto square = [](double x) { return x * x; };
    double sum = bridge(missed[0], change[0], dt, square(options.accelerationSigma_mps2),
                        kEndSigma_m, kSpeedSigma_mps) +
                 bridge(missed[1], change[1], dt, square(options.crossAccelerationSigma_mps2),
                        kEndSigma_m, kCrossSpeedSigma_mps) +
                 bridge(missed[5], change[5], dt, square(options.turnAccelerationSigma_radps2),
                        kEndYawSigma_rad, kTurnSigma_radps);
    // Height differs by the road and by cameras; it is no evidence for, only against.
    sum -= 0.5 * square(missed[2] / (2 * kEndSigma_m + 0.05 * std::abs(way[0])));
    const Vec3 size = (a.size_m.array() / b.size_m.array()).log();
    sum -= 0.5 * size.squaredNorm() / square(kSizeSigma);
    const auto& looksA = a.observations.rbegin()->second.appearance;
    const auto& looksB = b.observations.begin()->second.appearance;
    if (looksA && looksB) {
        const double apart = obs::appearanceDistance(*looksA, *looksB);
        sum -= kLooksWeight * std::max(0.0, apart - kLooksAlike);
    }
    if (a.moving != b.moving) sum -= kStopOdds;
    return sum - std::log(kNewDensity);
}

bool candidates(const SlamMap& map, const ObjectTrack& a, const ObjectTrack& b) {
    if (!a.moving && !b.moving) return false;
    if (a.states.empty() || b.states.empty()) return false;
    if (a.states.rbegin()->first >= b.states.begin()->first) return false;
    if (obs::isVehicle(a.objectClass) != obs::isVehicle(b.objectClass)) return false;
    const auto world = [&](const ObjectState& s) { return map.keyframes().at(s.anchor).world; };
    return world(a.states.rbegin()->second) == world(b.states.begin()->second);
}

}  // namespace

std::vector<Stitch> stitches(const SlamMap& map, const std::set<map::ObjectId>& changed,
                             const ObjectOptions& options) {
    std::vector<Stitch> all;
    const auto consider = [&](const ObjectTrack& a, const ObjectTrack& b) {
        if (b.states.size() < options.stitchViews || a.states.size() < options.stitchViews ||
            !candidates(map, a, b)) {
            return;
        }
        const auto odds = logOdds(map, a, b, options);
        if (odds && *odds > options.stitchOdds) all.push_back({a.id, b.id, *odds});
    };
    for (const auto id : changed) {
        const auto it = map.objects().find(id);
        if (it == map.objects().end()) continue;
        for (const auto& [other, track] : map.objects()) {
            if (other == id) continue;
            consider(track, it->second);
            if (changed.count(other) == 0) consider(it->second, track);
        }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Stitch& a, const Stitch& b) { return a.logOdds > b.logOdds; });
    std::vector<Stitch> out;
    std::set<map::ObjectId> used;
    for (const auto& s : all) {
        if (used.count(s.earlier) != 0 || used.count(s.later) != 0) continue;
        used.insert(s.earlier);
        used.insert(s.later);
        out.push_back(s);
    }
    return out;
}

}  // namespace djpete::backend
