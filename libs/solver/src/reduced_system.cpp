#include "reduced_system.h"

#include <cholmod.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace djpete::solver {

namespace {

using BlockMap = Eigen::Map<const geometry::Mat6>;

class DenseSystem final : public ReducedSystem {
  public:
    explicit DenseSystem(const Structure& s)
        : s_(s), A_(Eigen::MatrixXd::Zero(6 * s.numSixes(), 6 * s.numSixes())), llt_(A_.rows()) {}

    bool factorise(const std::vector<double>& blocks) override {
        for (std::size_t b = 0; b < s_.blocks.size(); ++b) {
            const auto [row, column] = s_.blocks[b];
            // The lower triangle is read.
            A_.block<6, 6>(6 * column, 6 * row) = BlockMap(blocks.data() + 36 * b).transpose();
        }
        llt_.compute(A_);
        return llt_.info() == Eigen::Success;
    }

    Eigen::VectorXd solve(const Eigen::VectorXd& rightSide) override {
        return llt_.solve(rightSide);
    }

    double smallestPivotRatio() const override {
        double smallest = 1;
        for (Eigen::Index i = 0; i < A_.rows(); ++i) {
            const double l = llt_.matrixLLT()(i, i);
            smallest = std::min(smallest, l * l / A_(i, i));
        }
        return smallest;
    }

  private:
    const Structure& s_;
    Eigen::MatrixXd A_;
    Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> llt_;
};

class SparseSystem final : public ReducedSystem {
  public:
    explicit SparseSystem(const Structure& s) : s_(s) {
        cholmod_start(&common_);
        common_.print = 0;
        common_.supernodal = CHOLMOD_SIMPLICIAL;
        common_.final_ll = 1;
        common_.nmethods = 1;
        common_.method[0].ordering = CHOLMOD_AMD;
        allocatePattern();
        factor_ = cholmod_analyze(A_, &common_);
        if (!factor_) {
            free();
            throw std::bad_alloc();
        }
    }
    ~SparseSystem() override { free(); }
    SparseSystem(const SparseSystem&) = delete;
    SparseSystem& operator=(const SparseSystem&) = delete;

    bool factorise(const std::vector<double>& blocks) override {
        auto* const value = static_cast<double*>(A_->x);
        const auto* const start = static_cast<const int*>(A_->p);
        for (std::size_t b = 0; b < s_.blocks.size(); ++b) {
            const auto [row, column] = s_.blocks[b];
            for (int c = 0; c < 6; ++c) {
                const std::size_t rows = row == column ? std::size_t(c) + 1 : 6;
                std::memcpy(value + start[6 * column + c] + 6 * rank_[b],
                            blocks.data() + 36 * b + 6 * std::size_t(c), rows * sizeof(double));
            }
        }
        return cholmod_factorize(A_, factor_, &common_) && common_.status == CHOLMOD_OK &&
               factor_->minor == factor_->n;
    }

    Eigen::VectorXd solve(const Eigen::VectorXd& rightSide) override {
        cholmod_dense b{};
        b.nrow = b.nzmax = b.d = std::size_t(rightSide.size());
        b.ncol = 1;
        b.x = const_cast<double*>(rightSide.data());
        b.xtype = CHOLMOD_REAL;
        b.dtype = CHOLMOD_DOUBLE;
        cholmod_dense* x = cholmod_solve(CHOLMOD_A, factor_, &b, &common_);
        if (!x) throw std::bad_alloc();
        const Eigen::VectorXd out =
            Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(x->x), rightSide.size());
        cholmod_free_dense(&x, &common_);
        return out;
    }

    double smallestPivotRatio() const override {
        const auto* const l = static_cast<const double*>(factor_->x);
        const auto* const lStart = static_cast<const int*>(factor_->p);
        const auto* const permutation = static_cast<const int*>(factor_->Perm);
        const auto* const a = static_cast<const double*>(A_->x);
        const auto* const aStart = static_cast<const int*>(A_->p);
        double smallest = 1;
        for (std::size_t i = 0; i < factor_->n; ++i) {
            const double pivot = l[lStart[i]];
            const double diagonal = a[aStart[permutation[i] + 1] - 1];  // last of its column
            smallest = std::min(smallest, pivot * pivot / diagonal);
        }
        return smallest;
    }

  private:
    /// Upper triangle, column by column; rank_[b] is how many blocks lie above block b.
    void allocatePattern() {
        const auto n = std::size_t(s_.numSixes());
        std::vector<std::vector<std::pair<int, std::size_t>>> columns(n);
        for (std::size_t b = 0; b < s_.blocks.size(); ++b) {
            columns[std::size_t(s_.blocks[b].second)].emplace_back(s_.blocks[b].first, b);
        }
        rank_.resize(s_.blocks.size());
        const std::size_t entries = 36 * (s_.blocks.size() - n) + 21 * n;
        A_ = cholmod_allocate_sparse(6 * n, 6 * n, entries, 1, 1, 1, CHOLMOD_REAL, &common_);
        if (!A_) throw std::bad_alloc();
        auto* const start = static_cast<int*>(A_->p);
        auto* const row = static_cast<int*>(A_->i);
        int k = 0;
        for (std::size_t j = 0; j < n; ++j) {
            std::sort(columns[j].begin(), columns[j].end());
            for (std::size_t r = 0; r < columns[j].size(); ++r)
                rank_[columns[j][r].second] = int(r);
            for (int c = 0; c < 6; ++c) {
                start[6 * int(j) + c] = k;
                for (const auto& [i, b] : columns[j]) {
                    const int rows = i == int(j) ? c + 1 : 6;
                    for (int r = 0; r < rows; ++r) row[k++] = 6 * i + r;
                }
            }
        }
        start[6 * n] = k;
    }

    void free() {
        if (factor_) cholmod_free_factor(&factor_, &common_);
        if (A_) cholmod_free_sparse(&A_, &common_);
        cholmod_finish(&common_);
    }

    const Structure& s_;
    cholmod_common common_{};
    cholmod_sparse* A_ = nullptr;
    cholmod_factor* factor_ = nullptr;
    std::vector<int> rank_;
};

}  // namespace

std::unique_ptr<ReducedSystem> makeReducedSystem(const Structure& structure, int denseUpTo) {
    if (structure.numSixes() <= denseUpTo) return std::make_unique<DenseSystem>(structure);
    return std::make_unique<SparseSystem>(structure);
}

}  // namespace djpete::solver
