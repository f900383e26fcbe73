/// Factorises the reduced system: densely when small, with CHOLMOD when large.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "structure.h"

namespace djpete::solver {

/// Cholesky of the symmetric matrix whose upper 6x6 blocks are Structure::blocks.
/// CHOLMOD runs in simplicial mode: without BLAS, so that no thread count changes a bit.
class ReducedSystem {
  public:
    virtual ~ReducedSystem() = default;
    /// False if the matrix is not positive definite.
    virtual bool factorise(const std::vector<double>& blocks) = 0;
    /// Solves for one right-hand side, after factorise() succeeded.
    virtual Eigen::VectorXd solve(const Eigen::VectorXd& rightSide) = 0;
    /// Smallest pivot over its diagonal entry, in (0, 1]: near 0 means singular.
    virtual double smallestPivotRatio() const = 0;
};

std::unique_ptr<ReducedSystem> makeReducedSystem(const Structure& structure, int denseUpTo);

}  // namespace djpete::solver
