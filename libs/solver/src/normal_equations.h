/// The damped normal equations of one linearisation, reduced by the points.
#pragma once

#include "structure.h"

namespace djpete::solver {

/// H d = -g with H = sum w J^T J, g = sum w J^T r; points eliminated one landmark at a time:
///     (H_cc + l D_c - sum Y Y^T) d_c = -(g_c - sum Y y),   Y = W L^-T,  y = L^-1 g_p,
///     d_p = -L^-T (y + Y^T d_c),                           L L^T = H_pp + l D_p
/// where D is the diagonal of H, kept within [1e-6, 1e32] (Marquardt's scaling).
class NormalEquations {
  public:
    NormalEquations(const Problem& problem, const Structure& structure);

    /// Linearises at `x` and reduces with damping `lambda`, landmark by landmark. False if a
    /// landmark cannot be eliminated (its block is not positive definite).
    bool linearise(const detail::Values& x, double lambda);
    /// Reduces the last linearisation again, with other dampings of sixes and points.
    bool reduce(double lambda, double lambdaPoints);

    /// Blocks of the reduced matrix, 36 doubles each, numbered as Structure::blocks.
    const std::vector<double>& reducedBlocks() const { return reduced_; }
    /// Right-hand side of the reduced system.
    const Eigen::VectorXd& reducedRightSide() const { return rightSide_; }
    /// Largest entry of g.
    double gradientMax() const;

    /// From the solution d_c, writes x + d to `trial`; returns the decrease of cost that the linear
    /// model predicts and |d|^2, |x|^2 over the free variables.
    struct Step {
        double predictedDecrease = 0, squaredNorm = 0, squaredNormOfValues = 0;
    };
    Step applyStep(const Eigen::VectorXd& d_sixes, const detail::Values& x,
                   detail::Values& trial) const;

  private:
    void clear();
    void linearisePoint(const detail::Values& x, int point);
    bool eliminatePoint(int point, double lambda);
    void finishReduction(double lambda);

    const Problem& problem_;
    const Structure& s_;
    double lambda_ = 0;  // of the last reduction

    std::vector<double> hessian_;  // blocks before elimination
    Eigen::VectorXd gradient_;
    std::vector<geometry::Mat3> pointHessian_;
    std::vector<geometry::Vec3> pointGradient_;
    std::vector<geometry::Mat63> coupling_;           // W, per slot
    std::vector<geometry::Mat3> pointFactorInverse_;  // L^-1
    std::vector<geometry::Mat63> Y_;                  // scratch of one point
    std::vector<double> reduced_;
    Eigen::VectorXd rightSide_;
};

}  // namespace djpete::solver
