#include "djpete/backend/motion_chain.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace djpete::backend {

namespace {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec6;
using Mat12 = Eigen::Matrix<double, 12, 12>;
using Vec12 = Eigen::Matrix<double, 12, 1>;

constexpr double kShortest_s = 1e-3;
constexpr double kFirstDamping = 1e-6, kLargestDamping = 1e6;

/// The motion error between two neighbours, whitened: rows a e_p + b e_v and c e_v, with
/// [a b; 0 c]' [a b; 0 c] the inverse of [dt^3/3 dt^2/2; dt^2/2 dt].
struct Whitening {
    double a, b, c;
    explicit Whitening(double dt) {
        a = std::sqrt(12 / (dt * dt * dt));
        b = -6 / (dt * dt) / a;
        c = std::sqrt(4 / dt - b * b);
    }
};

/// Cholesky factor of one block. Plain loops of fixed length: Eigen's own products and solves of
/// this size go through its kernels for large matrices.
class Pivot {
  public:
    bool compute(const Mat12& D) {
        for (int j = 0; j < 12; ++j) {
            double d = D(j, j);
            for (int k = 0; k < j; ++k) d -= L_(j, k) * L_(j, k);
            if (!(d > 0)) return false;
            inverse_[j] = 1 / std::sqrt(d);
            for (int i = j + 1; i < 12; ++i) {
                double v = D(i, j);
                for (int k = 0; k < j; ++k) v -= L_(i, k) * L_(j, k);
                L_(i, j) = v * inverse_[j];
            }
        }
        return true;
    }
    /// B becomes D^-1 B.
    template <int M>
    void solve(Eigen::Matrix<double, 12, M, M == 1 ? 0 : int(Eigen::RowMajor)>& B) const {
        for (int i = 0; i < 12; ++i) {
            for (int k = 0; k < i; ++k) B.row(i) -= L_(i, k) * B.row(k);
            B.row(i) *= inverse_[i];
        }
        for (int i = 11; i >= 0; --i) {
            for (int k = i + 1; k < 12; ++k) B.row(i) -= L_(k, i) * B.row(k);
            B.row(i) *= inverse_[i];
        }
    }

  private:
    Eigen::Matrix<double, 12, 12, Eigen::RowMajor> L_;  // below the diagonal
    std::array<double, 12> inverse_{};                  // of the diagonal
};
using Rows12 = Eigen::Matrix<double, 12, 12, Eigen::RowMajor>;

double span(const ChainNode& from, const ChainNode& to) {
    return std::max(kShortest_s, to.time_s - from.time_s);
}

class Chain {
  public:
    Chain(std::vector<ChainNode>& nodes, const MotionPrior& prior, const ChainOptions& options)
        : nodes_(nodes),
          options_(options),
          walkWeight_(prior.twistWalk.cwiseInverse()),
          twistInformation_(prior.twistSigma.cwiseAbs2().cwiseInverse()),
          n_(nodes.size()),
          diagonal_(n_),
          upper_(n_ > 0 ? n_ - 1 : 0),
          gain_(upper_.size()),
          gradient_(n_),
          step_(n_) {}

    ChainReport run() {
        ChainReport report;
        double cost = linearise(nodes_);
        report.initialCost = cost;
        double damping = kFirstDamping;
        std::vector<ChainNode> trial;
        for (; report.iterations < options_.maxIterations; ++report.iterations) {
            if (!factorise(damping)) {
                damping = std::max(damping, kFirstDamping) * 10;
                if (damping > kLargestDamping) return report;
                continue;
            }
            trial = nodes_;
            apply(trial);
            const double after = costOf(trial);
            if (!(after <= cost)) {
                damping *= 10;
                if (damping > kLargestDamping || !std::isfinite(cost)) break;
                continue;
            }
            const bool enough = cost - after <= options_.relativeTolerance * (after + 1e-9);
            nodes_.swap(trial);
            cost = after;
            damping = std::max(1e-9, 0.1 * damping);
            if (enough) break;
            linearise(nodes_);
        }
        report.finalCost = cost;
        report.usable = std::isfinite(cost);
        if (report.usable && options_.covariances) addCovariances();
        return report;
    }

  private:
    /// Weighted error of all; with no Jacobians.
    double costOf(const std::vector<ChainNode>& nodes) const {
        double sum = 0;
        for (std::size_t k = 0; k < n_; ++k) {
            sum += nodes[k].twist.cwiseAbs2().dot(twistInformation_);
            for (const auto& m : nodes[k].measured) {
                const Vec6 e = (m.T_world_obj.inverse() * nodes[k].T_world_obj).log();
                const double s = e.dot(m.information * e);
                sum += m.robust ? options_.kernel.rho(s) : s;
            }
            if (k + 1 == n_) break;
            const double dt = span(nodes[k], nodes[k + 1]);
            const Whitening w(dt);
            const Vec6 e_p = (SE3::exp(-dt * nodes[k].twist) * nodes[k].T_world_obj.inverse() *
                              nodes[k + 1].T_world_obj)
                                 .log();
            const Vec6 e_v = nodes[k + 1].twist - nodes[k].twist;
            sum += walkWeight_.cwiseProduct(w.a * e_p + w.b * e_v).squaredNorm() +
                   walkWeight_.cwiseProduct(w.c * e_v).squaredNorm();
        }
        return 0.5 * sum;
    }

    double linearise(const std::vector<ChainNode>& nodes) {
        for (std::size_t k = 0; k < n_; ++k) {
            diagonal_[k].setZero();
            gradient_[k].setZero();
        }
        double sum = 0;
        for (std::size_t k = 0; k < n_; ++k) {
            const ChainNode& node = nodes[k];
            sum += node.twist.cwiseAbs2().dot(twistInformation_);
            diagonal_[k].diagonal().tail<6>() += twistInformation_;
            gradient_[k].tail<6>() += twistInformation_.cwiseProduct(node.twist);
            for (const auto& m : node.measured) sum += addMeasured(node, m, k);
            if (k + 1 < n_) sum += addMotion(node, nodes[k + 1], k);
        }
        return 0.5 * sum;
    }

    double addMeasured(const ChainNode& node, const ChainNode::Measured& m, std::size_t k) {
        const Vec6 e = (m.T_world_obj.inverse() * node.T_world_obj).log();
        const double s = e.dot(m.information * e);
        const double weight = m.robust ? options_.kernel.weight(s) : 1;
        const Mat6 J = geometry::se3RightJacobianInverse(e);
        const Mat6 WJ = weight * (m.information * J);
        diagonal_[k].topLeftCorner<6, 6>().noalias() += J.transpose() * WJ;
        gradient_[k].head<6>().noalias() += WJ.transpose() * e;
        return m.robust ? options_.kernel.rho(s) : s;
    }

    double addMotion(const ChainNode& from, const ChainNode& to, std::size_t k) {
        const double dt = span(from, to);
        const Whitening w(dt);
        const Vec6 motion = dt * from.twist;
        const SE3 T_from_to = from.T_world_obj.inverse() * to.T_world_obj;
        const SE3 error = SE3::exp(-motion) * T_from_to;
        const Vec6 e_p = error.log(), e_v = to.twist - from.twist;

        // Rows of the first kind against (pose, twist) of both; those of the second against twists.
        const Mat6 J = (w.a * walkWeight_).asDiagonal() * geometry::se3RightJacobianInverse(e_p);
        Eigen::Matrix<double, 6, 12> A, B;
        A.leftCols<6>().noalias() = -J * T_from_to.inverse().adjoint();
        const Mat6 turn = error.inverse().adjoint() * geometry::se3RightJacobian(motion);
        A.rightCols<6>().noalias() = -dt * (J * turn);
        A.rightCols<6>().diagonal() -= w.b * walkWeight_;
        B.leftCols<6>() = J;
        B.rightCols<6>().setZero();
        B.rightCols<6>().diagonal() = w.b * walkWeight_;
        const Vec6 r = walkWeight_.cwiseProduct(w.a * e_p + w.b * e_v);
        const Vec6 c2 = w.c * w.c * walkWeight_.cwiseAbs2();

        diagonal_[k] += A.transpose().lazyProduct(A);
        diagonal_[k].diagonal().tail<6>() += c2;
        diagonal_[k + 1] += B.transpose().lazyProduct(B);
        diagonal_[k + 1].diagonal().tail<6>() += c2;
        upper_[k] = A.transpose().lazyProduct(B);
        upper_[k].diagonal().tail<6>() -= c2;
        gradient_[k].noalias() += A.transpose() * r;
        gradient_[k].tail<6>() -= c2.cwiseProduct(e_v);
        gradient_[k + 1].noalias() += B.transpose() * r;
        gradient_[k + 1].tail<6>() += c2.cwiseProduct(e_v);
        return r.squaredNorm() + c2.dot(e_v.cwiseAbs2());
    }

    /// Block Cholesky of the damped system, and the step. False if it is not positive.
    bool factorise(double damping) {
        pivots_.resize(n_);
        for (std::size_t k = 0; k < n_; ++k) {
            Mat12 D = diagonal_[k];
            D.diagonal() *= 1 + damping;
            Vec12 g = -gradient_[k];
            if (k > 0) {
                D -= upper_[k - 1].transpose().lazyProduct(gain_[k - 1]);
                g -= gain_[k - 1].transpose().lazyProduct(step_[k - 1]);
            }
            if (!pivots_[k].compute(D)) return false;
            if (k + 1 < n_) {
                gain_[k] = upper_[k];
                pivots_[k].solve(gain_[k]);
            }
            step_[k] = g;
        }
        for (std::size_t k = n_; k-- > 0;) {
            pivots_[k].solve(step_[k]);
            if (k + 1 < n_) step_[k] -= gain_[k].lazyProduct(step_[k + 1]);
        }
        return true;
    }

    void apply(std::vector<ChainNode>& nodes) const {
        for (std::size_t k = 0; k < n_; ++k) {
            nodes[k].T_world_obj =
                (nodes[k].T_world_obj * SE3::exp(step_[k].head<6>())).normalised();
            nodes[k].twist += step_[k].tail<6>();
        }
    }

    /// Diagonal blocks of the inverse, from the last node to the first.
    void addCovariances() {
        linearise(nodes_);
        if (!factorise(0)) return;
        Mat12 next = Mat12::Zero();
        for (std::size_t k = n_; k-- > 0;) {
            Rows12 inverse = Rows12::Identity();
            pivots_[k].solve(inverse);
            Mat12 P = inverse;
            if (k + 1 < n_) {
                const Mat12 carried = gain_[k].lazyProduct(next);
                P += carried.lazyProduct(gain_[k].transpose());
            }
            P = 0.5 * (P + P.transpose()).eval();
            nodes_[k].covariance = P.topLeftCorner<6, 6>();
            nodes_[k].longitudinalSigma_mps = std::sqrt(std::max(0.0, P(6, 6)));
            next = P;
        }
    }

    std::vector<ChainNode>& nodes_;
    const ChainOptions& options_;
    Vec6 walkWeight_, twistInformation_;
    std::size_t n_;
    std::vector<Mat12> diagonal_, upper_;
    std::vector<Rows12> gain_;
    std::vector<Vec12> gradient_, step_;
    std::vector<Pivot> pivots_;
};

}  // namespace

ChainReport smooth(std::vector<ChainNode>& nodes, const MotionPrior& prior,
                   const ChainOptions& options) {
    if (nodes.empty()) return {};
    return Chain(nodes, prior, options).run();
}

}  // namespace djpete::backend
