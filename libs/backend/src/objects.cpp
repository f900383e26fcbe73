#include "djpete/backend/objects.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "djpete/backend/motion_chain.h"
#include "djpete/backend/object_size.h"
#include "djpete/backend/standing_fit.h"
#include "point_refinement.h"

namespace djpete::backend {

namespace {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;
using map::ObjectState;
using Edge = ObjectProblem::Edge;
using Edges = std::vector<const Edge*>;

/// Of a window of a moving object, the oldest part has no past and is not handed on.
constexpr std::size_t kWithoutPast = 3;  // one in three
/// Fewer objects than this are not worth a thread.
constexpr std::size_t kPerThread = 4;
constexpr double kUnlimited = 100;
/// Views from which on a standing object's last estimate is a good start.
constexpr std::size_t kTrusted = 12;
constexpr double kShortestSpan_s = 0.1;
/// A standing object's apparent motion when the camera stands too, and its turning.
constexpr double kLeastDrift_mps = 0.005, kDriftTurn_radps = 0.005;

/// `n` of the edges, spread evenly, the first and last among them.
Edges evenly(const std::vector<Edge>& edges, std::size_t n) {
    Edges out;
    const std::size_t take = std::min(n, edges.size());
    for (std::size_t i = 0; i < take; ++i) {
        out.push_back(&edges[take == 1 ? 0 : i * (edges.size() - 1) / (take - 1)]);
    }
    return out;
}

Edges newest(const std::vector<Edge>& edges, std::size_t n) {
    Edges out;
    for (std::size_t i = edges.size() - std::min(n, edges.size()); i < edges.size(); ++i) {
        out.push_back(&edges[i]);
    }
    return out;
}

Vec3 sizeOf(const ObjectProblem::Object& in, const ObjectOptions& options) {
    std::vector<SeenSize> seen;
    double best = 0;
    for (const auto& e : in.edges) best = std::max(best, e.information(0, 0));
    for (const auto& e : in.edges) {
        // A detection that is unsure of where its object is, is unsure of its size.
        const double unsure = std::sqrt(std::max(1.0, best / std::max(1e-9, e.information(0, 0))));
        seen.push_back({e.size_m, options.sizeSigma * std::min(10.0, unsure)});
    }
    return estimateSize(seen, in.objectClass, options.sizePrior);
}

ChainNode::Measured measuredBy(const Edge& e) {
    return {e.T_world_cam * e.T_cam_obj, e.information, true};
}

/// How fast a standing thing seems to move because cameras err by a share of their way.
MotionPrior driftPrior(const Edges& used, double share) {
    double way_m = 0;
    for (std::size_t i = 1; i < used.size(); ++i) {
        way_m +=
            (used[i]->T_world_cam.translation() - used[i - 1]->T_world_cam.translation()).norm();
    }
    const double span_s = std::max(kShortestSpan_s, used.back()->time_s - used.front()->time_s);
    const double speed = kLeastDrift_mps + share * way_m / span_s;
    MotionPrior prior;
    prior.twistSigma << Vec3::Constant(speed), Vec3::Constant(kDriftTurn_radps);
    prior.twistWalk = prior.twistSigma;
    return prior;
}

/// The object relative to each camera, as that camera saw it.
void addViews(const Edges& used, const ObjectOptions& options, const StandingFit& fit,
              ObjectUpdate::Object& out) {
    std::vector<ChainNode> nodes;
    for (const Edge* e : used) {
        ChainNode node;
        node.time_s = e->time_s;
        node.T_world_obj = fit.T_world_obj;
        node.measured.push_back(measuredBy(*e));
        nodes.push_back(std::move(node));
    }
    ChainOptions chain;
    chain.kernel = solver::RobustKernel::cauchy(options.robustScale);
    chain.covariances = false;
    if (!smooth(nodes, driftPrior(used, options.cameraDrift), chain).usable) return;
    // What points know better than detections holds for every view.
    const auto& anchor = *std::find_if(used.begin(), used.end(), [&](const Edge* e) {
        return e->anchor == out.states.front().anchor;
    });
    const SE3 T_fit_obj =
        fit.T_world_obj.inverse() * anchor->T_world_anchor * out.states.front().T_anchor_obj;
    for (std::size_t k = 0; k < used.size(); ++k) {
        out.views[used[k]->frame] =
            used[k]->T_world_cam.inverse() * nodes[k].T_world_obj * T_fit_obj;
    }
}

void solveStatic(const ObjectProblem::Object& in, const Edges& used, bool views,
                 const ObjectOptions& options, ObjectUpdate::Object& out) {
    std::vector<ChainNode::Measured> measured;
    UprightPrior upright{Vec3::Zero(), options.uprightSigma_rad};
    for (const Edge* e : used) {
        measured.push_back(measuredBy(*e));
        upright.up_world += e->up_world;
    }
    upright.up_world.normalize();
    const auto kernel = solver::RobustKernel::cauchy(options.robustScale);
    // Where it was found by many views it is not looked for anew.
    std::optional<SE3> start;
    if (!in.moving && used.size() >= kTrusted) start = used.front()->T_world_obj;
    const auto fit = fitStanding(
        measured, kernel, upright.sigma_rad > 0 ? std::optional(upright) : std::nullopt, start);
    if (!fit) return;

    // One anchor for all states: the camera from which the object was nearest.
    const auto nearest =
        std::min_element(in.edges.begin(), in.edges.end(), [](const Edge& a, const Edge& b) {
            return a.T_cam_obj.translation().norm() < b.T_cam_obj.translation().norm();
        });
    const SE3 T_anchor_obj = nearest->T_world_anchor.inverse() * fit->T_world_obj;
    for (const auto& e : in.edges) {
        ObjectState& state = out.states.emplace_back();
        state.frame = e.frame;
        state.anchor = nearest->anchor;
        state.T_anchor_obj = T_anchor_obj;
        state.covariance = fit->covariance;
    }
    out.solved = true;
    if (options.usePoints) refineStanding(in, options, out);
    if (views && options.cameraDrift > 0) addViews(used, options, *fit, out);
}

MotionPrior motionPrior(const ObjectOptions& o) {
    MotionPrior prior;
    const double tilt = 0.5 * o.tiltRateSigma_radps;
    prior.twistWalk << o.accelerationSigma_mps2, o.crossAccelerationSigma_mps2,
        o.crossAccelerationSigma_mps2, tilt, tilt, o.turnAccelerationSigma_radps2;
    prior.twistSigma << kUnlimited, o.crossSpeedSigma_mps, o.crossSpeedSigma_mps,
        o.tiltRateSigma_radps, o.tiltRateSigma_radps, kUnlimited;
    return prior;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::vector<ChainNode> chainOf(const Edges& used) {
    std::vector<ChainNode> nodes;
    const SE3 first = used.front()->T_world_cam * used.front()->T_cam_obj;
    const SE3 last = used.back()->T_world_cam * used.back()->T_cam_obj;
    const Vec3 velocity_world = (last.translation() - first.translation()) /
                                std::max(used.back()->time_s - used.front()->time_s, 1e-3);
    for (const Edge* e : used) {
        ChainNode node;
        node.time_s = e->time_s;
        node.measured.push_back(measuredBy(*e));
        node.T_world_obj = node.measured[0].T_world_obj;
        node.twist[0] = velocity_world.dot(node.T_world_obj.rotation().col(0));
        if (e->T_world_obj && !e->twist.isZero()) {
            node.T_world_obj = *e->T_world_obj;
            node.twist = e->twist;
        }
        nodes.push_back(std::move(node));
    }
    return nodes;
}

void solveMoving(const Edges& used, const ObjectOptions& options, ObjectUpdate::Object& out) {
    auto nodes = chainOf(used);
    ChainOptions chain;
    chain.kernel = solver::RobustKernel::cauchy(options.robustScale);
    if (!smooth(nodes, motionPrior(options), chain).usable) return;
    if (options.usePoints)
        refineMoving(used, options, motionPrior(options), chain, nodes, out.size_m);

    std::vector<double> speeds;
    for (std::size_t k = 0; k < used.size(); ++k) {
        speeds.push_back(nodes[k].twist.x());
        ObjectState& state = out.states.emplace_back();
        state.frame = used[k]->frame;
        state.anchor = used[k]->anchor;
        state.T_anchor_obj = used[k]->T_world_anchor.inverse() * nodes[k].T_world_obj;
        state.twist = nodes[k].twist;
        state.covariance = nodes[k].covariance;
    }
    out.turnRound = median(std::move(speeds)) < -options.reverseSpeed_mps;
    out.solved = true;
}

bool judgeMoving(const ObjectProblem::Object& in, const ObjectOptions& options) {
    if (in.edges.size() < options.minObservationsToMove) return false;
    const auto e = motionEvidence(in.edges, options);
    if (in.moving) {
        return e.chi2Drop >= options.staticBelow && e.speed_mps >= 0.5 * options.minSpeed_mps &&
               e.travel_m >= 0.5 * options.minTravel_m;
    }
    return e.chi2Drop > options.movingAbove && e.speed_mps > options.minSpeed_mps &&
           e.travel_m > options.minTravel_m;
}

ObjectUpdate::Object solveOne(const ObjectProblem::Object& in, bool allEdges,
                              const ObjectOptions& options) {
    ObjectUpdate::Object out;
    out.id = in.id;
    out.epoch = in.epoch;
    if (in.edges.empty()) return out;
    out.moving = judgeMoving(in, options);
    out.size_m = sizeOf(in, options);
    // What changes its kind is estimated anew over all it was seen.
    const bool all = allEdges || out.moving != in.moving;
    const std::size_t n = in.edges.size();
    if (out.moving) {
        const std::size_t window =
            all ? n : std::min<std::size_t>(n, options.maxObservationsMoving);
        const Edges used = newest(in.edges, window);
        solveMoving(used, options, out);
        if (out.solved && window < n) {
            out.states.erase(out.states.begin(),
                             out.states.begin() + std::ptrdiff_t(window / kWithoutPast));
        }
    } else {
        solveStatic(in, evenly(in.edges, all ? n : options.maxObservations), allEdges, options,
                    out);
    }
    return out;
}

}  // namespace

ObjectUpdate solve(const ObjectProblem& problem, const ObjectOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    ObjectUpdate update;
    const std::size_t n = problem.objects.size();
    update.objects.resize(n);
    const std::size_t cores =
        options.threads > 0 ? options.threads : std::thread::hardware_concurrency();
    const std::size_t parts =
        std::clamp<std::size_t>(n / kPerThread, 1, std::max<std::size_t>(1, cores));
    const auto part = [&](std::size_t first) {
        for (std::size_t i = first; i < n; i += parts) {
            update.objects[i] = solveOne(problem.objects[i], problem.all, options);
        }
    };
    std::vector<std::thread> threads;
    for (std::size_t p = 1; p < parts; ++p) threads.emplace_back(part, p);
    part(0);
    for (auto& t : threads) t.join();
    update.time_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return update;
}

}  // namespace djpete::backend
