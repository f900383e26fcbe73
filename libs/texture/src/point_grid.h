/// Which points of a model are near a place.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "djpete/texture/object_model.h"

namespace djpete::texture {

/// Points sorted by cells; answers come in an order that depends on the points only. Holds copies
/// of the positions: later changes of the model do not show.
class PointGrid {
  public:
    using Use = std::function<bool(uint32_t)>;

    /// Of all points, or of those for which `use` is true. Queries of about `cell_m` are fastest.
    PointGrid(const ObjectModel& model, double cell_m, const Use& use = {});

    /// Calls visit(index, squared distance) for all points within `radius_m` of p_obj.
    template <class Visit>
    void forWithin(const geometry::Vec3& p_obj, double radius_m, Visit&& visit) const;
    /// The nearest point within `radius_m`; the lowest index if several are.
    std::optional<uint32_t> nearest(const geometry::Vec3& p_obj, double radius_m) const;

  private:
    struct Entry {
        uint64_t key = 0;
        uint32_t index = 0;
        geometry::Vec3 p_obj;
    };
    int64_t cellOf(double coordinate_m) const;
    static uint64_t keyOf(int64_t x, int64_t y, int64_t z);
    std::vector<Entry>::const_iterator firstFrom(uint64_t key) const;

    double cell_m_;
    std::vector<Entry> entries_;
};

template <class Visit>
void PointGrid::forWithin(const geometry::Vec3& p_obj, double radius_m, Visit&& visit) const {
    if (!p_obj.allFinite()) return;
    int64_t low[3], high[3];
    for (int i = 0; i < 3; ++i) {
        low[i] = cellOf(p_obj[i] - radius_m);
        high[i] = cellOf(p_obj[i] + radius_m);
    }
    const double radius2 = radius_m * radius_m;
    for (int64_t x = low[0]; x <= high[0]; ++x) {
        for (int64_t y = low[1]; y <= high[1]; ++y) {
            const uint64_t last = keyOf(x, y, high[2]);
            for (auto e = firstFrom(keyOf(x, y, low[2])); e != entries_.end() && e->key <= last;
                 ++e) {
                const double d2 = (e->p_obj - p_obj).squaredNorm();
                if (d2 <= radius2) visit(e->index, d2);
            }
        }
    }
}

}  // namespace djpete::texture
