/// How to solve a Problem (Options) and what came out (Report).
#pragma once

#include <optional>
#include <string>

#include "djpete/solver/problem.h"

namespace djpete::solver {

/// Levenberg-Marquardt's knobs. The defaults suit bundle adjustment in metres, radians and sigmas.
struct Options {
    int maxIterations = 50;            ///< tries, taken or not
    double functionTolerance = 1e-6;   ///< converged if a step lowers the cost by less, relatively
    double gradientTolerance = 1e-10;  ///< ... if no entry of the gradient is larger
    double stepTolerance = 1e-8;   ///< ... if the step is this much shorter than the free variables
    double initialDamping = 1e-4;  ///< lambda: the system solved is H + lambda diag(H)
    /// A residual that is not defined (a point behind the camera) pulls at nothing and costs a
    /// fixed rho(invalidSquaredNorm) / 2, so that a step gains nothing by throwing points behind
    /// the camera, and one lost point does not hold up all others. 100 sigma by default.
    double invalidSquaredNorm = 1e4;
    /// Up to this many free poses and vectors the reduced system is factorised densely.
    int denseUpTo = 60;
};

enum class Status {
    Converged,       ///< a tolerance was met
    MaxIterations,   ///< stopped by Options::maxIterations; the best values are kept
    Stalled,         ///< no step lowers the cost, however damped; the best values are kept
    NothingToSolve,  ///< no residual sees a free variable; the variables are untouched
    InvalidInput     ///< a variable or residual is not finite; the variables are untouched
};
const char* toString(Status status);

struct Report {
    Status status = Status::NothingToSolve;
    std::string message;  ///< one sentence
    int iterations = 0;   ///< steps tried
    double initialCost = 0;
    double finalCost = 0;  ///< never above initialCost
    int numResiduals = 0;  ///< enabled ones
    int numInliers = 0;    ///< at the end: defined, and within its kernel's scale
    int numInvalid = 0;    ///< at the end: not defined (behind the camera)
    double time_ms = 0;    ///< wall clock; the only field that differs between equal runs

    /// The variables hold a solution that is no worse than before.
    bool usable() const {
        return status != Status::InvalidInput && status != Status::NothingToSolve;
    }
};

/// Minimises the robust cost by Levenberg-Marquardt (gain ratio, iterated re-weighting),
/// eliminating the points landmark by landmark. Writes the best values found back into `problem`;
/// constant variables and variables no residual sees stay bit-identical, and nothing is ever
/// overwritten by NaN. Singular and under-constrained problems are held by the damping.
/// Single-threaded and deterministic: the same problem gives the same bytes.
Report solve(Problem& problem, const Options& options = {});

/// Marginal covariances at the present values (solve first): the inverse of the undamped,
/// re-weighted Hessian, other variables marginalised; for a pose in its own frame (right
/// perturbation), order (rho, phi). Nothing for a variable that is constant, seen by no residual,
/// or if the system is singular.
std::vector<std::optional<geometry::Mat6>> covariances(const Problem& problem,
                                                       const std::vector<PoseId>& poses);
std::vector<std::optional<geometry::Mat6>> covariances(const Problem& problem,
                                                       const std::vector<VectorId>& vectors);
std::optional<geometry::Mat6> covariance(const Problem& problem, PoseId pose);
std::optional<geometry::Mat6> covariance(const Problem& problem, VectorId vector);

}  // namespace djpete::solver
