#include "ray_marks.h"

#include <cmath>
#include <limits>
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

/// A ray through the grid, cell by cell (Amanatides and Woo, 1987). Lengths are shares of the way
/// from `from` to `to`.
struct Walk {
    Cell cell;
    std::array<int, 3> step{};
    std::array<double, 3> next{}, stride{};

    Walk(const Vec3& from, const Vec3& to) : cell(cellOf(from)) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto k = static_cast<int>(i);
            const double d = to[k] - from[k];
            step[i] = d > 0 ? 1 : -1;
            if (d == 0) {
                next[i] = stride[i] = std::numeric_limits<double>::infinity();
                continue;
            }
            stride[i] = 1 / std::abs(d);
            const double border = d > 0 ? cell[i] + 1 - from[k] : from[k] - cell[i];
            next[i] = border * stride[i];
        }
    }
    /// Goes on to the next cell; returns the share of the way at which it begins.
    double advance() {
        std::size_t i = next[0] < next[1] ? 0 : 1;
        if (next[2] < next[i]) i = 2;
        const double at = next[i];
        cell[i] += step[i];
        next[i] += stride[i];
        return at;
    }
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
    for (auto& c : out.low) --c;  // rounding may end a walk one cell aside
    for (auto& c : out.high) ++c;
    return out;
}

void carve(const Vec3& from, const Vec3& to, double upTo, double groundFrom, BrickGrid& free) {
    Walk walk(from, to);
    const int endLayer = static_cast<int>(std::floor(to.z()));
    for (double at = 0; at < upTo; at = walk.advance()) {
        if (walk.cell[2] == endLayer && at >= groundFrom) continue;
        free.set(walk.cell);
    }
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
    for (std::size_t i = 0; i < record.points.size(); ++i) {
        const Vec3& end = ends->ends[i];
        const auto& point = record.points[i];
        const double range = (end - ends->sensor).norm();
        if (range > 0 && carve_cells > 0) {
            carve(ends->sensor, end, std::min(1.0, carve_cells / range), 1 - options.ground_share,
                  marks.free);
        }
        if (!(point.flags & kHit)) continue;
        const Cell cell = cellOf(end);
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
