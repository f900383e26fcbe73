#include <algorithm>
#include <chrono>
#include <cmath>

#include "backbone_joint.h"
#include "djpete/geometry/information.h"
#include "djpete/geometry/residuals.h"
#include "djpete/solver/solve.h"

namespace djpete::backend {

namespace {

using geometry::Mat6;
using geometry::Vec2;
using geometry::Vec3;
using geometry::Vec6;

/// Of an observation. `outlierAbove`: squared whitened error.
struct Edge {
    BackboneEdge edge;
    double outlierAbove;
};

/// True if the LiDAR's depth says more of the inverse depth than the right image does.
bool depthBeatsStereo(const obs::KeyframeFeature& f, const geometry::StereoCamera& camera) {
    if (!f.depth_m) return false;
    if (!f.uRight_px || !camera.hasRight()) return true;
    const double depth = static_cast<double>(*f.depth_m);
    const double lidar = static_cast<double>(f.depthSigma_m) / (depth * depth);
    const double stereo = static_cast<double>(std::hypot(f.sigma_px, f.uRightSigma_px)) /
                          (camera.fx * camera.baseline_m);
    return lidar < stereo;
}

Edge addEdge(solver::Problem& problem, const BackboneProblem& in, std::size_t observation,
             const std::vector<solver::PoseId>& poses, const std::vector<solver::PointId>& points,
             const BackboneOptions& options) {
    const auto& o = in.observations[observation];
    const auto& f = o.feature;
    const auto& camera = in.cameras[o.camera].camera;
    const auto pose = poses[o.camera];
    const auto point = points[o.point];
    const auto kernel = solver::RobustKernel::huber(options.huberScale);
    const double u = static_cast<double>(f.u_px), v = static_cast<double>(f.v_px);
    const double w = 1.0 / static_cast<double>(f.sigma_px);
    if (depthBeatsStereo(f, camera)) {
        const geometry::DepthPointResidual r(camera, Vec2(u, v), static_cast<double>(*f.depth_m),
                                             static_cast<double>(f.depthSigma_m), w);
        return {{problem.add(r, kernel, pose, point), kernel}, options.outlierStereo};
    }
    if (f.uRight_px && camera.hasRight()) {
        const Vec3 weights(w, w, 1.0 / static_cast<double>(f.uRightSigma_px));
        const geometry::StereoPointResidual r(camera, Vec3(u, v, static_cast<double>(*f.uRight_px)),
                                              weights);
        return {{problem.add(r, kernel, pose, point), kernel}, options.outlierStereo};
    }
    const geometry::MonoPointResidual r(camera, Vec2(u, v), w);
    return {{problem.add(r, kernel, pose, point), kernel}, options.outlierMono};
}

void addOdometry(solver::Problem& problem, const BackboneProblem& in,
                 const std::vector<solver::PoseId>& poses, const BackboneOptions& options,
                 std::vector<BackboneEdge>& edges) {
    for (const auto& o : in.odometry) {
        const double sigma =
            options.odometrySigma_m + options.odometrySigmaPerMetre * o.T_a_b.translation().norm();
        Vec6 weights;
        weights << Vec3::Constant(1 / sigma),
            Vec3::Constant(1 / std::max(options.odometrySigma_rad, 1e-6));
        const geometry::RelativePoseResidual r(o.T_a_b, Mat6(weights.asDiagonal()));
        edges.push_back({problem.add(r, poses[o.a], poses[o.b]), solver::RobustKernel::none()});
    }
}

void addScans(solver::Problem& problem, const BackboneProblem& in,
              const std::vector<solver::PoseId>& poses, const BackboneOptions& options,
              std::vector<BackboneEdge>& edges) {
    const auto kernel = solver::RobustKernel::huber(options.scanHuberScale);
    for (const auto& s : in.scans) {
        const auto whitening = geometry::sqrtInformation<6>(s.information);
        if (!whitening) continue;  // requireGoodFrame lets none of these in
        const geometry::RelativePoseResidual r(s.T_a_b, *whitening);
        edges.push_back({problem.add(r, kernel, poses[s.a], poses[s.b]), kernel});
    }
}

/// Switches outliers off and inliers on; points with fewer than two inliers go off as a whole.
/// Returns which points are left.
std::vector<bool> sortOut(solver::Problem& problem, const BackboneProblem& in,
                          const std::vector<Edge>& edges, std::vector<bool>& inlier) {
    std::vector<unsigned> support(in.points.size(), 0);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto r2 = problem.squaredNorm(edges[i].edge.id);
        inlier[i] = r2 && *r2 <= edges[i].outlierAbove;
        if (inlier[i]) ++support[in.observations[i].point];
    }
    std::vector<bool> alive(in.points.size());
    for (std::size_t j = 0; j < alive.size(); ++j) alive[j] = support[j] >= 2;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        problem.setEnabled(edges[i].edge.id, inlier[i] && alive[in.observations[i].point]);
    }
    return alive;
}

void collect(const solver::Problem& problem, const BackboneProblem& in,
             const std::vector<solver::PoseId>& poses, const std::vector<solver::PointId>& points,
             const std::vector<bool>& alive, const std::vector<bool>& inlier, BackboneUpdate& out) {
    for (std::size_t i = 0; i < in.cameras.size(); ++i) {
        if (!in.cameras[i].fixed) {
            out.cameras.emplace_back(in.cameras[i].id, problem.pose(poses[i]).normalised());
        }
    }
    for (std::size_t j = 0; j < in.points.size(); ++j) {
        if (alive[j]) {
            out.points.emplace_back(in.points[j].id, problem.point(points[j]));
        } else {
            out.culled.push_back(in.points[j].id);
        }
    }
    for (std::size_t i = 0; i < in.observations.size(); ++i) {
        const auto& o = in.observations[i];
        if (alive[o.point] && !inlier[i]) {
            out.outliers.emplace_back(in.points[o.point].id, in.cameras[o.camera].id);
        }
    }
}

}  // namespace

BackboneUpdate solve(const BackboneProblem& in, const BackboneOptions& options) {
    return solve(in, options, JointOptions{});
}

BackboneUpdate solve(const BackboneProblem& in, const BackboneOptions& options,
                     const JointOptions& joint) {
    const auto begin = std::chrono::steady_clock::now();
    BackboneUpdate out;
    solver::Problem problem;
    std::vector<solver::PoseId> poses;
    std::vector<solver::PointId> points;
    for (const auto& c : in.cameras) poses.push_back(problem.addPose(c.T_world_cam, c.fixed));
    for (const auto& p : in.points) points.push_back(problem.addPoint(p.p_world));
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < in.observations.size(); ++i) {
        edges.push_back(addEdge(problem, in, i, poses, points, options));
    }
    std::vector<BackboneEdge> others;
    addOdometry(problem, in, poses, options, others);
    addScans(problem, in, poses, options, others);

    solver::Options lm;
    lm.maxIterations = static_cast<int>(options.firstIterations);
    lm.functionTolerance = 1e-4;
    out.report = solver::solve(problem, lm);
    if (out.report.usable()) {
        std::vector<bool> inlier(edges.size());
        sortOut(problem, in, edges, inlier);
        lm.maxIterations = static_cast<int>(options.secondIterations);
        const auto report = solver::solve(problem, lm);
        if (report.usable()) out.report = report;
        auto alive = sortOut(problem, in, edges, inlier);
        if (!in.objects.empty()) {
            std::vector<BackboneEdge> ofPoints;
            for (const auto& e : edges) ofPoints.push_back(e.edge);
            const bool accepted = solveWithObjects(problem, in, poses, points, ofPoints, others,
                                                   joint, lm.maxIterations);
            out.joint = accepted ? JointOutcome::Accepted : JointOutcome::Refused;
            if (accepted) alive = sortOut(problem, in, edges, inlier);
        }
        collect(problem, in, poses, points, alive, inlier, out);
    }
    out.time_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return out;
}

}  // namespace djpete::backend
