/// Optimal assignment.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace djpete::solver {

/// Column of each row such that the sum of costs is smallest, where leaving a row alone costs
/// `unassignedCost`. Entries that are not finite, or above unassignedCost, are never chosen.
/// Hungarian method with potentials (Kuhn-Munkres in the form of shortest augmenting paths), O(n^2
/// (n + m)). Ties go to the smaller index.
std::vector<std::optional<std::size_t>> assign(const Eigen::MatrixXd& cost, double unassignedCost);

}  // namespace djpete::solver
