/// All residuals of one type and one list of variable kinds, side by side in memory.
///
/// The solver speaks to a group once per landmark or once per solve, never once per residual;
/// inside, everything has a fixed size.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "djpete/geometry/se3.h"
#include "djpete/solver/ids.h"
#include "djpete/solver/robust_kernel.h"

namespace djpete::solver::detail {

using geometry::Mat3;
using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;
using Mat63 = geometry::Mat63;

enum class Kind { Pose, Point, Vector };

/// The state of all variables.
struct Values {
    std::vector<SE3> poses;
    std::vector<Vec3> points;
    std::vector<Vec6> vectors;
};

template <class Id>
struct VariableTraits {
    static constexpr bool isId = false;
};
template <>
struct VariableTraits<PoseId> {
    static constexpr bool isId = true;
    static constexpr Kind kind = Kind::Pose;
    static constexpr int dof = 6;
    static const SE3& value(const Values& x, int i) { return x.poses[std::size_t(i)]; }
};
template <>
struct VariableTraits<PointId> {
    static constexpr bool isId = true;
    static constexpr Kind kind = Kind::Point;
    static constexpr int dof = 3;
    static const Vec3& value(const Values& x, int i) { return x.points[std::size_t(i)]; }
};
template <>
struct VariableTraits<VectorId> {
    static constexpr bool isId = true;
    static constexpr Kind kind = Kind::Vector;
    static constexpr int dof = 6;
    static const Vec6& value(const Values& x, int i) { return x.vectors[std::size_t(i)]; }
};

/// What evaluating a group yields.
struct CostSum {
    double cost = 0;  ///< sum of rho / 2; of the fixed penalty for residuals that are not defined
    int residuals = 0;
    int inliers = 0;
    int invalid = 0;
    int firstNotFinite = -1;  ///< entry whose error is NaN or infinite
};

/// Where one residual adds its share. Blocks are 6x6, column-major, of the upper triangle.
struct NormalBlocks {
    double* hessian = nullptr;     ///< 36 per block
    double* gradient = nullptr;    ///< 6 per free six-vector: J^T r
    Mat3* pointHessian = nullptr;  ///< null: the point is constant (or there is none)
    Vec3* pointGradient = nullptr;
    Mat63* coupling = nullptr;  ///< one per six-vector that sees the point: J_six^T J_point
};

/// The links of one entry into NormalBlocks, as ints: for its k-th six-dimensional variable
/// [2k] = free index or -1 and [2k+1] = coupling slot; then, for each pair a < b of them,
/// 2 * block + (1 if the block is stored as (b, a)), or -1.
constexpr int linkStride(int sixes) { return 2 * sixes + sixes * (sixes - 1) / 2; }

class ResidualGroup {
  public:
    virtual ~ResidualGroup() = default;
    virtual std::string name() const = 0;
    virtual int size() const = 0;
    virtual const std::vector<Kind>& kinds() const = 0;
    /// Indices of the entry's variables, as many as kinds().
    virtual const int* variables(int entry) const = 0;
    virtual bool enabled(int entry) const = 0;
    virtual void setEnabled(int entry, bool enabled) = 0;
    virtual std::optional<double> squaredNorm(int entry, const Values& x) const = 0;
    virtual CostSum cost(const Values& x, double invalidSquaredNorm) const = 0;
    /// Adds J^T J and J^T r of `entries[0..count)` (IRLS weights) to `out`.
    virtual void linearise(const Values& x, const int* entries, const int* links, int count,
                           const NormalBlocks& out) const = 0;
};

/// One address per type: finds the group of a residual without RTTI.
template <class T>
inline constexpr char kTypeTag = 0;

template <class T>
const std::optional<T>& asOptional(const std::optional<T>& r) {
    return r;
}
template <class T>
std::optional<T> asOptional(const T& r) {
    return r;
}

template <class R, class... Ids>
class TypedGroup final : public ResidualGroup {
    static constexpr int kCount = sizeof...(Ids);
    static constexpr std::array<int, kCount> kDof = {VariableTraits<Ids>::dof...};
    static constexpr int kSixes = ((VariableTraits<Ids>::dof == 6 ? 1 : 0) + ...);
    static constexpr int kStride = linkStride(kSixes);
    static_assert(kCount - kSixes <= 1, "a residual may see one point at most");

    using Vec = Eigen::Matrix<double, R::kDim, 1>;
    template <int Dof>
    using Jac = Eigen::Matrix<double, R::kDim, Dof>;
    using Jacobians = std::tuple<Jac<VariableTraits<Ids>::dof>...>;
    using Sequence = std::index_sequence_for<Ids...>;

    struct Entry {
        R residual;
        RobustKernel kernel;
        std::array<int, kCount> variables;
        bool enabled;
    };

  public:
    int add(const R& residual, const RobustKernel& kernel, Ids... ids) {
        entries_.push_back({residual, kernel, {ids.index...}, true});
        return size() - 1;
    }
    void reserve(int n) { entries_.reserve(std::size_t(n)); }

    std::string name() const override { return R::kName; }
    int size() const override { return int(entries_.size()); }
    const std::vector<Kind>& kinds() const override { return kinds_; }
    const int* variables(int entry) const override { return at(entry).variables.data(); }
    bool enabled(int entry) const override { return at(entry).enabled; }
    void setEnabled(int entry, bool on) override { entries_[std::size_t(entry)].enabled = on; }

    std::optional<double> squaredNorm(int entry, const Values& x) const override {
        const auto r = evaluate(at(entry), x, Sequence{});
        if (!r) return std::nullopt;
        return r->squaredNorm();
    }

    CostSum cost(const Values& x, double invalidSquaredNorm) const override {
        CostSum sum;
        for (const Entry& e : entries_) {
            if (!e.enabled) continue;
            ++sum.residuals;
            const auto r = evaluate(e, x, Sequence{});
            if (!r) {
                ++sum.invalid;
                sum.cost += 0.5 * e.kernel.rho(invalidSquaredNorm);
                continue;
            }
            const double s = r->squaredNorm();
            if (!std::isfinite(s) && sum.firstNotFinite < 0) {
                sum.firstNotFinite = int(&e - entries_.data());
            }
            if (e.kernel.isInlier(s)) ++sum.inliers;
            sum.cost += 0.5 * e.kernel.rho(s);
        }
        return sum;
    }

    void linearise(const Values& x, const int* entries, const int* links, int count,
                   const NormalBlocks& out) const override {
        Jacobians J;
        for (int k = 0; k < count; ++k, links += kStride) {
            const Entry& e = at(entries[k]);
            const auto r = evaluateWithJacobians(e, x, links, out, J, Sequence{});
            if (!r) continue;
            const double weight = e.kernel.weight(r->squaredNorm());
            accumulate(*r, weight, J, links, out, Sequence{});
        }
    }

  private:
    const Entry& at(int entry) const { return entries_[std::size_t(entry)]; }

    /// Ordinal of variable I among the six-dimensional ones.
    static constexpr int ordinal(std::size_t I) {
        int n = 0;
        for (std::size_t i = 0; i < I; ++i) n += kDof[i] == 6 ? 1 : 0;
        return n;
    }
    static constexpr int pairIndex(int a, int b) {
        return 2 * kSixes + a * kSixes - a * (a + 1) / 2 + (b - a - 1);
    }

    template <std::size_t... I>
    static std::optional<Vec> evaluate(const Entry& e, const Values& x, std::index_sequence<I...>) {
        return asOptional(e.residual(VariableTraits<Ids>::value(x, e.variables[I])...));
    }

    template <std::size_t I>
    static auto wanted(Jacobians& J, const int* links, const NormalBlocks& out)
        -> decltype(&std::get<I>(J)) {
        bool free = out.pointHessian != nullptr;
        if constexpr (kDof[I] == 6) free = links[2 * ordinal(I)] >= 0;
        return free ? &std::get<I>(J) : nullptr;
    }

    template <std::size_t... I>
    static std::optional<Vec> evaluateWithJacobians(const Entry& e, const Values& x,
                                                    const int* links, const NormalBlocks& out,
                                                    Jacobians& J, std::index_sequence<I...>) {
        return asOptional(e.residual(VariableTraits<Ids>::value(x, e.variables[I])...,
                                     wanted<I>(J, links, out)...));
    }

    template <std::size_t... I>
    static void accumulate(const Vec& r, double weight, const Jacobians& J, const int* links,
                           const NormalBlocks& out, std::index_sequence<I...>) {
        (accumulateVariable<I>(r, weight, J, links, out, std::index_sequence<I...>{}), ...);
    }

    template <std::size_t A, std::size_t... B>
    static void accumulateVariable(const Vec& r, double weight, const Jacobians& J,
                                   const int* links, const NormalBlocks& out,
                                   std::index_sequence<B...>) {
        // The weighted transpose, column-major, so that sums run down whole columns.
        using Transposed = Eigen::Matrix<double, kDof[A], R::kDim>;
        if constexpr (kDof[A] == 6) {
            const int a = links[2 * ordinal(A)];
            if (a < 0) return;
            const Transposed Jt = weight * std::get<A>(J).transpose();
            Eigen::Map<Mat6>(out.hessian + 36 * std::ptrdiff_t(a)) +=
                Jt.lazyProduct(std::get<A>(J));
            Eigen::Map<Vec6>(out.gradient + 6 * std::ptrdiff_t(a)) += Jt.lazyProduct(r);
            (accumulatePair<A, B>(Jt, J, links, out), ...);
        } else {
            if (!out.pointHessian) return;
            const Transposed Jt = weight * std::get<A>(J).transpose();
            *out.pointHessian += Jt.lazyProduct(std::get<A>(J));
            *out.pointGradient += Jt.lazyProduct(r);
        }
    }

    template <std::size_t A, std::size_t B, class Transposed>
    static void accumulatePair(const Transposed& Jt, const Jacobians& J, const int* links,
                               const NormalBlocks& out) {
        if constexpr (kDof[B] == 3) {
            if (!out.pointHessian) return;
            out.coupling[links[2 * ordinal(A) + 1]] += Jt.lazyProduct(std::get<B>(J));
        } else if constexpr (A < B) {
            const int link = links[pairIndex(ordinal(A), ordinal(B))];
            if (link < 0) return;
            Eigen::Map<Mat6> block(out.hessian + 36 * std::ptrdiff_t(link / 2));
            if (link % 2) {
                block += Jt.lazyProduct(std::get<B>(J)).transpose();
            } else {
                block += Jt.lazyProduct(std::get<B>(J));
            }
        }
    }

    std::vector<Entry> entries_;
    std::vector<Kind> kinds_{VariableTraits<Ids>::kind...};
};

}  // namespace djpete::solver::detail
