/// Robust kernels.
#include <gtest/gtest.h>

#include "djpete_test/street_problem.h"

namespace djpete::solver {
namespace {

using namespace djpete_test;

const RobustKernel kKernels[] = {RobustKernel::none(), RobustKernel::huber(1.3),
                                 RobustKernel::cauchy(0.7), RobustKernel::gemanMcClure(2)};

TEST(RobustKernel, WeightIsTheDerivativeOfRho) {
    for (const RobustKernel& k : kKernels) {
        for (double s : {1e-6, 0.1, 1.0, 1.6, 1.8, 30.0, 1e4}) {
            const double h = 1e-6 * s;
            EXPECT_NEAR(k.weight(s), (k.rho(s + h) - k.rho(s - h)) / (2 * h), 1e-6) << s;
        }
        EXPECT_EQ(k.rho(0), 0);
        EXPECT_EQ(k.weight(0), 1);
    }
}

TEST(RobustKernel, GemanMcClureIsBounded) { EXPECT_LT(RobustKernel::gemanMcClure(2).rho(1e12), 4); }

StreetWorld outlierStreet() {
    StreetOptions o;
    o.sigma_px = 0.3;
    o.outliers = 0.1;
    return makeStreet(o);
}

TEST(Robust, KernelsRejectOutliersThatRuinLeastSquares) {
    const StreetWorld world = outlierStreet();
    StreetProblem plain = stereoProblem(world, {});
    solve(plain.problem);
    EXPECT_GT(worstCamera_m(plain, world), 0.2);
    for (const RobustKernel& kernel : {RobustKernel::huber(1), RobustKernel::cauchy(1)}) {
        StreetProblem p = stereoProblem(world, {}, kernel);
        const Report report = solve(p.problem);
        EXPECT_TRUE(report.usable());
        EXPECT_LT(worstCamera_m(p, world), 0.05) << int(kernel.type);
    }
}

TEST(Robust, GemanMcClureRejectsThemFromANearStart) {
    const StreetWorld world = outlierStreet();
    StartOptions near;
    near.camera_m = 0.01;
    near.camera_rad = 0.0005;
    near.point_m = 0.02;
    StreetProblem p = stereoProblem(world, near, RobustKernel::gemanMcClure(5));
    const Report report = solve(p.problem);
    EXPECT_TRUE(report.usable());
    EXPECT_LT(worstCamera_m(p, world), 0.02);
}

TEST(Robust, InliersAreCounted) {
    const StreetWorld world = outlierStreet();
    StreetProblem p = stereoProblem(world, {}, RobustKernel::cauchy(2));
    const Report report = solve(p.problem);
    int wellSeen = 0, inliers = 0, found = 0;
    for (std::size_t k = 0; k < p.residuals.size(); ++k) {
        const auto s = p.problem.squaredNorm(p.residuals[k]);
        inliers += s && *s <= 4;
        wellSeen += !world.observations[k].outlier;
        found += !world.observations[k].outlier && s && *s <= 4;
    }
    EXPECT_EQ(report.numInliers, inliers);
    EXPECT_GT(found, 0.97 * wellSeen);
    EXPECT_LT(inliers - found, 0.02 * wellSeen);
}

}  // namespace
}  // namespace djpete::solver
