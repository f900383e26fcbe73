#include "paint.h"

#include <algorithm>
#include <cmath>

namespace djpete::texture {

namespace {

constexpr double kSigma = 0.18;          // of the logarithm of light that a paint sends back
constexpr double kBlack = 0.02;          // light; darker differences do not count
constexpr double kDarkestPaint = 0.01;   // of a channel
constexpr double kBlackestPaint = 0.02;  // of its brightest channel
constexpr double kAsGood = 0.97;         // of the best score
// Few cars are brightly coloured; this decides between paints that explain equally much.
constexpr double kAgainstColour = 0.01, kAgainstWhite = 0.97, kWhite = 0.66;

double fit(const LitPoint& point, const Light& albedo, const Light& light) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double expected = std::min(1.0, albedo[c] * light[c] + point.light.mirrored[c]);
        const double off = std::log((expected + kBlack) / (point.seen[c] + kBlack));
        sum += off * off;
    }
    return std::exp(-sum / (3 * 2 * kSigma * kSigma));
}

double brightest(const Light& a) { return *std::max_element(a.begin(), a.end()); }

double prior(const Light& a) {
    const double colour = std::abs(std::log(a[0] / a[1])) + std::abs(std::log(a[2] / a[1]));
    return std::max(0.5, 1 - kAgainstColour * colour) * (brightest(a) > kWhite ? kAgainstWhite : 1);
}

double scoreOf(const std::vector<LitPoint>& points, const Light& albedo, double chanceOfSun) {
    double sum = 0;
    for (const LitPoint& point : points) sum += explained(point, albedo, chanceOfSun);
    return prior(albedo) * sum / static_cast<double>(points.size());
}

Light scaled(const Light& a, double factor) {
    return {factor * a[0], factor * a[1], factor * a[2]};
}

/// What the point's surface would be in this light.
Light albedoOf(const LitPoint& point, const Light& light) {
    Light out{};
    for (std::size_t c = 0; c < 3; ++c) {
        out[c] = std::clamp((point.seen[c] - point.light.mirrored[c]) / light[c], kDarkestPaint,
                            kWhitestPaint);
    }
    return out;
}

}  // namespace

double explained(const LitPoint& point, const Light& albedo, double chanceOfSun) {
    const double inShade = fit(point, albedo, point.light.inShade);
    if (!point.light.facesSun) return inShade;
    const double inSun = fit(point, albedo, point.light.inSun);
    return std::max((1 - chanceOfSun) * inShade, chanceOfSun * inSun) /
           std::max(chanceOfSun, 1 - chanceOfSun);
}

double misfit(const LitPoint& point, const Light& albedo, double shareOfSun, double gleam) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const auto& light = point.light;
        const double arriving = light.inShade[c] + shareOfSun * (light.inSun[c] - light.inShade[c]);
        const double expected =
            std::clamp(albedo[c] * arriving + light.mirrored[c] + gleam, 0.0, 1.0);
        const double off = std::log((expected + kBlack) / (point.seen[c] + kBlack));
        sum += off * off;
    }
    return sum / 3;
}

std::optional<Paint> findPaint(const std::vector<LitPoint>& points, double chanceOfSun,
                               std::size_t candidates) {
    if (points.empty()) return std::nullopt;
    Paint best;
    best.score = -1;
    const auto consider = [&](const Light& albedo) {
        const double score = scoreOf(points, albedo, chanceOfSun);
        if (score > best.score) best = {albedo, score};
    };
    for (std::size_t k = 0; k < candidates; ++k) {
        const LitPoint& point = points[k * points.size() / candidates];
        consider(albedoOf(point, point.light.inShade));
        if (point.light.facesSun) consider(albedoOf(point, point.light.inSun));
    }
    return best;
}

Paint refinedPaint(const std::vector<LitPoint>& points, double chanceOfSun, Paint paint) {
    const auto allowed = [](const Light& a) {
        return brightest(a) <= kWhitestPaint && brightest(a) >= kBlackestPaint &&
               *std::min_element(a.begin(), a.end()) > 0.004;
    };
    for (const double step : {0.2, 0.1, 0.05, 0.025}) {
        for (int round = 0; round < 6; ++round) {
            bool better = false;
            for (std::size_t move = 0; move < 8; ++move) {
                Light next = paint.albedo;
                const double factor = std::exp(move % 2 == 0 ? -step : step);
                if (move < 6) {
                    next[move / 2] *= factor;
                } else {
                    next = scaled(next, factor);
                }
                if (!allowed(next)) continue;
                const double score = scoreOf(points, next, chanceOfSun);
                if (score <= paint.score) continue;
                paint = {next, score};
                better = true;
            }
            if (!better) break;
        }
    }
    constexpr double kStep = 1.04;
    const auto reach = [&](double step) {
        double factor = 1;
        for (int k = 0; k < 20; ++k) {
            const Light next = scaled(paint.albedo, factor * step);
            if (!allowed(next) || scoreOf(points, next, chanceOfSun) < kAsGood * paint.score) break;
            factor *= step;
        }
        return factor;
    };
    paint.albedo = scaled(paint.albedo, std::sqrt(reach(kStep) * reach(1 / kStep)));
    return paint;
}

}  // namespace djpete::texture
