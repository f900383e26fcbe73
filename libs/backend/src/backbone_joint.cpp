#include "backbone_joint.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "djpete/geometry/information.h"
#include "djpete/geometry/residuals.h"
#include "djpete/solver/solve.h"

namespace djpete::backend {

namespace {

using geometry::Mat6;
using geometry::Vec3;

double costOf(const solver::Problem& problem, const std::vector<BackboneEdge>& edges) {
    double sum = 0;
    for (const auto& e : edges) {
        if (!problem.isEnabled(e.id)) continue;
        const auto r2 = problem.squaredNorm(e.id);
        sum += 0.5 * e.kernel.rho(r2 ? *r2 : solver::Options().invalidSquaredNorm);
    }
    return sum;
}

/// What the points that are in use tell of each camera's position: trace of the information, 1/m^2.
/// A stereo view of a point at depth z tells (f / z)^2 / sigma^2 across and, by its disparity,
/// (f b / z^2)^2 / sigma^2 along the axis.
std::vector<double> pointInformation(const solver::Problem& problem, const BackboneProblem& in,
                                     const std::vector<solver::PoseId>& poses,
                                     const std::vector<solver::PointId>& pointIds,
                                     const std::vector<BackboneEdge>& points) {
    std::vector<double> out(in.cameras.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!problem.isEnabled(points[i].id)) continue;
        const auto& o = in.observations[i];
        const Vec3 p_cam =
            problem.pose(poses[o.camera]).inverse() * problem.point(pointIds[o.point]);
        const auto& camera = in.cameras[o.camera].camera;
        const double perMetre =
            camera.fx / std::max(p_cam.z(), 0.1) / static_cast<double>(o.feature.sigma_px);
        const double along = camera.baseline_m / std::max(p_cam.z(), 0.1) * perMetre;
        out[o.camera] += 2 * perMetre * perMetre + along * along;
    }
    return out;
}

/// Per edge the factor on its information that keeps the objects within their share.
std::vector<double> capped(const BackboneProblem& in, const std::vector<double>& ofPoints,
                           double maxShare) {
    std::vector<double> ofObjects(in.cameras.size(), 0);
    for (const auto& e : in.objectEdges) {
        if (e.camera) ofObjects[*e.camera] += e.information.topLeftCorner<3, 3>().trace();
    }
    std::vector<double> out;
    for (const auto& e : in.objectEdges) {
        double factor = 1;
        if (e.camera && !in.cameras[*e.camera].fixed && ofObjects[*e.camera] > 0)
            factor = std::min(1.0, maxShare * ofPoints[*e.camera] / ofObjects[*e.camera]);
        out.push_back(factor);
    }
    return out;
}

}  // namespace

bool solveWithObjects(solver::Problem& problem, const BackboneProblem& in,
                      const std::vector<solver::PoseId>& poses,
                      const std::vector<solver::PointId>& pointIds,
                      const std::vector<BackboneEdge>& points,
                      const std::vector<BackboneEdge>& others, const JointOptions& options,
                      int iterations) {
    const auto ofPoints = pointInformation(problem, in, poses, pointIds, points);
    const auto factors = capped(in, ofPoints, options.maxShare);
    const auto kernel = solver::RobustKernel::cauchy(options.robustScale);
    std::vector<solver::PoseId> objects;
    for (const auto& o : in.objects) objects.push_back(problem.addPose(o.T_world_obj));
    std::vector<BackboneEdge> edges;
    for (std::size_t i = 0; i < in.objectEdges.size(); ++i) {
        const auto& e = in.objectEdges[i];
        const auto W = geometry::sqrtInformation<6>(factors[i] * e.information);
        if (!W) continue;
        const auto camera = e.camera ? poses[*e.camera] : problem.addPose(e.T_world_cam, true);
        const geometry::CameraObjectResidual residual(e.T_cam_obj, *W);
        edges.push_back({problem.add(residual, kernel, camera, objects[e.object]), kernel});
    }

    const auto costBefore = costOf(problem, points) + costOf(problem, others);
    const auto before = problem.values();
    const auto undo = [&] {
        problem.setValues(before);
        for (const auto& e : edges) problem.setEnabled(e.id, false);
        return false;
    };
    solver::Options lm;
    lm.maxIterations = iterations;
    lm.functionTolerance = 1e-5;
    if (edges.empty() || !solver::solve(problem, lm).usable()) return undo();
    const auto costAfter = costOf(problem, points) + costOf(problem, others);
    // Degrees of freedom: six per edge, less six per object.
    const double dof =
        6 * (static_cast<double>(edges.size()) - static_cast<double>(objects.size()));
    const double chi2 = 2 * costOf(problem, edges);
    const bool good = costAfter <= (1 + options.maxCostRise) * costBefore && dof > 0 &&
                      chi2 <= options.maxMeanChi2 * dof;
    return good || undo();
}

}  // namespace djpete::backend
