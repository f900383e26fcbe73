#include "djpete/evaluation/colour_difference.h"

#include <algorithm>
#include <cmath>

namespace djpete::evaluation {

namespace {

constexpr double kDegrees = M_PI / 180;

/// The cube root of CIE L*a*b*, straight near zero.
double labCurve(double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
}

/// Hue angle in degrees, [0, 360); 0 for greys.
double hueOf(double a, double b) {
    if (a == 0 && b == 0) return 0;
    const double h = std::atan2(b, a) / kDegrees;
    return h < 0 ? h + 360 : h;
}

double seventh(double c) { return std::pow(c, 7) / (std::pow(c, 7) + std::pow(25.0, 7)); }

/// Difference of two hues, (-180, 180]; 0 if either colour is grey.
double hueDifference(double h1, double h2, bool grey) {
    if (grey) return 0;
    const double d = h2 - h1;
    return d > 180 ? d - 360 : (d < -180 ? d + 360 : d);
}

double meanHue(double h1, double h2, bool grey) {
    if (grey) return h1 + h2;
    if (std::abs(h1 - h2) <= 180) return (h1 + h2) / 2;
    return h1 + h2 < 360 ? (h1 + h2 + 360) / 2 : (h1 + h2 - 360) / 2;
}

}  // namespace

double linearOfSrgb(double coded) {
    return coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
}

double srgbOfLinear(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

Lab labOfLinear(const std::array<double, 3>& rgb) {
    const double r = std::clamp(rgb[0], 0.0, 1.0), g = std::clamp(rgb[1], 0.0, 1.0),
                 b = std::clamp(rgb[2], 0.0, 1.0);
    // IEC 61966-2-1; divided by the white of D65, so that equal light is exactly grey.
    const double x = (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505;
    const double y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    const double z = (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.0890;
    const double fx = labCurve(x), fy = labCurve(y), fz = labCurve(z);
    return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}

Lab labOfSrgb(const std::array<double, 3>& rgb) {
    return labOfLinear(
        {linearOfSrgb(rgb[0] / 255), linearOfSrgb(rgb[1] / 255), linearOfSrgb(rgb[2] / 255)});
}

double deltaE2000(const Lab& one, const Lab& other) {
    const double meanChroma = (std::hypot(one.a, one.b) + std::hypot(other.a, other.b)) / 2;
    const double g = 0.5 * (1 - std::sqrt(seventh(meanChroma)));
    const double a1 = (1 + g) * one.a, a2 = (1 + g) * other.a;
    const double c1 = std::hypot(a1, one.b), c2 = std::hypot(a2, other.b);
    const double h1 = hueOf(a1, one.b), h2 = hueOf(a2, other.b);
    const bool grey = c1 * c2 == 0;
    const double dL = other.l - one.l, dC = c2 - c1;
    const double dH = 2 * std::sqrt(c1 * c2) * std::sin(hueDifference(h1, h2, grey) / 2 * kDegrees);

    const double l = (one.l + other.l) / 2, c = (c1 + c2) / 2, h = meanHue(h1, h2, grey);
    const double t = 1 - 0.17 * std::cos((h - 30) * kDegrees) + 0.24 * std::cos(2 * h * kDegrees) +
                     0.32 * std::cos((3 * h + 6) * kDegrees) -
                     0.20 * std::cos((4 * h - 63) * kDegrees);
    const double fifty = (l - 50) * (l - 50);
    const double sl = 1 + 0.015 * fifty / std::sqrt(20 + fifty);
    const double sc = 1 + 0.045 * c, sh = 1 + 0.015 * c * t;
    const double turn = 30 * std::exp(-std::pow((h - 275) / 25, 2));
    const double rt = -std::sin(2 * turn * kDegrees) * 2 * std::sqrt(seventh(c));
    const double x = dL / sl, y = dC / sc, z = dH / sh;
    return std::sqrt(x * x + y * y + z * z + rt * y * z);
}

}  // namespace djpete::evaluation
