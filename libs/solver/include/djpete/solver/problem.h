/// What is to be solved: variables, free or constant, and the residuals between them.
#pragma once

#include <memory>
#include <stdexcept>

#include "djpete/solver/detail/residual_group.h"

namespace djpete::solver {

/// A non-linear least squares problem: min over the free variables of sum rho(|r|^2) / 2.
///
/// Variables are poses (SE(3), perturbed on the right), points (R^3, eliminated by Schur
/// complement) and vectors of six (R^6, e.g. twists). Residuals are value types as in
/// djpete/geometry/residuals.h, copied in. Any type R serves that has `static constexpr int kDim`,
/// `static constexpr const char* kName`, and
///     Vec<kDim> or std::optional<Vec<kDim>> operator()(const SE3&|Vec3&|Vec6&..., J*...) const
/// with whitened value and Jacobians; it may see one point at most, and no variable twice.
///
/// Movable, not copyable. Not thread-safe; distinct problems are independent.
class Problem {
  public:
    using SE3 = geometry::SE3;
    using Vec3 = geometry::Vec3;
    using Vec6 = geometry::Vec6;

    PoseId addPose(const SE3& T, bool constant = false);
    PointId addPoint(const Vec3& p, bool constant = false);
    VectorId addVector6(const Vec6& v, bool constant = false);

    const SE3& pose(PoseId id) const { return values_.poses[std::size_t(id.index)]; }
    const Vec3& point(PointId id) const { return values_.points[std::size_t(id.index)]; }
    const Vec6& vector6(VectorId id) const { return values_.vectors[std::size_t(id.index)]; }
    void set(PoseId id, const SE3& T) { values_.poses[std::size_t(id.index)] = T; }
    void set(PointId id, const Vec3& p) { values_.points[std::size_t(id.index)] = p; }
    void set(VectorId id, const Vec6& v) { values_.vectors[std::size_t(id.index)] = v; }

    /// solve() leaves a constant variable bit-identical.
    void setConstant(PoseId id, bool constant = true) { at(constant_[0], id.index) = constant; }
    void setConstant(PointId id, bool constant = true) { at(constant_[1], id.index) = constant; }
    void setConstant(VectorId id, bool constant = true) { at(constant_[2], id.index) = constant; }
    bool isConstant(PoseId id) const { return constant_[0][std::size_t(id.index)]; }
    bool isConstant(PointId id) const { return constant_[1][std::size_t(id.index)]; }
    bool isConstant(VectorId id) const { return constant_[2][std::size_t(id.index)]; }

    int numPoses() const { return int(values_.poses.size()); }
    int numPoints() const { return int(values_.points.size()); }
    int numVectors() const { return int(values_.vectors.size()); }
    int numResiduals() const;

    /// Adds a residual over the variables `ids`, in the order of its operator().
    /// Throws std::invalid_argument if an id is not of this problem or a variable comes twice.
    template <class R, class... Ids,
              class = std::enable_if_t<(detail::VariableTraits<Ids>::isId && ...)>>
    ResidualId add(const R& residual, Ids... ids) {
        return add(residual, RobustKernel::none(), ids...);
    }
    template <class R, class... Ids,
              class = std::enable_if_t<(detail::VariableTraits<Ids>::isId && ...)>>
    ResidualId add(const R& residual, const RobustKernel& kernel, Ids... ids) {
        static_assert(sizeof...(Ids) > 0, "a residual needs variables");
        requireKnown({{detail::VariableTraits<Ids>::kind, ids.index}...}, R::kName);
        using Typed = detail::TypedGroup<R, Ids...>;
        const int g = findGroup(&detail::kTypeTag<Typed>);
        const int group =
            g >= 0 ? g : addGroup(&detail::kTypeTag<Typed>, std::make_unique<Typed>());
        auto& group_of_type = static_cast<Typed&>(*groups_[std::size_t(group)].residuals);
        return {group, group_of_type.add(residual, kernel, ids...)};
    }

    /// A disabled residual costs nothing and pulls at nothing, until enabled again.
    void setEnabled(ResidualId id, bool enabled) { group(id).setEnabled(id.entry, enabled); }
    bool isEnabled(ResidualId id) const { return group(id).enabled(id.entry); }
    /// |r|^2 (whitened, without kernel) at the present values; nothing where the residual is not
    /// defined (a point behind the camera).
    std::optional<double> squaredNorm(ResidualId id) const {
        return group(id).squaredNorm(id.entry, values_);
    }

    // For the solver.
    const detail::Values& values() const { return values_; }
    void setValues(const detail::Values& x) { values_ = x; }
    int numGroups() const { return int(groups_.size()); }
    const detail::ResidualGroup& group(int g) const { return *groups_[std::size_t(g)].residuals; }
    bool isConstant(detail::Kind kind, int index) const {
        return constant_[std::size_t(kind == detail::Kind::Pose    ? 0
                                     : kind == detail::Kind::Point ? 1
                                                                   : 2)][std::size_t(index)];
    }

  private:
    struct Group {
        const void* tag;
        std::unique_ptr<detail::ResidualGroup> residuals;
    };
    static std::vector<bool>::reference at(std::vector<bool>& v, int i) {
        return v[std::size_t(i)];
    }
    detail::ResidualGroup& group(ResidualId id) {
        return *groups_[std::size_t(id.group)].residuals;
    }
    const detail::ResidualGroup& group(ResidualId id) const {
        return *groups_[std::size_t(id.group)].residuals;
    }
    int findGroup(const void* tag) const;
    int addGroup(const void* tag, std::unique_ptr<detail::ResidualGroup> residuals);
    void requireKnown(std::initializer_list<std::pair<detail::Kind, int>> variables,
                      const char* name) const;

    detail::Values values_;
    std::array<std::vector<bool>, 3> constant_;  // of poses, points, vectors
    std::vector<Group> groups_;                  // in order of first use
};

}  // namespace djpete::solver
