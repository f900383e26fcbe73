#include "clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace djpete::observers {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kAzimuthBins = 900;  // 0.4 degrees, two beams of a 10 Hz Velodyne
constexpr float kBodyLow_m = 0.3F;         // what hides a car behind it
constexpr float kBodyHigh_m = 1.5F;
constexpr float kJoinHigh_m = 2.2F;  // higher returns (branches) join nothing
constexpr float kAboveCar_m = 0.7F;  // kept to tell a wall that goes on from a car that ends
constexpr float kSkyHigh_m = 5.0F;
constexpr double kLevelFactor = 1.6;  // each level is this much more tolerant

std::size_t azimuthBin(double azimuth_rad, int shift) {
    const auto n = static_cast<long>(kAzimuthBins);
    const long bin = std::lround(std::floor((azimuth_rad / (2 * kPi) + 0.5) * n)) + shift;
    return static_cast<std::size_t>(((bin % n) + n) % n);
}

/// Disjoint sets; the root of a set is its smallest member.
class UnionFind {
  public:
    explicit UnionFind(std::size_t n) : parent_(n) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }
    uint32_t root(uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<uint32_t> parent_;
};

struct Edge {
    uint32_t a, b;
    float strain;  ///< distance over the tolerance of the tightest level
};

std::vector<Edge> edgesUpTo(const GroundPlan& plan, const GeometricObserverOptions& o,
                            double strainMax) {
    std::vector<Edge> edges;
    const auto& cells = plan.cells();
    for (uint32_t i = 0; i < cells.size(); ++i) {
        const auto& c = cells[i];
        const double tolerance = o.toleranceNear_m + o.tolerancePerRange * std::hypot(c.x, c.y);
        const int reach = static_cast<int>(tolerance * strainMax / o.cell_m);
        for (int dr = 0; dr <= reach; ++dr) {
            for (int dc = dr == 0 ? 1 : -reach; dc <= reach; ++dc) {
                const int32_t j = plan.occupied(c.col + dc, c.row + dr);
                if (j < 0) continue;
                const double strain = o.cell_m * std::hypot(dc, dr) / tolerance;
                if (strain > strainMax) continue;
                edges.push_back({i, static_cast<uint32_t>(j), static_cast<float>(strain)});
            }
        }
    }
    return edges;
}

std::vector<Cluster> components(UnionFind& sets, std::size_t n) {
    std::vector<int32_t> slot(n, -1);
    std::vector<Cluster> out;
    for (uint32_t i = 0; i < n; ++i) {
        const uint32_t root = sets.root(i);
        if (slot[root] < 0) {
            slot[root] = static_cast<int32_t>(out.size());
            out.emplace_back();
        }
        out[static_cast<std::size_t>(slot[root])].push_back(i);
    }
    return out;
}

}  // namespace

GroundPlan::GroundPlan(const obs::LidarScan& scan, const GroundModel& ground,
                       const GeometricObserverOptions& options)
    : cell_m_(static_cast<float>(options.cell_m)),
      reach_m_(static_cast<float>(options.rangeMax_m)),
      side_(static_cast<int>(std::ceil(2 * options.rangeMax_m / options.cell_m)) + 1),
      occupied_(flat(0, side_), -1),
      ground_(flat(0, side_), 0),
      highest_(flat(0, side_), 0.F),
      nearest_(kAzimuthBins, std::numeric_limits<float>::infinity()) {
    const auto clearance = static_cast<float>(options.groundClearance_m);
    std::vector<Obstacle> unsorted;
    for (const auto& p : scan.points) {
        const float range = std::hypot(p.x, p.y);
        if (range < static_cast<float>(options.rangeMin_m) || range >= reach_m_) continue;
        const float height = ground.heightOf(p.x, p.y, p.z);
        if (height > kSkyHigh_m || height < -1.0F) continue;
        const std::size_t at = flat(column(p.x), column(p.y));
        if (height < clearance) {
            if (height < 0.15F) ground_[at] = 1;
            continue;
        }
        highest_[at] = std::max(highest_[at], height);
        if (height > static_cast<float>(options.heightMax_m) + kAboveCar_m) continue;
        unsorted.push_back({p.x, p.y, p.z, height, range});
        if (height > kBodyLow_m && height < kBodyHigh_m) {
            float& nearest = nearest_[azimuthBin(std::atan2(p.y, p.x), 0)];
            nearest = std::min(nearest, range);
        }
    }
    sortIntoCells(unsorted);
}

/// Counting sort by cell, row-major; within a cell in scan order.
void GroundPlan::sortIntoCells(const std::vector<Obstacle>& unsorted) {
    std::vector<uint32_t> count(occupied_.size() + 1, 0);
    std::vector<uint8_t> joins(occupied_.size(), 0);
    for (const auto& o : unsorted) {
        const std::size_t at = flat(column(o.x), column(o.y));
        ++count[at + 1];
        if (o.height < kJoinHigh_m) joins[at] = 1;
    }
    std::partial_sum(count.begin(), count.end(), count.begin());
    for (int row = 0; row < side_; ++row) {
        for (int col = 0; col < side_; ++col) {
            const std::size_t at = flat(col, row);
            if (joins[at] == 0) continue;
            occupied_[at] = static_cast<int32_t>(cells_.size());
            cells_.push_back({col, row, count[at], count[at + 1],
                              (static_cast<float>(col) + 0.5F) * cell_m_ - reach_m_,
                              (static_cast<float>(row) + 0.5F) * cell_m_ - reach_m_});
        }
    }
    obstacles_.resize(unsorted.size());
    for (const auto& o : unsorted) obstacles_[count[flat(column(o.x), column(o.y))]++] = o;
}

int GroundPlan::column(double v) const {
    return static_cast<int>((v + static_cast<double>(reach_m_)) / static_cast<double>(cell_m_));
}

bool GroundPlan::groundSeen(double x, double y) const {
    const int col = column(x), row = column(y);
    return inside(col, row) && ground_[flat(col, row)] != 0;
}

float GroundPlan::highestAt(double x, double y) const {
    const int col = column(x), row = column(y);
    return inside(col, row) ? highest_[flat(col, row)] : 0.F;
}

float GroundPlan::nearestRange(double azimuth_rad, int bins) const {
    return nearest_[azimuthBin(azimuth_rad, bins)];
}

double GroundPlan::binWidth_rad() const { return 2 * kPi / static_cast<double>(kAzimuthBins); }

std::vector<Cluster> clusterCells(const GroundPlan& plan, const GeometricObserverOptions& options) {
    const double strainMax = std::pow(kLevelFactor, options.toleranceLevels - 1);
    const auto edges = edgesUpTo(plan, options, strainMax);
    UnionFind sets(plan.cells().size());
    std::vector<Cluster> out;
    std::vector<std::size_t> sizeBefore(plan.cells().size(), 0);  // of the set that starts here
    for (int level = 0; level < options.toleranceLevels; ++level) {
        const auto limit = static_cast<float>(std::pow(kLevelFactor, level));
        for (const auto& e : edges) {
            if (e.strain <= limit) sets.join(e.a, e.b);
        }
        for (auto& cluster : components(sets, plan.cells().size())) {
            std::size_t& before = sizeBefore[cluster.front()];
            if (before == cluster.size()) continue;
            before = cluster.size();
            out.push_back(std::move(cluster));
        }
    }
    return out;
}

}  // namespace djpete::observers
