#include "djpete/map/object_rules.h"

#include <cmath>
#include <utility>

namespace djpete::map {

namespace {

using geometry::Mat6;
using geometry::SE3;

SE3 halfTurn() { return SE3::fromYaw(M_PI, geometry::Vec3::Zero()); }

}  // namespace

ObjectObservation turnedRound(ObjectObservation observation) {
    const SE3 T = halfTurn();
    observation.T_cam_obj = observation.T_cam_obj * T;
    // e_new = Ad(T^-1) e_old, so e_old = Ad(T) e_new.
    const Mat6 adjoint = T.adjoint();
    observation.information = adjoint.transpose() * observation.information * adjoint;
    return observation;
}

ObjectState turnedRound(ObjectState state) {
    const SE3 T = halfTurn();
    state.T_anchor_obj = state.T_anchor_obj * T;
    const Mat6 adjoint = T.inverse().adjoint();
    state.twist = adjoint * state.twist;
    state.covariance = adjoint * state.covariance * adjoint.transpose();
    return state;
}

ObjectTrack turnedRound(ObjectTrack track) {
    for (auto& [frame, observation] : track.observations) {
        observation = turnedRound(std::move(observation));
    }
    for (auto& [frame, state] : track.states) state = turnedRound(state);
    for (auto& [frame, T_cam_obj] : track.views) T_cam_obj = T_cam_obj * halfTurn();
    return track;
}

ObjectTrack merged(ObjectTrack kept, const ObjectTrack& gone) {
    const auto a = static_cast<double>(kept.observations.size());
    const auto b = static_cast<double>(gone.observations.size());
    if (a + b > 0) kept.size_m = (a * kept.size_m + b * gone.size_m) / (a + b);
    kept.observations.insert(gone.observations.begin(), gone.observations.end());
    kept.states.insert(gone.states.begin(), gone.states.end());
    kept.moving = kept.moving || gone.moving;
    kept.views.clear();
    return kept;
}

double objectScore(const ObjectTrack& track) {
    double sum = 0;
    for (const auto& [frame, o] : track.observations) sum += static_cast<double>(o.score);
    return track.observations.empty() ? 0 : sum / static_cast<double>(track.observations.size());
}

SE3 interpolated(const MovingPose& start, const SE3& T_world_end, double span_s, double t_s) {
    const SE3 T_world_expected = start.T_world_obj * SE3::exp(span_s * start.twist);
    const geometry::Vec6 missed = (T_world_expected.inverse() * T_world_end).log();
    const double share = t_s / span_s;
    return (start.T_world_obj * SE3::exp(t_s * start.twist) *
            SE3::exp(share * share * (3 - 2 * share) * missed))
        .normalised();
}

}  // namespace djpete::map
