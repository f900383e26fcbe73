#include "djpete/backend/standing_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "djpete/geometry/information.h"
#include "djpete/geometry/pose_residuals.h"
#include "djpete/obs/detection.h"
#include "djpete/solver/solve.h"
#include "djpete_test/random.h"

namespace djpete::backend {
namespace {

using djpete_test::Random;
using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;
using Measured = ChainNode::Measured;

const SE3 kParked = SE3::fromYaw(0.7, {30, 6, -1});
constexpr double kSigma_m = 0.3, kSigma_rad = 0.08;

std::vector<Measured> views(int n, uint64_t seed) {
    Random random(seed);
    std::vector<Measured> out;
    for (int i = 0; i < n; ++i) {
        const double s = random.uniform(0.5, 2);
        Vec6 noise;
        noise << random.normal3(s * kSigma_m), random.normal3(s * kSigma_rad);
        Mat6 information =
            obs::diagonalInformation(Vec3::Constant(s * kSigma_m), Vec3::Constant(s * kSigma_rad));
        information(0, 5) = information(5, 0) = 0.2 * information(0, 0);
        out.push_back({kParked * SE3::exp(noise), information, true});
    }
    return out;
}

/// Of every third, somewhere else with a straight face.
std::vector<Measured> withRubbish(std::vector<Measured> views, uint64_t seed, bool alike) {
    Random random(seed);
    for (std::size_t i = 0; i < views.size(); i += 3) {
        const Vec3 off = alike ? Vec3(3, 2, 0) + random.normal3(0.3) : random.normal3(4);
        views[i].T_world_obj = kParked * SE3::fromYaw(random.uniform(-3, 3), off);
    }
    return views;
}

double distance_m(const StandingFit& fit, const SE3& T = kParked) {
    return (fit.T_world_obj.translation() - T.translation()).norm();
}

/// The same problem for the general solver, from `start`.
struct Reference {
    solver::Problem problem;
    solver::PoseId pose;
    solver::Report report;
    Reference(const std::vector<Measured>& views, const solver::RobustKernel& kernel,
              const SE3& start) {
        pose = problem.addPose(start);
        for (const auto& m : views) {
            problem.add(geometry::PosePriorResidual(m.T_world_obj,
                                                    *geometry::sqrtInformation<6>(m.information)),
                        m.robust ? kernel : solver::RobustKernel::none(), pose);
        }
        solver::Options o;
        o.functionTolerance = 1e-14;
        o.stepTolerance = 1e-12;
        report = solver::solve(problem, o);
    }
};

TEST(StandingFit, findsWhatTheGeneralSolverFinds) {
    for (uint64_t seed = 1; seed <= 5; ++seed) {
        for (const auto& kernel : {solver::RobustKernel::none(), solver::RobustKernel::cauchy(4),
                                   solver::RobustKernel::cauchy(1)}) {
            auto measured = views(25, seed);
            measured[3].robust = false;
            const auto fit = fitStanding(measured, kernel, std::nullopt, std::nullopt);
            ASSERT_TRUE(fit);
            Reference reference(measured, kernel, kParked);
            const SE3& T = reference.problem.pose(reference.pose);
            EXPECT_LT((T.inverse() * fit->T_world_obj).log().norm(), 1e-4);
            EXPECT_NEAR(fit->cost, reference.report.finalCost, 1e-6 * fit->cost);
            const auto P = solver::covariance(reference.problem, reference.pose);
            ASSERT_TRUE(P);
            EXPECT_LT((*P - fit->covariance).norm(), 1e-3 * P->norm());
        }
    }
}

TEST(StandingFit, isBetterThanOneViewByTheRootOfTheirNumber) {
    double one = 0, many = 0;
    for (uint64_t seed = 0; seed < 40; ++seed) {
        const auto kernel = solver::RobustKernel::cauchy(4);
        one += distance_m(*fitStanding(views(1, seed), kernel, std::nullopt, std::nullopt)) / 40;
        many += distance_m(*fitStanding(views(64, seed), kernel, std::nullopt, std::nullopt)) / 40;
    }
    EXPECT_LT(many, one / 5);
    EXPECT_GT(one, 0.2);
}

TEST(StandingFit, aThirdOfRubbishDoesNotHoldIt) {
    const auto kernel = solver::RobustKernel::cauchy(2);
    for (const bool alike : {false, true}) {
        for (uint64_t seed = 1; seed <= 20; ++seed) {
            const auto measured = withRubbish(views(30, seed), 100 + seed, alike);
            const auto fit = fitStanding(measured, kernel, std::nullopt, std::nullopt);
            ASSERT_TRUE(fit);
            EXPECT_LT(distance_m(*fit), 0.4) << "seed " << seed << ", alike " << alike;
        }
    }
    // Plain least squares would be pulled.
    const auto pulled = fitStanding(withRubbish(views(30, 1), 101, true),
                                    solver::RobustKernel::none(), std::nullopt, std::nullopt);
    ASSERT_TRUE(pulled);
    EXPECT_GT(distance_m(*pulled), 0.6);
}

TEST(StandingFit, theUprightPriorLevelsIt) {
    auto measured = views(10, 3);
    for (auto& m : measured) {  // all lean to one side by 0.2 rad
        m.T_world_obj = m.T_world_obj * SE3(geometry::so3Exp({0.2, 0, 0}), Vec3::Zero());
    }
    const auto tilt = [](const StandingFit& fit) {
        return std::acos(std::min(1.0, fit.T_world_obj.rotation()(2, 2)));
    };
    const auto kernel = solver::RobustKernel::none();  // all views keep their weight
    const auto free = fitStanding(measured, kernel, std::nullopt, std::nullopt);
    const auto held = fitStanding(measured, kernel, UprightPrior{{0, 0, 1}, 0.002}, std::nullopt);
    const auto loose = fitStanding(measured, kernel, UprightPrior{{0, 0, 1}, 10}, std::nullopt);
    ASSERT_TRUE(free && held && loose);
    EXPECT_GT(tilt(*free), 0.12);
    EXPECT_LT(tilt(*held), 0.02);
    EXPECT_NEAR(tilt(*loose), tilt(*free), 1e-3);
    EXPECT_NEAR(held->T_world_obj.yaw_rad(), free->T_world_obj.yaw_rad(), 0.05);
    EXPECT_LT(std::sqrt(held->covariance(3, 3)), 0.0021);
    EXPECT_NEAR(held->covariance(5, 5), free->covariance(5, 5), 0.3 * free->covariance(5, 5));
}

TEST(StandingFit, upMayPointAnywhere) {
    const SE3 tipped(geometry::so3Exp({0.5, -0.3, 0.2}), {1, 2, 3});
    auto measured = views(10, 4);
    for (auto& m : measured) m.T_world_obj = tipped * m.T_world_obj;
    const UprightPrior prior{tipped.rotation().col(2), 0.002};
    const auto fit = fitStanding(measured, solver::RobustKernel::cauchy(4), prior, std::nullopt);
    ASSERT_TRUE(fit);
    EXPECT_GT(fit->T_world_obj.rotation().col(2).dot(prior.up_world), std::cos(0.01));
}

TEST(StandingFit, aGoodStartEndsWhereTheSearchEnds) {
    const auto kernel = solver::RobustKernel::cauchy(4);
    for (uint64_t seed = 1; seed <= 5; ++seed) {
        const auto measured = withRubbish(views(30, seed), 200 + seed, false);
        const auto searched = fitStanding(measured, kernel, std::nullopt, std::nullopt);
        const auto started = fitStanding(measured, kernel, std::nullopt, kParked);
        ASSERT_TRUE(searched && started);
        EXPECT_LT(distance_m(*searched, started->T_world_obj), 1e-3);
    }
}

TEST(StandingFit, aStartIsWhereItStarts) {
    // Two camps of equal strength, too far apart to be one: the start chooses.
    auto measured = views(10, 5);
    for (std::size_t i = 0; i < 5; ++i) {
        measured[i].T_world_obj = SE3::fromYaw(0, {40, 0, 0}) * measured[i].T_world_obj;
    }
    const SE3 there = SE3::fromYaw(0, {40, 0, 0}) * kParked;
    const auto kernel = solver::RobustKernel::gemanMcClure(2);
    const auto here = fitStanding(measured, kernel, std::nullopt, kParked);
    const auto away = fitStanding(measured, kernel, std::nullopt, there);
    ASSERT_TRUE(here && away);
    EXPECT_LT(distance_m(*here), 1);
    EXPECT_LT(distance_m(*away, there), 1);
}

TEST(StandingFit, nothingOrTooLittleGivesNothing) {
    const auto kernel = solver::RobustKernel::cauchy(4);
    EXPECT_FALSE(fitStanding({}, kernel, std::nullopt, std::nullopt));
    auto blind = views(1, 6);  // and nobody knows the yaw
    blind[0].information.row(5).setZero();
    blind[0].information.col(5).setZero();
    EXPECT_FALSE(fitStanding(blind, kernel, std::nullopt, std::nullopt));
    EXPECT_TRUE(fitStanding(views(1, 6), kernel, std::nullopt, std::nullopt));
    auto broken = views(5, 7);
    broken[2].T_world_obj.translation().y() = std::nan("");
    EXPECT_FALSE(fitStanding(broken, kernel, std::nullopt, std::nullopt));
}

}  // namespace
}  // namespace djpete::backend
