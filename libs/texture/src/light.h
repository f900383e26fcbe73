/// How the light of a drive falls on surfaces. Private.
#pragma once

#include <array>
#include <vector>

#include "djpete/texture/object_model.h"

namespace djpete::texture {

/// Brightness of a matt surface by its normal in the world, against the mean over all directions:
/// the exponential of spherical harmonics of first and second order.
struct Light {
    static constexpr int kTerms = 8;
    std::array<double, kTerms> terms{};

    double brightness(const geometry::Vec3& normal_world) const;
    /// Sets ObjectModel::shade of all points.
    void shine(const geometry::Mat3& R_world_obj, ObjectModel& model) const;
};

/// Finds the light from many objects. Most of a car is of one paint, and cars of any paint stand
/// any way round: what goes with the normal over all of them is light, the rest (panes, tyres,
/// gleams) is left out as outliers. A car wholly in a shadow looks like a darker paint; that cannot
/// be told apart.
class LightFit {
  public:
    /// Coloured points of an object; at most 1,500 of them, evenly taken.
    void add(const ObjectModel& model, const geometry::Mat3& R_world_obj);
    /// No light at all (brightness 1 everywhere) from fewer than three objects.
    Light solve() const;

  private:
    struct Sample {
        std::array<double, Light::kTerms> basis{};
        double logBrightness = 0, weight = 1;
    };
    std::vector<std::vector<Sample>> objects_;
};

}  // namespace djpete::texture
