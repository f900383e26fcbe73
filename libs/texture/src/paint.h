/// What colour a car is painted, from points in all kinds of light. Private.
#pragma once

#include <vector>

#include "daylight.h"

namespace djpete::texture {

/// A point as the images show it, and the light it may stand in.
struct LitPoint {
    Illumination light;
    Light seen{0, 0, 0};
};

/// The most light that a paint sends back; white.
constexpr double kWhitestPaint = 0.72;

/// How well a surface of this albedo, in sun or in shade, explains what is seen there, 0..1.
/// Brighter light than the camera can show counts as its brightest.
double explained(const LitPoint& point, const Light& albedo, double chanceOfSun);
/// Mean squared difference of the logarithms of light seen and expected when a share of the
/// sun's light arrives and the surface gleams by `gleam` (linear light) more than it should.
double misfit(const LitPoint& point, const Light& albedo, double shareOfSun, double gleam);

struct Paint {
    Light albedo{0, 0, 0};
    double score = 0;  ///< mean of explained()
};

/// The albedo that explains most points; candidates are those of the points themselves, taken at
/// even steps. Nothing without points.
std::optional<Paint> findPaint(const std::vector<LitPoint>& points, double chanceOfSun,
                               std::size_t candidates);
/// The same, improved step by step. Where images are clipped brighter paints explain as much: then
/// the middle of those that do.
Paint refinedPaint(const std::vector<LitPoint>& points, double chanceOfSun, Paint paint);

}  // namespace djpete::texture
