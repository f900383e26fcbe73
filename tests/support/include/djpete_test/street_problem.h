/// The street as a bundle adjustment: a solver Problem with the truth disturbed.
#pragma once

#include <vector>

#include "djpete/geometry/residuals.h"
#include "djpete/solver/solve.h"
#include "djpete_test/synthetic_world.h"

namespace djpete_test {

/// How the truth is disturbed before solving.
struct StartOptions {
    double camera_m = 0.05, camera_rad = 0.005, point_m = 0.3;
    int fixedCameras = 2;  ///< the first ones stay at the truth, constant
    unsigned seed = 11;
};

/// Start values; the same for every solver that is compared.
struct StreetStart {
    std::vector<SE3> T_world_cam;
    std::vector<Vec3> p_world;
};

inline StreetStart disturbed(const StreetWorld& world, const StartOptions& o) {
    std::mt19937 rng(o.seed);
    StreetStart start{world.T_world_cam, world.p_world};
    for (std::size_t c = std::size_t(o.fixedCameras); c < start.T_world_cam.size(); ++c) {
        auto& T = start.T_world_cam[c];
        T = T * SE3::exp(gaussianTwist(rng, o.camera_m, o.camera_rad));
    }
    for (Vec3& p : start.p_world) p += gaussianVec3(rng, o.point_m);
    return start;
}

struct StreetProblem {
    djpete::solver::Problem problem;
    std::vector<djpete::solver::PoseId> cameras;
    std::vector<djpete::solver::PointId> points;
    std::vector<djpete::solver::ResidualId> residuals;  ///< one per observation
};

inline StreetProblem stereoProblem(const StreetWorld& world, const StartOptions& options,
                                   const djpete::solver::RobustKernel& kernel = {}) {
    const StreetStart start = disturbed(world, options);
    StreetProblem out;
    for (std::size_t c = 0; c < start.T_world_cam.size(); ++c) {
        const bool constant = int(c) < options.fixedCameras;
        out.cameras.push_back(out.problem.addPose(start.T_world_cam[c], constant));
    }
    for (const Vec3& p : start.p_world) out.points.push_back(out.problem.addPoint(p));
    for (const StereoObservation& z : world.observations) {
        out.residuals.push_back(
            out.problem.add(djpete::geometry::StereoPointResidual(world.camera, z.uvu), kernel,
                            out.cameras[std::size_t(z.camera)], out.points[std::size_t(z.point)]));
    }
    return out;
}

/// Largest translation error in m of the cameras.
inline double worstCamera_m(const StreetProblem& p, const StreetWorld& world) {
    double worst = 0;
    for (std::size_t c = 0; c < p.cameras.size(); ++c) {
        const Vec3 d =
            p.problem.pose(p.cameras[c]).translation() - world.T_world_cam[c].translation();
        worst = std::max(worst, d.norm());
    }
    return worst;
}

inline double worstPoint_m(const StreetProblem& p, const StreetWorld& world) {
    double worst = 0;
    for (std::size_t k = 0; k < p.points.size(); ++k) {
        worst = std::max(worst, (p.problem.point(p.points[k]) - world.p_world[k]).norm());
    }
    return worst;
}

}  // namespace djpete_test
