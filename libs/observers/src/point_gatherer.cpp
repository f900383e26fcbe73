#include "djpete/observers/point_gatherer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "djpete/geometry/mrpt_bridge.h"

namespace djpete::observers {

namespace {

using geometry::SE3;
using geometry::Vec3;
using obs::ObjectPoints;
using Points = std::vector<ObjectPoints::Point>;

constexpr float kCell_m = 2.0F;
constexpr std::size_t kSide = 100;                // cells: 100 m to each side of the scanner
constexpr double kGroundRing_m = 1.5;             // ground is looked for so far around the box
constexpr double kBelow_m = 1.2, kAbove_m = 0.8;  // ... and so far from the box's lower side
constexpr double kBin_m = 0.05;
constexpr double kGroundBand_m = 0.1;     // of the level: unevenness, slope
constexpr double kClearance_m = 0.15;     // what is this high over the ground is no ground
constexpr double kVoxel_m = 0.05;         // finest thinning
constexpr std::size_t kDenseEnough = 16;  // times as many points as wanted still show every part

/// The lowest level that holds a fair share of the returns near the ground, in obj; what lies
/// lower is a few stray ones.
std::optional<double> groundLevel(const std::vector<double>& heights, double lowest) {
    constexpr auto kBins = static_cast<std::size_t>((kBelow_m + kAbove_m) / kBin_m);
    std::array<std::size_t, kBins + 1> counts{};
    for (const double z : heights) {
        const auto bin = static_cast<std::size_t>((z - lowest) / kBin_m);
        ++counts[std::min(bin, kBins)];
    }
    const auto pair = [&counts](std::size_t b) { return counts[b] + counts[b + 1]; };
    std::size_t most = 0;
    for (std::size_t b = 0; b + 1 < kBins; ++b) most = std::max(most, pair(b));
    if (most < 5) return std::nullopt;
    for (std::size_t b = 0; b + 1 < kBins; ++b) {
        if (4 * pair(b) < most) continue;
        // The mean of what lies around the top of this rise.
        while (b + 2 < kBins && pair(b + 1) > pair(b)) ++b;
        const double centre = lowest + (static_cast<double>(b) + 1) * kBin_m;
        double sum = 0;
        std::size_t n = 0;
        for (const double z : heights) {
            if (std::abs(z - centre) > kBin_m) continue;
            sum += z;
            ++n;
        }
        return sum / static_cast<double>(n);
    }
    return std::nullopt;
}

/// At most `most` points, one per cube of a grid that is as fine as that allows.
Points thinned(Points points, unsigned most) {
    const std::size_t stride = points.size() / (kDenseEnough * most);
    if (stride > 1) {
        for (std::size_t i = 0; i * stride < points.size(); ++i) points[i] = points[i * stride];
        points.resize((points.size() + stride - 1) / stride);
    }
    struct Keyed {
        uint64_t key;
        uint32_t index;
        bool operator<(const Keyed& o) const {
            return key != o.key ? key < o.key : index < o.index;
        }
    };
    for (double voxel = kVoxel_m; points.size() > most; voxel *= 1.3) {
        std::vector<Keyed> keyed;
        keyed.reserve(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            uint64_t key = 0;
            for (int k = 0; k < 3; ++k) {
                const auto cell =
                    static_cast<int64_t>(std::floor(static_cast<double>(points[i][k]) / voxel));
                key = (key << 20U) | (static_cast<uint64_t>(cell + (1 << 19)) & 0xFFFFFU);
            }
            keyed.push_back({key, static_cast<uint32_t>(i)});
        }
        std::sort(keyed.begin(), keyed.end());
        std::vector<uint32_t> kept;
        for (std::size_t i = 0; i < keyed.size(); ++i) {
            if (i == 0 || keyed[i].key != keyed[i - 1].key) kept.push_back(keyed[i].index);
        }
        std::sort(kept.begin(), kept.end());
        Points out;
        out.reserve(kept.size());
        for (const uint32_t i : kept) out.push_back(points[i]);
        points = std::move(out);
    }
    return points;
}

}  // namespace

std::size_t PointGatherer::cellOf(float x, float y) const {
    const auto clamped = [](float v) {
        const float cell = v / kCell_m + static_cast<float>(kSide / 2);
        return static_cast<std::size_t>(std::clamp(cell, 0.F, static_cast<float>(kSide - 1)));
    };
    return clamped(y) * kSide + clamped(x);
}

PointGatherer::PointGatherer(const obs::LidarScan& scan)
    : scan_(scan), begin_(kSide * kSide + 1, 0), order_(scan.points.size()) {
    std::vector<uint32_t> cells;
    cells.reserve(scan.points.size());
    for (const auto& p : scan.points) {
        cells.push_back(static_cast<uint32_t>(cellOf(p.x, p.y)));
        ++begin_[cells.back() + 1];
    }
    for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
    auto next = begin_;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        order_[next[cells[i]]++] = static_cast<uint32_t>(i);
    }
}

obs::ObjectPointsPtr PointGatherer::gather(const SE3& T_velo_obj, const Vec3& size_m,
                                           const GatherLimits& limits) const {
    const Vec3 half = 0.5 * size_m;
    const double ring = std::max(kGroundRing_m, limits.margin_m);
    const double reach = half.head<2>().norm() + ring;
    const Vec3 centre = T_velo_obj.translation();
    const SE3 T_obj_velo = T_velo_obj.inverse();
    const double lowest = -half.z() - kBelow_m;

    Points near;  // in obj
    std::vector<double> heights;
    const auto lowX = cellOf(float(centre.x() - reach), 0) % kSide,
               highX = cellOf(float(centre.x() + reach), 0) % kSide;
    const auto lowY = cellOf(0, float(centre.y() - reach)) / kSide,
               highY = cellOf(0, float(centre.y() + reach)) / kSide;
    for (auto row = lowY; row <= highY; ++row) {
        const auto first = begin_[row * kSide + lowX], last = begin_[row * kSide + highX + 1];
        for (auto i = first; i < last; ++i) {
            const Vec3 p_obj = T_obj_velo * scan_.points[order_[i]].position();
            const Vec3 outside = p_obj.cwiseAbs() - half;
            if (outside.head<2>().maxCoeff() > ring || outside.z() > kBelow_m) continue;
            near.push_back(p_obj.cast<float>());
            if (p_obj.z() < lowest + kBelow_m + kAbove_m) heights.push_back(p_obj.z());
        }
    }
    const auto ground = groundLevel(heights, lowest);

    ObjectPoints out;
    for (const auto& p : near) {
        const double z = static_cast<double>(p.z());
        if (ground && std::abs(z - *ground) <= kGroundBand_m) {
            out.ground.push_back(p);
            continue;
        }
        const Vec3 outside = p.cast<double>().cwiseAbs() - half;
        const double floor = ground ? *ground + kClearance_m : kClearance_m - half.z();
        if (z >= floor && outside.maxCoeff() <= limits.margin_m) out.body.push_back(p);
    }
    if (out.body.empty()) return nullptr;
    out.body = thinned(std::move(out.body), limits.body);
    out.ground = thinned(std::move(out.ground), limits.ground);
    out.origin = T_obj_velo.translation().cast<float>();
    return std::make_shared<ObjectPoints>(out.in(T_velo_obj));
}

void gatherPoints(obs::CObservationDetectedObjects& objects, const obs::LidarScan& scan,
                  const GatherLimits& limits) {
    const PointGatherer gatherer(scan);
    const SE3 T_velo_sensor =
        scan.T_vehicle_velo.inverse() * geometry::fromCPose3D(objects.sensorPose);
    for (auto& d : objects.detections) {
        if (d.points) continue;
        const SE3 T_velo_obj = T_velo_sensor * d.T_sensor_obj;
        if (!T_velo_obj.matrix().allFinite() || !d.size_m.allFinite() || d.size_m.minCoeff() <= 0 ||
            d.size_m.maxCoeff() > 50) {
            continue;  // the back end says what is wrong with it
        }
        const auto points = gatherer.gather(T_velo_obj, d.size_m, limits);
        if (points) {
            d.points = std::make_shared<obs::ObjectPoints>(points->in(T_velo_sensor.inverse()));
        }
    }
}

}  // namespace djpete::observers
