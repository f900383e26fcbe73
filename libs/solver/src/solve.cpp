#include "djpete/solver/solve.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "normal_equations.h"
#include "reduced_system.h"

namespace djpete::solver {

namespace {

constexpr double kMaxDamping = 1e20;
constexpr double kMinDamping = 1e-12;
/// A step is taken if it brings at least this part of the decrease that the linear model predicts.
constexpr double kMinGain = 1e-3;
/// Below this part of the cost a decrease drowns in rounding.
constexpr double kRounding = 1e-15;

/// Sum over all groups; firstNotFinite becomes a sentence.
struct TotalCost {
    detail::CostSum sum;
    std::string notFinite;
};

TotalCost totalCost(const Problem& problem, const detail::Values& x, const Options& options) {
    TotalCost total;
    for (int g = 0; g < problem.numGroups(); ++g) {
        const detail::CostSum s = problem.group(g).cost(x, options.invalidSquaredNorm);
        total.sum.cost += s.cost;
        total.sum.residuals += s.residuals;
        total.sum.inliers += s.inliers;
        total.sum.invalid += s.invalid;
        if (s.firstNotFinite >= 0 && total.notFinite.empty()) {
            total.notFinite = problem.group(g).name() + " number " +
                              std::to_string(s.firstNotFinite) + " is not finite";
        }
    }
    return total;
}

/// Names the first variable with a NaN or infinity, or says nothing.
std::string notFiniteVariable(const detail::Values& x) {
    for (std::size_t i = 0; i < x.poses.size(); ++i) {
        if (!x.poses[i].rotation().allFinite() || !x.poses[i].translation().allFinite()) {
            return "pose number " + std::to_string(i) + " is not finite";
        }
    }
    for (std::size_t i = 0; i < x.points.size(); ++i) {
        if (!x.points[i].allFinite()) return "point number " + std::to_string(i) + " is not finite";
    }
    for (std::size_t i = 0; i < x.vectors.size(); ++i) {
        if (!x.vectors[i].allFinite()) {
            return "vector number " + std::to_string(i) + " is not finite";
        }
    }
    return {};
}

/// Levenberg-Marquardt with Nielsen's update of the damping.
class LevenbergMarquardt {
  public:
    LevenbergMarquardt(const Problem& problem, const Options& options, const Structure& structure,
                       double cost)
        : problem_(problem),
          options_(options),
          equations_(problem, structure),
          system_(makeReducedSystem(structure, options.denseUpTo)),
          structure_(structure),
          x_(problem.values()),
          trial_(x_),
          cost_(cost),
          lambda_(std::clamp(options.initialDamping, kMinDamping, kMaxDamping)) {}

    void run(Report& report) {
        bool linearised = false;
        for (report.iterations = 0; report.iterations < options_.maxIterations;) {
            const bool reduced = linearised ? equations_.reduce(lambda_, lambda_)
                                            : equations_.linearise(x_, lambda_);
            if (!linearised && equations_.gradientMax() <= options_.gradientTolerance) {
                return finish(report, Status::Converged, "the gradient vanishes");
            }
            linearised = true;
            ++report.iterations;
            const auto outcome = tryStep(reduced);
            if (outcome == Outcome::Taken) {
                linearised = false;
                moved_ = true;
            } else if (outcome == Outcome::Rejected) {
                lambda_ *= growth_;
                growth_ *= 2;
                if (lambda_ > kMaxDamping) {
                    return finish(report, Status::Stalled, "no step lowers the cost");
                }
            } else {
                return finish(report, Status::Converged, "the steps no longer matter");
            }
        }
        finish(report, Status::MaxIterations, "the iterations were used up");
    }

    bool moved() const { return moved_; }
    const detail::Values& values() const { return x_; }
    double cost() const { return cost_; }

  private:
    enum class Outcome { Taken, Rejected, Converged };

    Outcome tryStep(bool reduced) {
        if (!reduced || !factorise()) return Outcome::Rejected;
        const Eigen::VectorXd d = structure_.numSixes()
                                      ? system_->solve(equations_.reducedRightSide())
                                      : Eigen::VectorXd();
        if (!d.allFinite()) return Outcome::Rejected;
        const NormalEquations::Step step = equations_.applyStep(d, x_, trial_);
        if (!std::isfinite(step.squaredNorm)) return Outcome::Rejected;
        if (step.predictedDecrease <= kRounding * cost_) return Outcome::Converged;
        const double trialCost = totalCost(problem_, trial_, options_).sum.cost;
        const double decrease = cost_ - trialCost;
        const double gain = decrease / step.predictedDecrease;
        if (!std::isfinite(trialCost) || !(gain >= kMinGain)) return Outcome::Rejected;
        const double before = cost_;
        std::swap(x_, trial_);
        cost_ = trialCost;
        moved_ = true;
        lambda_ = std::max(kMinDamping, lambda_ * std::max(1.0 / 3, 1 - std::pow(2 * gain - 1, 3)));
        growth_ = 2;
        const double stepLimit =
            options_.stepTolerance * (std::sqrt(step.squaredNormOfValues) + options_.stepTolerance);
        const bool small = decrease <= options_.functionTolerance * before ||
                           std::sqrt(step.squaredNorm) <= stepLimit;
        return small ? Outcome::Converged : Outcome::Taken;
    }

    bool factorise() {
        return structure_.numSixes() == 0 || system_->factorise(equations_.reducedBlocks());
    }

    static void finish(Report& report, Status status, const char* message) {
        report.status = status;
        report.message = message;
    }

    const Problem& problem_;
    const Options& options_;
    NormalEquations equations_;
    std::unique_ptr<ReducedSystem> system_;
    const Structure& structure_;
    detail::Values x_, trial_;
    double cost_;
    double lambda_;
    double growth_ = 2;
    bool moved_ = false;
};

Report stopped(Status status, const std::string& message, const TotalCost& cost) {
    Report report;
    report.status = status;
    report.message = message;
    report.initialCost = report.finalCost = cost.sum.cost;
    report.numResiduals = cost.sum.residuals;
    report.numInliers = cost.sum.inliers;
    report.numInvalid = cost.sum.invalid;
    return report;
}

Report solveUntimed(Problem& problem, const Options& options) {
    const std::string bad = notFiniteVariable(problem.values());
    if (!bad.empty()) return stopped(Status::InvalidInput, bad, {});
    const TotalCost before = totalCost(problem, problem.values(), options);
    if (!before.notFinite.empty()) return stopped(Status::InvalidInput, before.notFinite, before);
    if (before.sum.residuals == 0) {
        return stopped(Status::NothingToSolve, "there is no residual", before);
    }
    const Structure structure(problem);
    if (structure.empty()) {
        return stopped(Status::NothingToSolve, "no residual sees a free variable", before);
    }
    if (before.sum.invalid == before.sum.residuals) {
        return stopped(Status::NothingToSolve, "no residual is defined (behind the camera)",
                       before);
    }
    LevenbergMarquardt solver(problem, options, structure, before.sum.cost);
    Report report;
    report.initialCost = before.sum.cost;
    solver.run(report);
    if (solver.moved()) {
        detail::Values x = solver.values();
        for (const auto& [kind, index] : structure.sixes) {
            if (kind == detail::Kind::Pose) {
                auto& T = x.poses[std::size_t(index)];
                T = T.normalised();
            }
        }
        problem.setValues(x);
    }
    const detail::CostSum after = totalCost(problem, problem.values(), options).sum;
    report.finalCost = solver.cost();
    report.numResiduals = after.residuals;
    report.numInliers = after.inliers;
    report.numInvalid = after.invalid;
    return report;
}

}  // namespace

Report solve(Problem& problem, const Options& options) {
    const auto start = std::chrono::steady_clock::now();
    Report report = solveUntimed(problem, options);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    report.time_ms = time.count();
    return report;
}

const char* toString(Status status) {
    switch (status) {
        case Status::Converged:
            return "converged";
        case Status::MaxIterations:
            return "max iterations";
        case Status::Stalled:
            return "stalled";
        case Status::NothingToSolve:
            return "nothing to solve";
        case Status::InvalidInput:
            return "invalid input";
    }
    return "?";
}

}  // namespace djpete::solver
