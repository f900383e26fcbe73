#include "plane_map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace djpete::scans {

using geometry::Mat3;
using geometry::Vec3;

namespace {

/// A plane is at least this much wider than thick, and not much longer than wide: else its normal
/// may turn about the line on which the points lie.
constexpr double kThinness = 0.1, kRoundness = 0.04;

Vec3 middleOf(const Vec3& p, double size) {
    const auto middle = [&](double x) { return (std::floor(x / size) + 0.5) * size; };
    return {middle(p.x()), middle(p.y()), middle(p.z())};
}

}  // namespace

void PlaneMap::Sums::add(const Vec3& p) {
    n += 1;
    sum += p;
    squares[0] += p.x() * p.x();
    squares[1] += p.x() * p.y();
    squares[2] += p.x() * p.z();
    squares[3] += p.y() * p.y();
    squares[4] += p.y() * p.z();
    squares[5] += p.z() * p.z();
}

void PlaneMap::Sums::add(const Sums& other, double sign) {
    n += sign * other.n;
    sum += sign * other.sum;
    for (std::size_t i = 0; i < squares.size(); ++i) squares[i] += sign * other.squares[i];
}

void PlaneMap::clear() {
    cubes_.clear();
    keyframes_.clear();
}

void PlaneMap::add(const std::vector<Vec3>& points_map, double way_m) {
    std::vector<std::pair<uint64_t, uint32_t>> order;
    order.reserve(points_map.size());
    for (uint32_t i = 0; i < points_map.size(); ++i) {
        order.emplace_back(cellOf(points_map[i], 1 / options_.planeSize_m), i);
    }
    std::sort(order.begin(), order.end());
    Keyframe keyframe{way_m, {}};
    for (std::size_t i = 0; i < order.size();) {
        const uint64_t cell = order[i].first;
        const Vec3 middle = middleOf(points_map[order[i].second], options_.planeSize_m);
        Part part{cell, {}};
        for (; i < order.size() && order[i].first == cell; ++i) {
            part.sums.add(points_map[order[i].second] - middle);
        }
        Cube& cube = cubes_[cell];
        cube.middle = middle;
        cube.sums.add(part.sums, 1);
        cube.state = State::Unknown;
        keyframe.parts.push_back(part);
    }
    keyframes_.push_back(std::move(keyframe));
    while (keyframes_.size() > options_.mapKeyframes ||
           keyframes_.front().way_m < way_m - options_.mapLength_m) {
        removeOldest();
    }
}

void PlaneMap::removeOldest() {
    for (const auto& part : keyframes_.front().parts) {
        const auto it = cubes_.find(part.cell);
        it->second.sums.add(part.sums, -1);
        it->second.state = State::Unknown;
        if (it->second.sums.n < 0.5) cubes_.erase(it);
    }
    keyframes_.pop_front();
}

void PlaneMap::fit(Cube& cube) const {
    cube.state = State::None;
    const auto& s = cube.sums;
    if (s.n < options_.planePoints) return;
    const Vec3 mean = s.sum / s.n;
    Mat3 squares;
    squares << s.squares[0], s.squares[1], s.squares[2], s.squares[1], s.squares[3], s.squares[4],
        s.squares[2], s.squares[4], s.squares[5];
    const Mat3 covariance = squares / s.n - mean * mean.transpose();
    Eigen::SelfAdjointEigenSolver<Mat3> eigen;
    eigen.computeDirect(covariance);
    const Vec3 variances = eigen.eigenvalues();
    if (!variances.allFinite()) return;
    if (variances[0] > options_.planeThickness_m * options_.planeThickness_m) return;
    if (variances[0] > kThinness * variances[1] || variances[1] < kRoundness * variances[2]) return;
    const double across = std::max(variances[0], 0.0);
    const Mat3& e = eigen.eigenvectors();
    const Mat3 tilt = across / s.n *
                      (e.col(1) * e.col(1).transpose() / variances[1] +
                       e.col(2) * e.col(2).transpose() / variances[2]);
    cube.plane = {cube.middle + mean, e.col(0), across, tilt};
    cube.state = State::Known;
}

const Plane* PlaneMap::planeOf(uint64_t cell) {
    const auto it = cubes_.find(cell);
    if (it == cubes_.end()) return nullptr;
    if (it->second.state == State::Unknown) fit(it->second);
    return it->second.state == State::Known ? &it->second.plane : nullptr;
}

const Plane* PlaneMap::planeAt(const Vec3& p_map) {
    if (const Plane* own = planeOf(cellOf(p_map, 1 / options_.planeSize_m))) return own;
    const Plane* best = nullptr;
    // Its points must be this near along the plane too.
    double nearest = options_.planeSize_m;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            Vec3 beside = p_map;
            beside[axis] += side * options_.planeSize_m;
            const Plane* plane = planeOf(cellOf(beside, 1 / options_.planeSize_m));
            if (!plane) continue;
            const double distance = (p_map - plane->mean).norm();
            if (distance < nearest) {
                nearest = distance;
                best = plane;
            }
        }
    }
    return best;
}

}  // namespace djpete::scans
