#include "djpete/backend/motion_chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "chain_reference.h"
#include "djpete/obs/detection.h"

namespace djpete::backend {
namespace {

using djpete_test::Random;
using djpete_test::ReferenceChain;
using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

constexpr double kSigma_m = 0.3, kSigma_rad = 0.08;

/// A car on wheels: what objects.cpp asks for, rounded.
MotionPrior carPrior() {
    MotionPrior prior;
    prior.twistWalk << 2, 0.3, 0.3, 0.03, 0.03, 0.4;
    prior.twistSigma << 100, 0.3, 0.3, 0.05, 0.05, 100;
    return prior;
}

/// A car that turns with a twist that changes slowly, at `times_s`; its measurements are noisy and
/// the search starts from them.
struct Drive {
    std::vector<ChainNode> nodes;
    std::vector<SE3> T_world_obj;  ///< truth
};
Drive drive(const std::vector<double>& times_s, uint64_t seed) {
    Random random(seed);
    Drive out;
    SE3 T = SE3::fromYaw(0.6, {20, -4, -1});
    double before_s = times_s.front();
    for (const double t : times_s) {
        for (double s = before_s; s < t; s += 0.01) {  // small steps of the true motion
            Vec6 twist = Vec6::Zero();
            twist[0] = 9 + std::sin(s);
            twist[5] = 0.3 * std::cos(0.5 * s);
            T = (T * SE3::exp(std::min(0.01, t - s) * twist)).normalised();
        }
        before_s = t;
        Vec6 noise;
        noise << random.normal3(kSigma_m), random.normal3(kSigma_rad);
        ChainNode node;
        node.time_s = t;
        node.T_world_obj = T * SE3::exp(noise);
        node.twist[0] = 8;
        node.measured.push_back(
            {node.T_world_obj,
             obs::diagonalInformation(Vec3::Constant(kSigma_m), Vec3::Constant(kSigma_rad)), true});
        out.nodes.push_back(node);
        out.T_world_obj.push_back(T);
    }
    return out;
}

std::vector<double> every(double dt_s, int n) {
    std::vector<double> out;
    for (int i = 0; i < n; ++i) out.push_back(dt_s * i);
    return out;
}

ChainOptions exact(const solver::RobustKernel& kernel) {
    ChainOptions o;
    o.kernel = kernel;
    o.maxIterations = 200;
    o.relativeTolerance = 1e-14;
    return o;
}

double rms_m(const Drive& d, std::size_t from = 0, std::size_t to = 1000) {
    double sum = 0;
    std::size_t n = 0;
    for (std::size_t k = from; k < std::min(to, d.nodes.size()); ++k, ++n) {
        sum +=
            (d.nodes[k].T_world_obj.translation() - d.T_world_obj[k].translation()).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(n));
}

/// Same optimum and same covariances as the general solver finds for the same residuals.
void expectAsTheGeneralSolver(std::vector<ChainNode> nodes, const solver::RobustKernel& kernel) {
    const MotionPrior prior = carPrior();
    const auto report = smooth(nodes, prior, exact(kernel));
    ASSERT_TRUE(report.usable);
    // From where the chain ended: nothing is left to gain, and nothing moves.
    ReferenceChain reference(nodes, prior, kernel);
    const auto solved = reference.solve();
    ASSERT_TRUE(solved.usable()) << solved.message;
    EXPECT_NEAR(solved.initialCost, report.finalCost, 1e-8 * (1 + report.finalCost));
    EXPECT_NEAR(solved.finalCost, report.finalCost, 1e-6 * (1 + report.finalCost));
    const auto P = solver::covariances(reference.problem, reference.poses);
    const auto V = solver::covariances(reference.problem, reference.twists);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const SE3& T = reference.problem.pose(reference.poses[k]);
        EXPECT_LT((T.inverse() * nodes[k].T_world_obj).log().norm(), 1e-4) << "node " << k;
        EXPECT_LT((reference.problem.vector6(reference.twists[k]) - nodes[k].twist).norm(), 1e-3);
        ASSERT_TRUE(P[k] && V[k]);
        EXPECT_LT((*P[k] - nodes[k].covariance).norm(), 1e-3 * P[k]->norm()) << "node " << k;
        EXPECT_NEAR(std::sqrt((*V[k])(0, 0)), nodes[k].longitudinalSigma_mps,
                    1e-3 * nodes[k].longitudinalSigma_mps);
    }
}

TEST(MotionChain, findsWhatTheGeneralSolverFinds) {
    expectAsTheGeneralSolver(drive(every(0.1, 15), 1).nodes, solver::RobustKernel::none());
}

TEST(MotionChain, findsWhatTheGeneralSolverFindsWithAKernel) {
    expectAsTheGeneralSolver(drive(every(0.1, 12), 2).nodes, solver::RobustKernel::cauchy(2));
}

TEST(MotionChain, findsWhatTheGeneralSolverFindsWithGapsAndSeveralViews) {
    auto nodes = drive({0, 0.1, 0.2, 0.25, 1.0, 1.1, 1.9, 2.0}, 3).nodes;
    nodes[4].measured.clear();
    nodes[6].measured.push_back(nodes[6].measured[0]);
    nodes[6].measured[1].T_world_obj.translation().x() += 0.4;
    nodes[6].measured[1].robust = false;
    // Information that is no diagonal.
    nodes[2].measured[0].information(0, 5) = nodes[2].measured[0].information(5, 0) = 5;
    expectAsTheGeneralSolver(nodes, solver::RobustKernel::cauchy(4));
}

TEST(MotionChain, reportsTheCostAsItIsDefined) {
    auto nodes = drive(every(0.1, 10), 4).nodes;
    ReferenceChain before(nodes, carPrior(), solver::RobustKernel::cauchy(4));
    solver::Options none;
    none.maxIterations = 1;
    const double cost = solver::solve(before.problem, none).initialCost;
    const auto report = smooth(nodes, carPrior(), ChainOptions{});
    EXPECT_NEAR(report.initialCost, cost, 1e-9 * cost);
    EXPECT_LT(report.finalCost, report.initialCost);
}

TEST(MotionChain, errorsFallAgainstRawNoise) {
    double raw = 0, smoothed = 0, chi2 = 0;
    const int runs = 20, n = 40;
    for (int i = 0; i < runs; ++i) {
        auto d = drive(every(0.1, n), static_cast<uint64_t>(100 + i));
        raw += rms_m(d) / runs;
        ASSERT_TRUE(smooth(d.nodes, carPrior(), ChainOptions{}).usable);
        smoothed += rms_m(d) / runs;
        for (std::size_t k = 0; k < n; ++k) {
            const Vec6 e = (d.nodes[k].T_world_obj.inverse() * d.T_world_obj[k]).log();
            chi2 += e.dot(d.nodes[k].covariance.inverse() * e) / (6.0 * runs * n);
        }
    }
    EXPECT_LT(smoothed, 0.5 * raw);
    // Errors are what the covariance says: per degree of freedom 1, a little less because the prior
    // is wider than the true motion.
    EXPECT_GT(chi2, 0.4);
    EXPECT_LT(chi2, 1.3);
}

TEST(MotionChain, oneInFiveOutliersDoNotPullIt) {
    auto clean = drive(every(0.1, 40), 5);
    auto dirty = clean;
    Random random(6);
    for (std::size_t k = 2; k < 40; k += 5) {
        dirty.nodes[k].measured[0].T_world_obj =
            dirty.nodes[k].T_world_obj * SE3::fromYaw(random.uniform(-3, 3), random.normal3(5));
        dirty.nodes[k].T_world_obj = dirty.nodes[k].measured[0].T_world_obj;
    }
    auto believed = dirty;
    ChainOptions gullible;
    gullible.kernel = solver::RobustKernel::none();
    smooth(clean.nodes, carPrior(), ChainOptions{});
    smooth(dirty.nodes, carPrior(), ChainOptions{});
    smooth(believed.nodes, carPrior(), gullible);
    EXPECT_LT(rms_m(dirty), 1.5 * rms_m(clean) + 0.05);
    EXPECT_GT(rms_m(believed), 3 * rms_m(dirty));  // so the kernel it is
}

TEST(MotionChain, aGapIsBridgedByTheMotionAndSaysHowUnsure) {
    auto d = drive(every(0.1, 41), 7);
    for (std::size_t k = 15; k <= 25; ++k) {
        d.nodes[k].measured.clear();
        d.nodes[k].T_world_obj = d.nodes[14].T_world_obj;  // a poor start
    }
    ASSERT_TRUE(smooth(d.nodes, carPrior(), ChainOptions{}).usable);
    EXPECT_LT(rms_m(d, 15, 26), 0.5);  // the car went 10 m
    const auto sigma = [&](std::size_t k) { return std::sqrt(d.nodes[k].covariance(0, 0)); };
    EXPECT_GT(sigma(20), 1.3 * sigma(10));
    EXPECT_GT(sigma(20), sigma(16));
    EXPECT_GT(sigma(20), sigma(24));
}

TEST(MotionChain, oneNodeIsItsMeasurement) {
    auto d = drive({0.3}, 8);
    const auto measured = d.nodes[0].measured[0];
    d.nodes[0].T_world_obj = measured.T_world_obj * SE3::fromYaw(0.2, {0.5, 0.3, 0.1});
    ASSERT_TRUE(smooth(d.nodes, carPrior(), exact(solver::RobustKernel::cauchy(4))).usable);
    EXPECT_LT((measured.T_world_obj.inverse() * d.nodes[0].T_world_obj).log().norm(), 1e-6);
    EXPECT_LT((d.nodes[0].covariance - Mat6(measured.information.inverse())).norm(), 1e-6);
    EXPECT_NEAR(d.nodes[0].longitudinalSigma_mps, 100, 1e-6);  // nothing but the prior
}

TEST(MotionChain, twoNodesGiveASpeed) {
    auto d = drive({0, 0.5}, 9);
    for (std::size_t k = 0; k < 2; ++k) {
        d.nodes[k].measured[0].T_world_obj =
            SE3::fromYaw(0.4, {0, 0, 0}) * SE3::fromYaw(0, {6 * d.nodes[k].time_s, 0, 0});
        d.nodes[k].twist.setZero();
    }
    expectAsTheGeneralSolver(d.nodes, solver::RobustKernel::cauchy(4));
    ASSERT_TRUE(smooth(d.nodes, carPrior(), ChainOptions{}).usable);
    EXPECT_NEAR(d.nodes[0].twist[0], 6, 0.05);
    EXPECT_NEAR(d.nodes[1].twist[0], 6, 0.05);
    EXPECT_GT(d.nodes[0].longitudinalSigma_mps, 0.5);
}

TEST(MotionChain, noNodesAreNotUsableAndNanIsNotUsed) {
    std::vector<ChainNode> none;
    EXPECT_FALSE(smooth(none, carPrior(), ChainOptions{}).usable);
    auto d = drive(every(0.1, 5), 10);
    d.nodes[2].measured[0].T_world_obj.translation().x() = std::nan("");
    EXPECT_FALSE(smooth(d.nodes, carPrior(), ChainOptions{}).usable);
}

TEST(MotionChain, withoutCovariancesThePosesAreTheSame) {
    auto with = drive(every(0.1, 20), 11).nodes, without = with;
    ChainOptions o;
    smooth(with, carPrior(), o);
    o.covariances = false;
    smooth(without, carPrior(), o);
    for (std::size_t k = 0; k < with.size(); ++k) {
        EXPECT_EQ(with[k].T_world_obj.matrix(), without[k].T_world_obj.matrix());
        EXPECT_EQ(without[k].covariance, Mat6(Mat6::Zero()));
    }
}

TEST(MotionChain, sameInputGivesTheSameBytes) {
    auto a = drive(every(0.1, 30), 12).nodes, b = a;
    smooth(a, carPrior(), ChainOptions{});
    smooth(b, carPrior(), ChainOptions{});
    for (std::size_t k = 0; k < a.size(); ++k) {
        const Eigen::Matrix4d x = a[k].T_world_obj.matrix(), y = b[k].T_world_obj.matrix();
        EXPECT_EQ(std::memcmp(x.data(), y.data(), sizeof(double) * 16), 0);
        EXPECT_EQ(std::memcmp(&a[k].covariance, &b[k].covariance, sizeof(Mat6)), 0);
    }
}

}  // namespace
}  // namespace djpete::backend
