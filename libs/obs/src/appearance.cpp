#include "djpete/obs/appearance.h"

#include <cmath>
#include <cstddef>

namespace djpete::obs {

namespace {

constexpr std::size_t kGroup = 8;
constexpr double kWeights[] = {1, 1, 0.5};

}  // namespace

double appearanceDistance(const Appearance& a, const Appearance& b) {
    double sum = 0, weights = 0;
    for (std::size_t g = 0; g < 3; ++g) {
        double common = 0, sumA = 0, sumB = 0;
        for (std::size_t i = g * kGroup; i < (g + 1) * kGroup; ++i) {
            common += std::sqrt(double(a[i]) * double(b[i]));
            sumA += double(a[i]);
            sumB += double(b[i]);
        }
        if (sumA <= 0 || sumB <= 0) continue;
        const double hellinger = std::sqrt(std::fmax(0, 1 - common / std::sqrt(sumA * sumB)));
        sum += kWeights[g] * hellinger;
        weights += kWeights[g];
    }
    return weights > 0 ? sum / weights : 0;
}

}  // namespace djpete::obs
