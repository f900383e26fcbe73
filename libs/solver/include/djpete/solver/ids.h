/// Handles of a Problem: distinct, ordered, valid for the Problem that gave them.
#pragma once

#include <tuple>

namespace djpete::solver {

namespace detail {
/// An index that cannot be mistaken for one of another kind.
template <class Tag>
struct Id {
    int index = -1;
    friend bool operator==(Id a, Id b) { return a.index == b.index; }
    friend bool operator!=(Id a, Id b) { return a.index != b.index; }
    friend bool operator<(Id a, Id b) { return a.index < b.index; }
};
}  // namespace detail

using PoseId = detail::Id<struct PoseTag>;
using PointId = detail::Id<struct PointTag>;
using VectorId = detail::Id<struct VectorTag>;

struct ResidualId {
    int group = -1;  ///< which type of residual
    int entry = -1;  ///< which one of that type
    friend bool operator==(ResidualId a, ResidualId b) {
        return a.group == b.group && a.entry == b.entry;
    }
    friend bool operator<(ResidualId a, ResidualId b) {
        return std::tie(a.group, a.entry) < std::tie(b.group, b.entry);
    }
};

}  // namespace djpete::solver
