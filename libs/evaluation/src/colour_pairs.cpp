#include <algorithm>
#include <cmath>

#include "djpete/evaluation/colour_difference.h"
#include "djpete/evaluation/texture_errors.h"

namespace djpete::evaluation {

namespace {

constexpr std::size_t kFitSamples = 20000;

double meanError(const std::vector<ColourPair>& pairs, const std::vector<Lab>& albedo,
                 std::size_t step, double gain) {
    double sum = 0;
    std::size_t n = 0;
    for (std::size_t i = 0; i < pairs.size(); i += step, ++n) {
        const auto& e = pairs[i].estimate;
        sum += deltaE2000(labOfLinear({gain * e[0], gain * e[1], gain * e[2]}), albedo[n]);
    }
    return sum / static_cast<double>(n);
}

}  // namespace

std::array<double, 3> lightOfCamera(const std::array<double, 3>& rgb) {
    std::array<double, 3> out{};
    for (std::size_t c = 0; c < 3; ++c) {
        out[c] = std::pow(std::clamp(rgb[c] / 255, 0.0, 1.0), kCameraGamma);
    }
    return out;
}

std::array<double, 3> lightOfAlbedo(const std::array<uint8_t, 3>& srgb) {
    return {linearOfSrgb(srgb[0] / 255.0), linearOfSrgb(srgb[1] / 255.0),
            linearOfSrgb(srgb[2] / 255.0)};
}

void markSunny(std::vector<ColourPair>& pairs, const geometry::Vec3& sun_obj) {
    constexpr double kGrazing_cos = 0.1;
    for (auto& p : pairs) {
        const geometry::Vec3 n(p.normal_obj[0], p.normal_obj[1], p.normal_obj[2]);
        p.sunny = n.dot(sun_obj) > kGrazing_cos;
    }
}

std::vector<double> colourErrors(const std::vector<ColourPair>& pairs, double gain) {
    std::vector<double> out;
    out.reserve(pairs.size());
    for (const auto& p : pairs) {
        const auto& e = p.estimate;
        out.push_back(deltaE2000(labOfLinear({gain * e[0], gain * e[1], gain * e[2]}),
                                 labOfLinear(p.albedo)));
    }
    return out;
}

double fitGain(const std::vector<ColourPair>& pairs) {
    if (pairs.empty()) return 1;
    const std::size_t step = std::max<std::size_t>(1, pairs.size() / kFitSamples);
    std::vector<Lab> albedo;
    for (std::size_t i = 0; i < pairs.size(); i += step) {
        albedo.push_back(labOfLinear(pairs[i].albedo));
    }
    // Steps of powers of two, halved around the best: the mean has one valley but for small dents.
    double best = 0, width = 0.5, bestError = meanError(pairs, albedo, step, 1);
    for (int i = -8; i <= 8; ++i) {
        const double error = meanError(pairs, albedo, step, std::exp2(width * i));
        if (error < bestError) best = width * i, bestError = error;
    }
    for (width /= 2; width > 0.004; width /= 2) {
        for (const double x : {best - width, best + width}) {
            const double error = meanError(pairs, albedo, step, std::exp2(x));
            if (error < bestError) best = x, bestError = error;
        }
    }
    return std::exp2(std::clamp(best, -4.0, 4.0));
}

}  // namespace djpete::evaluation
