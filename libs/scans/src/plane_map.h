/// The local map: what the last keyframes' points say of planes.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

#include "cells.h"
#include "djpete/geometry/types.h"
#include "djpete/scans/options.h"

namespace djpete::scans {

/// A piece of plane in one cube.
struct Plane {
    geometry::Vec3 mean, normal;
    double variance = 0;  ///< of the points across it
    geometry::Mat3 tilt;  ///< covariance of the normal, for the points' scatter
};

/// Points of keyframes, summed up per cube in the map's frame. Sums are kept per keyframe, so that
/// an old keyframe goes out as a whole.
class PlaneMap {
  public:
    explicit PlaneMap(const ScanOptions& options) : options_(options) {}

    bool empty() const { return keyframes_.empty(); }
    void clear();
    /// `way_m` is how far the vehicle has gone in all; old keyframes go out.
    void add(const std::vector<geometry::Vec3>& points_map, double way_m);
    /// The plane of the cube that holds the point, else the nearest one of the six cubes beside it;
    /// null if there is none.
    const Plane* planeAt(const geometry::Vec3& p_map);

  private:
    /// Sums over points relative to the middle of their cube.
    struct Sums {
        double n = 0;
        geometry::Vec3 sum = geometry::Vec3::Zero();
        std::array<double, 6> squares{};  ///< xx xy xz yy yz zz
        void add(const geometry::Vec3& p);
        void add(const Sums& other, double sign);
    };
    enum class State : uint8_t { Unknown, None, Known };
    struct Cube {
        Sums sums;
        geometry::Vec3 middle = geometry::Vec3::Zero();
        State state = State::Unknown;
        Plane plane;
    };
    struct Spread {
        std::size_t operator()(uint64_t cell) const { return spread(cell); }
    };
    struct Part {
        uint64_t cell;
        Sums sums;
    };
    struct Keyframe {
        double way_m;
        std::vector<Part> parts;
    };

    void removeOldest();
    void fit(Cube& cube) const;
    const Plane* planeOf(uint64_t cell);

    ScanOptions options_;
    std::unordered_map<uint64_t, Cube, Spread> cubes_;  ///< looked up only, never gone through
    std::deque<Keyframe> keyframes_;
};

}  // namespace djpete::scans
