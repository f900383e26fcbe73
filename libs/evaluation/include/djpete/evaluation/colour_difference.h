/// How different two colours look.
#pragma once

#include <array>

namespace djpete::evaluation {

/// CIE L*a*b* under D65, 2 degree observer.
struct Lab {
    double l = 0, a = 0, b = 0;
};

/// Light of a value coded as sRGB, both 0..1 (IEC 61966-2-1).
double linearOfSrgb(double coded);
/// The inverse; values outside 0..1 are clamped.
double srgbOfLinear(double linear);

/// Of red, green, blue light in 0..1 (sRGB's primaries); values outside are clamped.
Lab labOfLinear(const std::array<double, 3>& rgb);
/// Of red, green, blue coded as sRGB in 0..255.
Lab labOfSrgb(const std::array<double, 3>& rgb);

/// CIEDE2000 with kL = kC = kH = 1. About 1 is just noticeable. Formulae: Sharma, Wu, Dalal, "The
/// CIEDE2000 color-difference formula: implementation notes", Color Res. Appl. 30 (2005).
double deltaE2000(const Lab& one, const Lab& other);

}  // namespace djpete::evaluation
