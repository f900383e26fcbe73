#include "normal_equations.h"

#include <algorithm>
#include <cmath>

namespace djpete::solver {

using geometry::Mat3;
using geometry::Mat6;
using geometry::Mat63;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

namespace {

double scaling(double diagonal) { return std::clamp(diagonal, 1e-6, 1e32); }

/// L^-1 of the Cholesky factor of A (lower triangle read); false if A is not positive definite.
bool inverseCholesky(const Mat3& A, Mat3& inverse) {
    const double d0 = A(0, 0);
    if (!(d0 > 0)) return false;
    const double i0 = 1 / std::sqrt(d0);
    const double l10 = A(1, 0) * i0, l20 = A(2, 0) * i0;
    const double d1 = A(1, 1) - l10 * l10;
    if (!(d1 > 0)) return false;
    const double i1 = 1 / std::sqrt(d1);
    const double l21 = (A(2, 1) - l20 * l10) * i1;
    const double d2 = A(2, 2) - l20 * l20 - l21 * l21;
    if (!(d2 > 0)) return false;
    const double i2 = 1 / std::sqrt(d2);
    inverse << i0, 0, 0, -l10 * i0 * i1, i1, 0, (l21 * l10 * i1 - l20) * i0 * i2, -l21 * i1 * i2,
        i2;
    return true;
}

/// S -= A B^T, with the columns of A held in registers.
inline void subtractProduct(const Mat63& A, const Mat63& B, double* S) {
    const Vec6 a0 = A.col(0), a1 = A.col(1), a2 = A.col(2);
    for (int c = 0; c < 6; ++c) {
        Eigen::Map<Vec6, Eigen::Aligned16>(S + 6 * c) -= a0 * B(c, 0) + a1 * B(c, 1) + a2 * B(c, 2);
    }
}

}  // namespace

NormalEquations::NormalEquations(const Problem& problem, const Structure& structure)
    : problem_(problem),
      s_(structure),
      hessian_(36 * structure.blocks.size()),
      gradient_(6 * structure.numSixes()),
      pointHessian_(structure.points.size()),
      pointGradient_(structure.points.size()),
      coupling_(structure.slotSix.size()),
      pointFactorInverse_(structure.points.size()),
      Y_(std::size_t(structure.maxSlots)),
      reduced_(36 * structure.blocks.size()),
      rightSide_(6 * structure.numSixes()) {}

bool NormalEquations::linearise(const detail::Values& x, double lambda) {
    std::fill(hessian_.begin(), hessian_.end(), 0.0);
    gradient_.setZero();
    clear();
    detail::NormalBlocks out;
    out.hessian = hessian_.data();
    out.gradient = gradient_.data();
    for (int g = 0; g < problem_.numGroups(); ++g) {
        const GroupLinks& links = s_.groups[std::size_t(g)];
        problem_.group(g).linearise(x, links.entries.data(), links.links.data(),
                                    int(links.entries.size()), out);
    }
    bool ok = true;
    for (int p = 0; p < s_.numPoints(); ++p) {
        linearisePoint(x, p);
        ok = eliminatePoint(p, lambda) && ok;
    }
    finishReduction(lambda);
    return ok;
}

bool NormalEquations::reduce(double lambda, double lambdaPoints) {
    clear();
    for (int p = 0; p < s_.numPoints(); ++p) {
        if (!eliminatePoint(p, lambdaPoints)) return false;
    }
    finishReduction(lambda);
    return true;
}

void NormalEquations::clear() {
    std::fill(reduced_.begin(), reduced_.end(), 0.0);
    rightSide_.setZero();
}

void NormalEquations::linearisePoint(const detail::Values& x, int point) {
    const auto p = std::size_t(point);
    pointHessian_[p].setZero();
    pointGradient_[p].setZero();
    for (int k = s_.slotStart[p]; k < s_.slotStart[p + 1]; ++k) coupling_[std::size_t(k)].setZero();
    detail::NormalBlocks out;
    out.hessian = hessian_.data();
    out.gradient = gradient_.data();
    out.pointHessian = &pointHessian_[p];
    out.pointGradient = &pointGradient_[p];
    out.coupling = coupling_.data() + s_.slotStart[p];
    for (int g = 0; g < problem_.numGroups(); ++g) {
        const GroupLinks& links = s_.groups[std::size_t(g)];
        const int start = links.pointStart[p];
        const int count = links.pointStart[p + 1] - start;
        if (count == 0) continue;
        problem_.group(g).linearise(x, links.pointEntries.data() + start,
                                    links.pointLinks.data() + std::ptrdiff_t(start) * links.stride,
                                    count, out);
    }
}

bool NormalEquations::eliminatePoint(int point, double lambda) {
    const auto p = std::size_t(point);
    Mat3 A = pointHessian_[p];
    for (int i = 0; i < 3; ++i) A(i, i) += lambda * scaling(A(i, i));
    Mat3& factorInverse = pointFactorInverse_[p];
    if (!inverseCholesky(A, factorInverse)) return false;
    const Vec3 y = factorInverse * pointGradient_[p];
    const int slots = s_.slotStart[p + 1] - s_.slotStart[p];
    for (int k = 0; k < slots; ++k) {
        const auto slot = std::size_t(s_.slotStart[p] + k);
        Mat63& Y = Y_[std::size_t(k)];
        Y.noalias() = coupling_[slot].lazyProduct(factorInverse.transpose());
        rightSide_.segment<6>(6 * s_.slotSix[slot]) += Y.lazyProduct(y);
    }
    const int* block = s_.pairBlock.data() + s_.pairStart[p];
    for (int i = 0; i < slots; ++i) {
        for (int j = i; j < slots; ++j) {
            subtractProduct(Y_[std::size_t(i)], Y_[std::size_t(j)],
                            reduced_.data() + 36 * std::ptrdiff_t(*block++));
        }
    }
    return true;
}

void NormalEquations::finishReduction(double lambda) {
    lambda_ = lambda;
    for (std::size_t i = 0; i < reduced_.size(); ++i) reduced_[i] += hessian_[i];
    for (int i = 0; i < s_.numSixes(); ++i) {
        for (int k = 0; k < 6; ++k) {
            const std::size_t at = 36 * std::size_t(i) + 7 * std::size_t(k);
            reduced_[at] += lambda * scaling(hessian_[at]);
        }
    }
    rightSide_ -= gradient_;
}

double NormalEquations::gradientMax() const {
    double largest = gradient_.size() ? gradient_.cwiseAbs().maxCoeff() : 0;
    for (const Vec3& g : pointGradient_) largest = std::max(largest, g.cwiseAbs().maxCoeff());
    return largest;
}

NormalEquations::Step NormalEquations::applyStep(const Eigen::VectorXd& d_sixes,
                                                 const detail::Values& x,
                                                 detail::Values& trial) const {
    Step step;
    for (int i = 0; i < s_.numSixes(); ++i) {
        const Vec6 d = d_sixes.segment<6>(6 * i);
        for (int k = 0; k < 6; ++k) {
            const double D = scaling(hessian_[36 * std::size_t(i) + 7 * std::size_t(k)]);
            step.predictedDecrease += 0.5 * d[k] * (lambda_ * D * d[k] - gradient_[6 * i + k]);
        }
        step.squaredNorm += d.squaredNorm();
        const auto [kind, index] = s_.sixes[std::size_t(i)];
        if (kind == detail::Kind::Pose) {
            const SE3& T = x.poses[std::size_t(index)];
            trial.poses[std::size_t(index)] = T * SE3::exp(d);
            step.squaredNormOfValues += T.translation().squaredNorm() + 1;
        } else {
            const Vec6& v = x.vectors[std::size_t(index)];
            trial.vectors[std::size_t(index)] = v + d;
            step.squaredNormOfValues += v.squaredNorm();
        }
    }
    for (std::size_t p = 0; p < s_.points.size(); ++p) {
        Vec3 right = pointGradient_[p];
        for (int k = s_.slotStart[p]; k < s_.slotStart[p + 1]; ++k) {
            const Mat63& W = coupling_[std::size_t(k)];
            const Vec6 d = d_sixes.segment<6>(6 * s_.slotSix[std::size_t(k)]);
            for (int c = 0; c < 3; ++c) right[c] += W.col(c).dot(d);
        }
        const Mat3& inverse = pointFactorInverse_[p];
        const Vec3 d = -(inverse.transpose() * (inverse * right));
        for (int k = 0; k < 3; ++k) {
            const double D = scaling(pointHessian_[p](k, k));
            step.predictedDecrease += 0.5 * d[k] * (lambda_ * D * d[k] - pointGradient_[p][k]);
        }
        step.squaredNorm += d.squaredNorm();
        const Vec3& value = x.points[std::size_t(s_.points[p])];
        step.squaredNormOfValues += value.squaredNorm();
        trial.points[std::size_t(s_.points[p])] = value + d;
    }
    return step;
}

}  // namespace djpete::solver
