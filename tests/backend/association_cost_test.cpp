/// The choice per connected group against one big assignment.
#include "association_cost.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "djpete/solver/assignment.h"
#include "djpete_test/random.h"

namespace djpete::backend {
namespace {

constexpr double kAlone = 200;

/// Random pairs, sorted by thing; `density` of all.
std::vector<Candidate> candidates(std::size_t things, std::size_t detections, double density,
                                  djpete_test::Random& random) {
    std::vector<Candidate> out;
    for (std::size_t i = 0; i < things; ++i) {
        for (std::size_t j = 0; j < detections; ++j) {
            if (random.uniform() < density) out.push_back({i, j, {random.uniform(-10, 60), 0}});
        }
    }
    return out;
}

/// Sum of costs; fails if a detection is used twice or a choice is not the thing's own.
double costOf(const std::vector<Candidate>& all,
              const std::vector<std::optional<std::size_t>>& chosen) {
    std::set<std::size_t> used;
    double sum = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (!chosen[i]) {
            sum += kAlone;
            continue;
        }
        const auto& c = all.at(*chosen[i]);
        EXPECT_EQ(c.thing, i);
        EXPECT_TRUE(used.insert(c.detection).second) << "detection " << c.detection << " is twice";
        sum += c.match.cost;
    }
    return sum;
}

TEST(Choose, isAsGoodAsOneBigAssignment) {
    djpete_test::Random random(1);
    unsigned several = 0;
    for (int round = 0; round < 300; ++round) {
        const auto n = static_cast<std::size_t>(random.uniform(1, 14));
        const auto m = static_cast<std::size_t>(random.uniform(1, 14));
        const auto all = candidates(n, m, random.uniform(0.02, 0.5), random);
        Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(Eigen::Index(n), Eigen::Index(m),
                                                         std::numeric_limits<double>::infinity());
        for (const auto& c : all) {
            cost(Eigen::Index(c.thing), Eigen::Index(c.detection)) = c.match.cost;
        }
        const auto columns = solver::assign(cost, kAlone);
        double best = 0;
        for (std::size_t i = 0; i < n; ++i) {
            best += columns[i] ? cost(Eigen::Index(i), Eigen::Index(*columns[i])) : kAlone;
        }
        const auto chosen = choose(all, n, m, kAlone);
        ASSERT_EQ(chosen.size(), n);
        EXPECT_NEAR(costOf(all, chosen), best, 1e-9);
        for (std::size_t i = 0; i < n; ++i) {  // costs are all different: so is the choice
            ASSERT_EQ(chosen[i].has_value(), columns[i].has_value());
            if (!chosen[i]) continue;
            EXPECT_EQ(all[*chosen[i]].detection, *columns[i]);
            ++several;
        }
    }
    EXPECT_GT(several, 500U);
}

TEST(Choose, aThingGivesWayIfThatIsBetterForBoth) {
    // Greedy would take (0, 0) for 1 and leave thing 1 alone.
    const std::vector<Candidate> all{{0, 0, {1, 0}}, {0, 1, {5, 0}}, {1, 0, {2, 0}}};
    const auto chosen = choose(all, 2, 2, kAlone);
    EXPECT_EQ(chosen[0], 1U);
    EXPECT_EQ(chosen[1], 2U);
}

TEST(Choose, nothingToChooseFrom) {
    EXPECT_TRUE(choose({}, 0, 0, kAlone).empty());
    const auto chosen = choose({}, 3, 2, kAlone);
    ASSERT_EQ(chosen.size(), 3U);
    for (const auto& c : chosen) EXPECT_FALSE(c);
}

TEST(Choose, tooDearIsLeftAlone) {
    EXPECT_FALSE(choose({{0, 0, {kAlone + 1, 0}}}, 1, 1, kAlone)[0]);
    EXPECT_TRUE(choose({{0, 0, {kAlone - 1, 0}}}, 1, 1, kAlone)[0]);
}

TEST(Opposite, isMoreThanAQuarterTurnAway) {
    EXPECT_FALSE(opposite(0.4, 0.4));
    EXPECT_FALSE(opposite(1.5, 0));
    EXPECT_TRUE(opposite(1.6, 0));
    EXPECT_TRUE(opposite(3.0, 0));
    EXPECT_FALSE(opposite(3.1, -3.1));
    EXPECT_TRUE(opposite(-1.6, 1.6 - M_PI / 2 + 1.5));
}

}  // namespace
}  // namespace djpete::backend
