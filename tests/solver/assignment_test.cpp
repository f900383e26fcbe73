#include "djpete/solver/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "djpete_test/random.h"

namespace djpete::solver {
namespace {

double costOf(const Eigen::MatrixXd& cost, const std::vector<std::optional<std::size_t>>& columns,
              double unassigned) {
    double sum = 0;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        sum += columns[i]
                   ? cost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(*columns[i]))
                   : unassigned;
    }
    return sum;
}

/// Tries all ways.
double leastCost(const Eigen::MatrixXd& cost, double unassigned, Eigen::Index row,
                 std::vector<bool>& used) {
    if (row == cost.rows()) return 0;
    double least = unassigned + leastCost(cost, unassigned, row + 1, used);
    for (Eigen::Index j = 0; j < cost.cols(); ++j) {
        const auto k = static_cast<std::size_t>(j);
        if (used[k] || !(cost(row, j) <= unassigned)) continue;
        used[k] = true;
        least = std::min(least, cost(row, j) + leastCost(cost, unassigned, row + 1, used));
        used[k] = false;
    }
    return least;
}

TEST(Assignment, isAsGoodAsTryingAllWays) {
    djpete_test::Random random(3);
    for (int round = 0; round < 200; ++round) {
        const int n = static_cast<int>(random.uniform(0, 6));
        const int m = static_cast<int>(random.uniform(0, 6));
        Eigen::MatrixXd cost(n, m);
        for (int i = 0; i < n * m; ++i) {
            const double c = random.uniform(-5, 15);
            cost.data()[i] = c > 13 ? std::numeric_limits<double>::infinity() : c;
        }
        const auto columns = assign(cost, 10);
        ASSERT_EQ(columns.size(), static_cast<std::size_t>(n));
        std::vector<bool> used(static_cast<std::size_t>(m), false);
        for (const auto& c : columns) {
            if (!c) continue;
            EXPECT_FALSE(used[*c]);
            used[*c] = true;
        }
        std::fill(used.begin(), used.end(), false);
        EXPECT_NEAR(costOf(cost, columns, 10), leastCost(cost, 10, 0, used), 1e-9);
    }
}

TEST(Assignment, whatIsForbiddenStaysAlone) {
    Eigen::MatrixXd cost(2, 1);
    cost << std::nan(""), 11;
    const auto columns = assign(cost, 10);
    EXPECT_FALSE(columns[0]);
    EXPECT_FALSE(columns[1]);
    EXPECT_TRUE(assign(Eigen::MatrixXd(0, 3), 1).empty());
}

}  // namespace
}  // namespace djpete::solver
