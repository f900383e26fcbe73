#include "ray_marks.h"

#include <cmath>
#include <optional>

namespace djpete::background {

namespace {

using geometry::Vec3;

/// In cells, with fractions.
Vec3 inCells(const Vec3& p_world, double resolution_m) {
    return p_world / resolution_m + Vec3::Constant(kMiddleCell);
}

Cell cellOf(const Vec3& cells) {
    return {static_cast<int>(std::floor(cells.x())), static_cast<int>(std::floor(cells.y())),
            static_cast<int>(std::floor(cells.z()))};
}

/// Marks rays in a grid: one cell per step of the longest axis, in whole numbers.
class Carver {
  public:
    /// Rays begin at `sensor`, in cells of the world.
    Carver(BrickGrid& grid, const Vec3& sensor)
        : grid_(grid), tables_(grid.bitTables()), first_(grid.firstCell()), sensor_(sensor) {
        for (std::size_t i = 0; i < 3; ++i) start_[i] = fixed(sensor, i);
    }

    /// Marks the cells from the sensor on, up to the share `upTo` of the way to `end`; those in
    /// the layer of `end` only up to the share `groundFrom`.
    void carve(const Vec3& end, double upTo, double groundFrom) {
        const Vec3 way = end - sensor_;
        const double steps = std::ceil(std::max(1.0, way.cwiseAbs().maxCoeff()));
        std::array<int32_t, 3> at = start_, step{};
        for (std::size_t i = 0; i < 3; ++i) {
            step[i] =
                static_cast<int32_t>(std::lround(way[static_cast<Eigen::Index>(i)] / steps * kOne));
        }
        const int last = static_cast<int>(std::floor(upTo * steps));
        const int ground = std::min(last, static_cast<int>(std::floor(groundFrom * steps)));
        int n = 0;
        for (; n < ground; ++n) {
            mark(at);
            advance(at, step);
        }
        const int endLayer = static_cast<int>(std::floor(end.z())) - first_[2];
        for (; n < last; ++n) {
            if ((at[2] >> kBits) != endLayer) mark(at);
            advance(at, step);
        }
    }

  private:
    static constexpr int kBits = 18;  // of a cell's fraction; a grid has fewer than 2^12 cells
    static constexpr int32_t kOne = 1 << kBits;

    int32_t fixed(const Vec3& cells, std::size_t i) const {
        return static_cast<int32_t>(
            std::floor((cells[static_cast<Eigen::Index>(i)] - first_[i]) * kOne));
    }
    void mark(const std::array<int32_t, 3>& at) {
        const uint32_t bit = tables_[0][static_cast<std::size_t>(at[0] >> kBits)] +
                             tables_[1][static_cast<std::size_t>(at[1] >> kBits)] +
                             tables_[2][static_cast<std::size_t>(at[2] >> kBits)];
        grid_.words()[bit >> 6U] |= uint64_t{1} << (bit & 63U);
    }
    static void advance(std::array<int32_t, 3>& at, const std::array<int32_t, 3>& step) {
        for (std::size_t i = 0; i < 3; ++i) at[i] += step[i];
    }

    BrickGrid& grid_;
    std::array<std::vector<uint32_t>, 3> tables_;
    Cell first_;
    Vec3 sensor_;
    std::array<int32_t, 3> start_{};
};

struct Ends {
    Vec3 sensor{0, 0, 0};  ///< in cells
    std::vector<Vec3> ends;
    Cell low{}, high{};
};

/// Nothing if outside the octree.
std::optional<Ends> endsInCells(const ScanRecord& record, const geometry::SE3& T_world_vehicle,
                                double resolution_m) {
    Ends out;
    out.sensor = inCells(T_world_vehicle * record.sensor_vehicle, resolution_m);
    const geometry::Mat3 turn = T_world_vehicle.rotation() * (kStoredUnit_m / resolution_m);
    out.ends.reserve(record.points.size());
    Vec3 low = out.sensor, high = out.sensor;
    for (const auto& p : record.points) {
        const Vec3 end = out.sensor + turn * Vec3(p.end[0], p.end[1], p.end[2]);
        low = low.cwiseMin(end);
        high = high.cwiseMax(end);
        out.ends.push_back(end);
    }
    if (!(low.minCoeff() >= 4 && high.maxCoeff() < 2 * kMiddleCell - 4)) return std::nullopt;
    out.low = cellOf(low);
    out.high = cellOf(high);
    for (auto& c : out.low) --c;  // rounding may end a ray one cell aside
    for (auto& c : out.high) ++c;
    return out;
}

}  // namespace

KeepOut keepOutOf(const geometry::SE3& T_world_obj, const Vec3& size_m,
                  const OctoOptions& options) {
    const double top = 0.5 * size_m.z() + options.object_margin_m;
    const double bottom = std::min(top, -0.5 * size_m.z() + options.ground_clearance_m);
    const Vec3 lift(0, 0, 0.5 * (top + bottom));
    KeepOut out;
    out.T_world_box = geometry::SE3(T_world_obj.rotation(), T_world_obj * lift);
    out.half_m = Vec3(0.5 * size_m.x() + options.object_margin_m,
                      0.5 * size_m.y() + options.object_margin_m, 0.5 * (top - bottom));
    return out;
}

std::optional<RayMarks> markRays(const ScanRecord& record, const geometry::SE3& T_world_vehicle,
                                 const std::vector<KeepOut>& boxes, const OctoOptions& options) {
    const double resolution_m = options.resolution_m;
    const auto ends = endsInCells(record, T_world_vehicle, resolution_m);
    if (!ends) return std::nullopt;
    RayMarks marks{BrickGrid(ends->low, ends->high), BrickGrid(ends->low, ends->high), {}};
    BrickGrid& hits = marks.hits;
    const double carve_cells = options.carve_distance_m / resolution_m;
    BrickGrid endsSeen(ends->low, ends->high);
    Carver carver(marks.free, ends->sensor);
    for (std::size_t i = 0; i < record.points.size(); ++i) {
        const Vec3& end = ends->ends[i];
        const auto& point = record.points[i];
        const Cell cell = cellOf(end);
        // Rays that end in one cell go through nearly the same cells: one is enough.
        if (carve_cells > 0 && !endsSeen.test(cell)) {
            endsSeen.set(cell);
            const double range = std::max(1.0, (end - ends->sensor).norm());
            carver.carve(end, std::min(1.0, carve_cells / range), 1 - options.ground_share);
        }
        if (!(point.flags & kHit)) continue;
        hits.set(cell);
        if (point.flags & kColoured) marks.colours.push_back({cell, point.rgb});
    }
    // What is hit is not free, whoever it belongs to.
    for (std::size_t w = 0; w < hits.words().size(); ++w) marks.free.words()[w] &= ~hits.words()[w];
    // Hits on an object can lie in a cell whose centre is just outside of its box.
    for (std::size_t i = 0; i < record.points.size() && !boxes.empty(); ++i) {
        const Vec3 p_world = (ends->ends[i] - Vec3::Constant(kMiddleCell)) * resolution_m;
        for (const auto& box : boxes) {
            if (box.contains(p_world)) hits.clear(cellOf(ends->ends[i]));
        }
    }
    for (const auto& box : boxes) {
        forCellsIn(box, resolution_m, [&](const Cell& c) {
            if (!hits.holds(c)) return;
            hits.clear(c);
            marks.free.clear(c);
        });
    }
    const auto gone = [&](const ColouredCell& c) { return !hits.test(c.cell); };
    marks.colours.erase(std::remove_if(marks.colours.begin(), marks.colours.end(), gone),
                        marks.colours.end());
    return marks;
}

}  // namespace djpete::background
