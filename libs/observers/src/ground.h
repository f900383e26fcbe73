/// The local height of the ground.
#pragma once

#include <optional>
#include <vector>

#include "djpete/obs/sensor_frame.h"

namespace djpete::observers {

/// z_velo of the ground as a plane plus a correction per polar cell.
class GroundModel {
  public:
    /// From the points of a scan in `velo`; nothing if no plane within `slopeMax_deg` of the
    /// `up` direction (unit, in velo) carries enough points.
    static std::optional<GroundModel> fit(const std::vector<obs::ScanPoint>& points,
                                          const geometry::Vec3& up, double slopeMax_deg,
                                          double rangeMin_m, double rangeMax_m);

    /// z over the plane alone.
    float overPlane(float x, float y, float z) const { return z - (a_ * x + b_ * y + c_); }
    /// z over the local ground, metres.
    float heightOf(float x, float y, float z) const {
        return overPlane(x, y, z) - correction(x, y);
    }

    /// z_velo of the ground at (x, y).
    double heightAt(double x, double y) const;
    /// Unit normal of the plane in velo, upwards.
    geometry::Vec3 normal() const;

  private:
    float correction(float x, float y) const;
    void fitCells(const std::vector<obs::ScanPoint>& points, double rangeMin_m, double rangeMax_m);
    void smoothCells();

    float a_ = 0, b_ = 0, c_ = 0;  // z = a x + b y + c
    std::size_t rings_ = 0;
    std::vector<float> cells_;  // [sector * rings_ + ring], metres over the plane
};

}  // namespace djpete::observers
