#include "djpete/solver/assignment.h"

#include <cmath>
#include <limits>

namespace djpete::solver {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Shortest augmenting paths over a matrix with at least as many columns as rows, all finite.
/// Returns the column of each row.
class Augmenter {
  public:
    explicit Augmenter(const Eigen::MatrixXd& cost)
        : cost_(cost),
          n_(static_cast<std::size_t>(cost.rows())),
          m_(static_cast<std::size_t>(cost.cols())),
          rowPotential_(n_ + 1, 0),
          columnPotential_(m_ + 1, 0),
          rowOfColumn_(m_ + 1, 0) {}

    std::vector<std::size_t> run() {
        for (std::size_t row = 1; row <= n_; ++row) augment(row);
        std::vector<std::size_t> columnOfRow(n_);
        for (std::size_t j = 1; j <= m_; ++j) {
            if (rowOfColumn_[j] != 0) columnOfRow[rowOfColumn_[j] - 1] = j - 1;
        }
        return columnOfRow;
    }

  private:
    // Rows and columns count from 1; column 0 is where the path starts, row 0 is "free".
    void augment(std::size_t row) {
        std::vector<double> slack(m_ + 1, kInfinity);
        std::vector<std::size_t> previous(m_ + 1, 0);
        std::vector<bool> visited(m_ + 1, false);
        rowOfColumn_[0] = row;
        std::size_t j = 0;
        do {
            visited[j] = true;
            j = relax(j, slack, previous, visited);
        } while (rowOfColumn_[j] != 0);
        while (j != 0) {
            rowOfColumn_[j] = rowOfColumn_[previous[j]];
            j = previous[j];
        }
    }

    /// Extends the tree from column j; returns the nearest column outside it.
    std::size_t relax(std::size_t j, std::vector<double>& slack, std::vector<std::size_t>& previous,
                      const std::vector<bool>& visited) {
        const std::size_t i = rowOfColumn_[j];
        double step = kInfinity;
        std::size_t nearest = 0;
        for (std::size_t k = 1; k <= m_; ++k) {
            if (visited[k]) continue;
            const double reduced =
                cost_(static_cast<Eigen::Index>(i - 1), static_cast<Eigen::Index>(k - 1)) -
                rowPotential_[i] - columnPotential_[k];
            if (reduced < slack[k]) {
                slack[k] = reduced;
                previous[k] = j;
            }
            if (slack[k] < step) {
                step = slack[k];
                nearest = k;
            }
        }
        for (std::size_t k = 0; k <= m_; ++k) {
            if (visited[k]) {
                rowPotential_[rowOfColumn_[k]] += step;
                columnPotential_[k] -= step;
            } else {
                slack[k] -= step;
            }
        }
        return nearest;
    }

    const Eigen::MatrixXd& cost_;
    std::size_t n_, m_;
    std::vector<double> rowPotential_, columnPotential_;
    std::vector<std::size_t> rowOfColumn_;
};

}  // namespace

std::vector<std::optional<std::size_t>> assign(const Eigen::MatrixXd& cost, double unassignedCost) {
    const Eigen::Index n = cost.rows(), m = cost.cols();
    // One spare column per row stands for "left alone"; forbidden entries cost more than that.
    const double forbidden = 1e6 * (1 + std::abs(unassignedCost));
    Eigen::MatrixXd square(n, m + n);
    square.rightCols(n).setConstant(unassignedCost);
    for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index j = 0; j < m; ++j) {
            const bool allowed = std::isfinite(cost(i, j)) && cost(i, j) <= unassignedCost;
            square(i, j) = allowed ? cost(i, j) : forbidden;
        }
    }
    const auto columns = Augmenter(square).run();
    std::vector<std::optional<std::size_t>> out(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (columns[i] < static_cast<std::size_t>(m)) out[i] = columns[i];
    }
    return out;
}

}  // namespace djpete::solver
