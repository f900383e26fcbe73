#include "djpete/backend/pose_graph.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "djpete/geometry/information.h"
#include "djpete/geometry/pose_residuals.h"

namespace djpete::backend {

namespace {

using geometry::Mat6;
using geometry::SE3;
using map::KeyframeId;

/// A loop that is off by more sigmas, whatever the others say, is believed less and less.
constexpr double kLoopScale = 25;

Mat6 driftInformation(const SE3& T_a_b, const LoopOptions& options, double share) {
    const double sigma_m =
        options.driftFloor_m + options.driftPerMetre * T_a_b.translation().norm();
    geometry::Vec6 weight;
    weight << geometry::Vec3::Constant(1 / (sigma_m * sigma_m)),
        geometry::Vec3::Constant(1 / (options.drift_rad * options.drift_rad));
    return (share * weight).asDiagonal();
}

/// Older keyframes that share most landmarks with `kf`, beside its neighbour.
std::vector<KeyframeId> joined(const map::SlamMap& map, const map::Keyframe& kf,
                               const LoopOptions& options) {
    std::map<KeyframeId, unsigned> shared;
    for (const auto& landmark : kf.landmarks) {
        if (!landmark) continue;
        for (const auto& [other, feature] : map.landmarks().at(*landmark).observations) {
            if (other.value + 1 < kf.id.value) ++shared[other];
        }
    }
    std::vector<std::pair<unsigned, KeyframeId>> best;
    for (const auto& [other, count] : shared) {
        if (count >= options.minShared) best.emplace_back(count, other);
    }
    std::stable_sort(best.begin(), best.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    if (best.size() > options.maxJoined) best.resize(options.maxJoined);
    std::vector<KeyframeId> out;
    for (const auto& [count, id] : best) out.push_back(id);
    return out;
}

}  // namespace

PoseGraphProblem poseGraphProblem(const map::SlamMap& map, const std::vector<LoopEdge>& loops,
                                  KeyframeId firstFree, const LoopOptions& options) {
    PoseGraphProblem problem;
    if (loops.empty()) return problem;
    const uint32_t world = map.keyframes().at(loops.front().a).world;
    std::map<KeyframeId, std::size_t> index;
    for (const auto& [id, kf] : map.keyframes()) {
        if (kf.world != world) continue;
        index[id] = problem.poses.size();
        problem.poses.push_back({id, kf.T_world_cam, problem.poses.empty() || id < firstFree});
    }
    const auto join = [&](KeyframeId a, KeyframeId b, double share) {
        const SE3 T_a_b =
            map.keyframes().at(a).T_world_cam.inverse() * map.keyframes().at(b).T_world_cam;
        problem.edges.push_back(
            {index.at(a), index.at(b), T_a_b, driftInformation(T_a_b, options, share), false});
    };
    std::set<std::pair<KeyframeId, KeyframeId>> measured;
    for (const auto& loop : loops) measured.insert({loop.a, loop.b});
    std::map<uint32_t, KeyframeId> lastOfSegment;
    for (const auto& [id, i] : index) {
        const auto& kf = map.keyframes().at(id);
        const auto last = lastOfSegment.find(kf.segment);
        if (last != lastOfSegment.end()) join(last->second, id, 1);
        lastOfSegment[kf.segment] = id;
        // What several keyframes say of one is mostly the same: together they count once.
        const auto others = joined(map, kf, options);
        for (const KeyframeId other : others) {
            if (index.count(other) == 0 || measured.count({other, id}) != 0) continue;
            join(other, id, 1.0 / static_cast<double>(others.size()));
        }
    }
    for (const auto& loop : loops) {
        if (index.count(loop.a) == 0 || index.count(loop.b) == 0) continue;
        problem.edges.push_back(
            {index.at(loop.a), index.at(loop.b), loop.T_a_b, loop.information, true});
    }
    return problem;
}

namespace {

/// The graph as a problem, loops under `kernel`.
struct Graph {
    solver::Problem problem;
    std::vector<solver::PoseId> poses;
    std::vector<solver::ResidualId> loops;

    Graph(const PoseGraphProblem& in, const std::vector<SE3>& T_world_cam,
          const solver::RobustKernel& kernel) {
        for (std::size_t i = 0; i < in.poses.size(); ++i) {
            poses.push_back(problem.addPose(T_world_cam[i], in.poses[i].fixed));
        }
        for (const auto& e : in.edges) {
            const auto W = geometry::sqrtInformation<6>(e.information);
            if (!W) continue;
            const geometry::RelativePoseResidual residual(e.T_a_b, *W);
            if (e.robust) {
                loops.push_back(problem.add(residual, kernel, poses[e.a], poses[e.b]));
            } else {
                problem.add(residual, poses[e.a], poses[e.b]);
            }
        }
    }
    double worstLoop() const {
        double worst = 0;
        for (const auto id : loops) {
            worst = std::max(worst, std::sqrt(problem.squaredNorm(id).value_or(0)));
        }
        return worst;
    }
};

}  // namespace

/// Graduated non-convexity (Yang et al., RA-L 2020): all loops with full weight first, then
/// Geman-McClure's kernel, narrowed step by step, as long as one of them is far off.
PoseGraphUpdate solve(const PoseGraphProblem& in) {
    const auto begin = std::chrono::steady_clock::now();
    PoseGraphUpdate out;
    std::vector<SE3> T_world_cam;
    for (const auto& p : in.poses) T_world_cam.push_back(p.T_world_cam);
    solver::Options lm;
    lm.maxIterations = 30;
    const auto solveUnder = [&](const solver::RobustKernel& kernel) {
        Graph graph(in, T_world_cam, kernel);
        out.report = solver::solve(graph.problem, lm);
        for (std::size_t i = 0; i < T_world_cam.size(); ++i) {
            T_world_cam[i] = graph.problem.pose(graph.poses[i]);
        }
        return graph.worstLoop();
    };
    double worst = solveUnder(solver::RobustKernel::none());
    while (out.report.usable() && worst > kLoopScale) {
        worst = std::max(kLoopScale, 0.5 * worst);
        solveUnder(solver::RobustKernel::gemanMcClure(worst));
    }
    if (out.report.usable()) {
        for (std::size_t i = 0; i < in.poses.size(); ++i) {
            if (in.poses[i].fixed) continue;
            out.poses.emplace_back(in.poses[i].id, T_world_cam[i].normalised());
        }
    }
    out.time_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return out;
}

}  // namespace djpete::backend
