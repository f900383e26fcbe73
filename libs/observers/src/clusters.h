/// What stands on the ground, gathered into clusters at several tolerances.
#pragma once

#include <cstdint>
#include <vector>

#include "djpete/observers/geometric_observer.h"
#include "ground.h"

namespace djpete::observers {

/// A return that is not ground, in `velo`, metres.
struct Obstacle {
    float x, y, z;
    float height;  ///< over the local ground
    float range;   ///< from the sensor, in the x-y plane
};

/// The scan seen from above in square cells, and its silhouette seen from the sensor.
class GroundPlan {
  public:
    GroundPlan(const obs::LidarScan& scan, const GroundModel& ground,
               const GeometricObserverOptions& options);

    /// Returns between the clearance and the height of a van; those of one cell are neighbours.
    const std::vector<Obstacle>& obstacles() const { return obstacles_; }
    /// Index ranges of obstacles() per occupied cell, in row-major order.
    struct Cell {
        int col, row;
        uint32_t first, last;  ///< obstacles [first, last)
        float x, y;            ///< centre, velo
    };
    const std::vector<Cell>& cells() const { return cells_; }
    /// Index of the occupied cell at (col, row), or -1.
    int32_t occupied(int col, int row) const {
        return inside(col, row) ? occupied_[flat(col, row)] : -1;
    }
    /// True if a ground return fell in the cell at (x, y).
    bool groundSeen(double x, double y) const;
    /// Highest return at (x, y) over the ground, up to 5 m; 0 if none.
    float highestAt(double x, double y) const;
    /// Range of the nearest obstacle of a car's body height in the azimuth bin of `azimuth_rad`
    /// moved by `bins`; infinite if there is none.
    float nearestRange(double azimuth_rad, int bins) const;
    double binWidth_rad() const;

  private:
    bool inside(int col, int row) const {
        return col >= 0 && row >= 0 && col < side_ && row < side_;
    }
    std::size_t flat(int col, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(side_) +
               static_cast<std::size_t>(col);
    }
    int column(double v) const;
    void sortIntoCells(const std::vector<Obstacle>& unsorted);

    float cell_m_, reach_m_;
    int side_;
    std::vector<Obstacle> obstacles_;
    std::vector<Cell> cells_;
    std::vector<int32_t> occupied_;
    std::vector<uint8_t> ground_;
    std::vector<float> highest_;
    std::vector<float> nearest_;
};

/// Indices into GroundPlan::cells(), ascending.
using Cluster = std::vector<uint32_t>;

/// Connected components of the occupied cells at each tolerance, tightest level first; a component
/// that is the same at the next level is listed once.
std::vector<Cluster> clusterCells(const GroundPlan& plan, const GeometricObserverOptions& options);

}  // namespace djpete::observers
