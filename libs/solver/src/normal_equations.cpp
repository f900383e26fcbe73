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

using Four = double __attribute__((vector_size(32), aligned(8)));

/// Blocks of the reduced matrix -= Y_i Y_j^T for all pairs i <= j of `slots` 6x3 matrices, which
/// lie one after another, column by column. Two columns of a block are three fours. Wider
/// registers, where the processor has them, give the same sums bit by bit: nothing is fused or
/// re-ordered.
#if defined(__x86_64__)
__attribute__((target_clones("avx2", "default")))
#endif
void subtractProducts(const double* Y, int slots, const int* block, double* reduced) {
    for (int i = 0; i < slots; ++i) {
        const double* A = Y + 18 * i;
        Four a[9] = {};
        for (int k = 0; k < 3; ++k) {
            const double* c = A + 6 * k;
            a[3 * k] = Four{c[0], c[1], c[2], c[3]};
            a[3 * k + 1] = Four{c[4], c[5], c[0], c[1]};
            a[3 * k + 2] = Four{c[2], c[3], c[4], c[5]};
        }
        for (int j = i; j < slots; ++j) {
            const double* B = Y + 18 * j;
            auto* S = reinterpret_cast<Four*>(reduced + 36 * std::ptrdiff_t(*block++));
            for (int c = 0; c < 6; c += 2, S += 3) {
                const double p0 = B[c], p1 = B[6 + c], p2 = B[12 + c];
                const double q0 = B[c + 1], q1 = B[7 + c], q2 = B[13 + c];
                S[0] -= a[0] * p0 + a[3] * p1 + a[6] * p2;
                S[1] -= a[1] * Four{p0, p0, q0, q0} + a[4] * Four{p1, p1, q1, q1} +
                        a[7] * Four{p2, p2, q2, q2};
                S[2] -= a[2] * q0 + a[5] * q1 + a[8] * q2;
            }
        }
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
    if (slots > 0) {
        subtractProducts(Y_[0].data(), slots, s_.pairBlock.data() + s_.pairStart[p],
                         reduced_.data());
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
