#include "djpete/backend/objects.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "djpete/geometry/residuals.h"
#include "djpete/solver/solve.h"
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

/// Measured poses tried as the start of a static object.
constexpr std::size_t kStarts = 15;
/// Covariance of what the edges say nothing of.
constexpr double kUnknown = 1e3;
constexpr double kHuberShare =
    0.75;  // a moving object's kernel is Huber's, with this * robustScale

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

double weightedMedian(std::vector<std::pair<double, double>> valuesAndWeights) {
    std::sort(valuesAndWeights.begin(), valuesAndWeights.end());
    double total = 0, sum = 0;
    for (const auto& [value, weight] : valuesAndWeights) total += weight;
    for (const auto& [value, weight] : valuesAndWeights) {
        sum += weight;
        if (2 * sum >= total) return value;
    }
    return valuesAndWeights.back().first;
}

/// Per dimension the median, weighed by the information on the position.
Vec3 sizeOf(const std::vector<Edge>& edges) {
    Vec3 size;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<std::pair<double, double>> values;
        for (const auto& e : edges) {
            const double weight = std::sqrt(e.information.topLeftCorner<3, 3>().trace());
            values.emplace_back(e.size_m[axis], 1e-9 + weight);
        }
        size[axis] = weightedMedian(std::move(values));
    }
    return size;
}

std::optional<geometry::CameraObjectResidual> residualOf(const Edge& e) {
    const auto W = geometry::sqrtInformation<6>(e.information);
    if (!W) return std::nullopt;
    return geometry::CameraObjectResidual(e.T_cam_obj, *W);
}

/// The measured pose that the other measurements agree with most.
SE3 staticStart(const Edges& edges, double scale) {
    const auto kernel = solver::RobustKernel::gemanMcClure(scale);
    std::vector<Edge> copies;
    for (const Edge* e : edges) copies.push_back(*e);
    double least = std::numeric_limits<double>::infinity();
    SE3 best = edges.back()->T_world_cam * edges.back()->T_cam_obj;
    const auto voters = evenly(copies, 2 * kStarts);
    for (const Edge* candidate : evenly(copies, kStarts)) {
        const SE3 T_world_obj = candidate->T_world_cam * candidate->T_cam_obj;
        double cost = 0;
        for (const Edge* e : voters) {
            if (const auto r = residualOf(*e)) {
                cost += kernel.rho((*r)(e->T_world_cam, T_world_obj).squaredNorm());
            }
        }
        if (cost < least) {
            least = cost;
            best = T_world_obj;
        }
    }
    return best;
}

void solveStatic(const ObjectProblem::Object& in, const Edges& used, const ObjectOptions& options,
                 ObjectUpdate::Object& out) {
    solver::Problem problem;
    const auto object = problem.addPose(staticStart(used, options.robustScale));
    for (const Edge* e : used) {
        if (const auto r = residualOf(*e)) {
            problem.add(*r, solver::RobustKernel::cauchy(options.robustScale),
                        problem.addPose(e->T_world_cam, true), object);
        }
    }
    if (!solver::solve(problem).usable()) return;
    const SE3 T_world_obj = problem.pose(object).normalised();
    const auto covariance = solver::covariance(problem, object);

    // One anchor for all states: the camera from which the object was nearest.
    const auto nearest =
        std::min_element(in.edges.begin(), in.edges.end(), [](const Edge& a, const Edge& b) {
            return a.T_cam_obj.translation().norm() < b.T_cam_obj.translation().norm();
        });
    ObjectState state;
    state.anchor = nearest->anchor;
    state.T_anchor_obj = nearest->T_world_anchor.inverse() * T_world_obj;
    state.covariance = covariance.value_or(kUnknown * Mat6::Identity());
    for (const auto& e : in.edges) {
        state.frame = e.frame;
        out.states.push_back(state);
    }
    out.solved = true;
}

Mat6 diagonal(double along, double across, double tilt, double turn) {
    Vec6 sigma;
    sigma << along, across, across, tilt, tilt, turn;
    return sigma.cwiseMax(1e-4).cwiseInverse().asDiagonal();
}

/// Motion between neighbouring edges: constant twist, changing by acceleration; wheels roll
/// forward. One twist per interval.
std::vector<solver::VectorId> addMotion(solver::Problem& problem, const Edges& edges,
                                        const std::vector<solver::PoseId>& poses,
                                        const ObjectOptions& o) {
    std::vector<solver::VectorId> twists;
    const Vec3 velocity_world =
        (problem.pose(poses.back()).translation() - problem.pose(poses.front()).translation()) /
        std::max(edges.back()->time_s - edges.front()->time_s, 1e-3);
    for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
        const double dt = edges[k + 1]->time_s - edges[k]->time_s, half = 0.5 * dt * dt;
        Vec6 start = Vec6::Zero();
        start.x() = velocity_world.dot(problem.pose(poses[k]).rotation().col(0));
        const auto twist = problem.addVector6(start);
        problem.add(
            geometry::ConstantVelocityResidual(
                dt, diagonal(o.accelerationSigma_mps2 * half, o.crossAccelerationSigma_mps2 * half,
                             o.tiltRateSigma_radps * dt, o.turnAccelerationSigma_radps2 * half)),
            poses[k], twist, poses[k + 1]);
        const double unlimited = 100;
        problem.add(
            geometry::VectorPriorResidual(Vec6::Zero(), diagonal(unlimited, o.crossSpeedSigma_mps,
                                                                 o.tiltRateSigma_radps, unlimited)),
            twist);
        if (!twists.empty()) {
            const double between = 0.5 * (edges[k + 1]->time_s - edges[k - 1]->time_s);
            problem.add(
                geometry::TwistDifferenceResidual(diagonal(
                    o.accelerationSigma_mps2 * between, o.crossAccelerationSigma_mps2 * between,
                    2 * o.tiltRateSigma_radps, o.turnAccelerationSigma_radps2 * between)),
                twists.back(), twist);
        }
        twists.push_back(twist);
    }
    return twists;
}

void solveMoving(const Edges& used, const ObjectOptions& options, ObjectUpdate::Object& out) {
    solver::Problem problem;
    std::vector<solver::PoseId> poses;
    const auto kernel = solver::RobustKernel::huber(kHuberShare * options.robustScale);
    for (const Edge* e : used) {
        poses.push_back(problem.addPose(e->T_world_cam * e->T_cam_obj));
        if (const auto r = residualOf(*e)) {
            problem.add(*r, kernel, problem.addPose(e->T_world_cam, true), poses.back());
        }
    }
    const auto twists = addMotion(problem, used, poses, options);
    solver::Options lm;
    lm.denseUpTo = 0;  // a chain is sparse
    lm.functionTolerance = 1e-5;
    if (!solver::solve(problem, lm).usable()) return;
    const auto covariances = solver::covariances(problem, poses);

    std::vector<std::pair<double, double>> speeds;
    for (std::size_t k = 0; k < used.size(); ++k) {
        ObjectState state;
        state.frame = used[k]->frame;
        state.anchor = used[k]->anchor;
        state.T_anchor_obj =
            used[k]->T_world_anchor.inverse() * problem.pose(poses[k]).normalised();
        state.twist = problem.vector6(twists[std::min(k, twists.size() - 1)]);
        state.covariance = covariances[k].value_or(kUnknown * Mat6::Identity());
        speeds.emplace_back(state.twist.x(), 1.0);
        out.states.push_back(state);
    }
    out.turnRound = weightedMedian(std::move(speeds)) < -options.reverseSpeed_mps;
    out.solved = true;
}

/// With poses from points, where there are some.
void solveMovingAgain(const Edges& used, const ObjectOptions& options, ObjectUpdate::Object& out) {
    const auto refined = refineEdges(used, out);
    Edges edges;
    for (const auto& e : refined) edges.push_back(&e);
    ObjectUpdate::Object again = out;
    again.states.clear();
    again.solved = false;
    solveMoving(edges, options, again);
    if (!again.solved) return;
    out = std::move(again);
    refineMovingBox(used, options, out);
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

}  // namespace

ObjectUpdate solve(const ObjectProblem& problem, const ObjectOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    ObjectUpdate update;
    for (const auto& in : problem.objects) {
        ObjectUpdate::Object out;
        out.id = in.id;
        out.epoch = in.epoch;
        if (!in.edges.empty()) {
            out.moving = judgeMoving(in, options);
            out.size_m = sizeOf(in.edges);
            // What changes its kind is estimated anew over all it was seen.
            const bool all = problem.all || out.moving != in.moving;
            const std::size_t n = all ? in.edges.size() : options.maxObservations;
            if (out.moving) {
                const Edges used = newest(in.edges, n);
                solveMoving(used, options, out);
                if (out.solved && options.usePoints) solveMovingAgain(used, options, out);
            } else {
                solveStatic(in, evenly(in.edges, n), options, out);
                if (out.solved && options.usePoints) refineStanding(in, options, out);
            }
        }
        update.objects.push_back(std::move(out));
    }
    update.time_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return update;
}

}  // namespace djpete::backend
