#include "daylight.h"

#include <algorithm>
#include <cmath>

namespace djpete::texture {

namespace {

using geometry::Vec3;

constexpr double kLeastContrast = 2;  // of sunny and shady ground; else the sky is overcast
constexpr double kFromBelow = 0.5;    // light from the ground, share of that from the sky
constexpr double kGloss = 0.05;  // of clear coat and glass, at right angles (Fresnel, n = 1.55)
constexpr double kSkyAboveMean = 1.5;  // low sky mirrored at usual angles, to the mean of the sky
constexpr double kMostLocal = 0.35;    // of the logarithm of localScale's sectors

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Two means of `logs`.
std::array<double, 2> twoLevels(std::vector<double> logs) {
    std::sort(logs.begin(), logs.end());
    std::array<double, 2> level{logs[logs.size() / 10], logs[logs.size() * 9 / 10]};
    for (int iteration = 0; iteration < 20; ++iteration) {
        std::array<std::vector<double>, 2> near;
        for (const double x : logs) {
            near[std::abs(x - level[0]) < std::abs(x - level[1]) ? 0 : 1].push_back(x);
        }
        for (std::size_t k = 0; k < 2; ++k) {
            if (!near[k].empty()) level[k] = median(near[k]);
        }
    }
    return level;
}

Light medianLight(const std::vector<GroundRing>& rings, double low, double high) {
    Light out{};
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<double> values;
        for (const GroundRing& ring : rings) {
            for (const auto& light : ring) {
                if (light && meanOf(*light) > low && meanOf(*light) <= high) {
                    values.push_back((*light)[c]);
                }
            }
        }
        // Never 0: albedos are shares of it.
        constexpr double kDarkest = 1e-3;
        out[c] = std::max(kDarkest, values.empty() ? 0 : median(std::move(values)));
    }
    return out;
}

/// How much of the sky is mirrored towards the camera.
double mirroredShare(const Vec3& normal, const Vec3& towards) {
    const double cosine = std::clamp(towards.dot(normal), 0.0, 1.0);
    const double fresnel = kGloss + 0.5 * std::pow(1 - cosine, 5);
    const double up = (2 * cosine * normal - towards).z();
    // Houses and trees stand where the mirrored ray is level; the ground is darker than the sky.
    const double brightness = up < 0 ? 0.25 : 0.35 + 0.65 * std::min(1.0, up / 0.5);
    return fresnel * brightness * kSkyAboveMean;
}

}  // namespace

double Daylight::border() const { return std::sqrt(meanOf(sunny) * meanOf(shady)); }

std::optional<Daylight> groundLevels(const std::vector<GroundRing>& rings) {
    std::vector<double> logs;
    for (const GroundRing& ring : rings) {
        for (const auto& light : ring) {
            if (light) logs.push_back(std::log(std::max(1e-4, meanOf(*light))));
        }
    }
    if (logs.empty()) return std::nullopt;
    const auto level = twoLevels(logs);
    Daylight day;
    constexpr double kAll = 1e9;
    if (level[1] - level[0] < std::log(kLeastContrast)) {
        day.sunny = day.shady = medianLight(rings, -1, kAll);
        return day;
    }
    const double border = std::exp(0.5 * (level[0] + level[1]));
    day.sun = true;
    day.shady = medianLight(rings, -1, border);
    day.sunny = medianLight(rings, border, kAll);
    // Shadow is darker in every channel.
    for (std::size_t c = 0; c < 3; ++c) day.sunny[c] = std::max(day.sunny[c], day.shady[c]);
    return day;
}

Illumination illuminationOf(const Daylight& day, const Vec3& normal, const Vec3& towards) {
    constexpr double kGrazing_cos = 0.1;
    const double up = 0.5 + 0.5 * normal.z();
    const double facing = day.sun ? std::max(0.0, normal.dot(day.sun_world)) : 0;
    const double share = mirroredShare(normal, towards);
    Illumination out;
    out.facesSun = facing > kGrazing_cos;
    for (std::size_t c = 0; c < 3; ++c) {
        const double sky = day.shady[c] / kRoadAlbedo;
        out.inShade[c] = sky * (up + kFromBelow * (1 - up));
        out.inSun[c] = out.inShade[c] + facing / std::max(0.1, day.sun_world.z()) *
                                            (day.sunny[c] - day.shady[c]) / kRoadAlbedo;
        out.mirrored[c] = share * sky;
    }
    return out;
}

double chanceOfSun(const Daylight& day, const GroundRing& ring) {
    constexpr double kTowards_cos = 0.3;
    if (!day.sun) return 0.1;
    const double azimuth = std::atan2(day.sun_world.y(), day.sun_world.x());
    double sunny = 0, seen = 0;
    bool anySunny = false;
    for (std::size_t s = 0; s < kSectors; ++s) {
        if (!ring[s]) continue;
        const bool bright = meanOf(*ring[s]) > day.border();
        anySunny = anySunny || bright;
        const double at = 2 * M_PI * (static_cast<double>(s) + 0.5) / kSectors;
        if (std::cos(at - azimuth) < kTowards_cos) continue;
        sunny += bright ? 1 : 0;
        seen += 1;
    }
    // The far side shows the object's own shadow: only light there says something.
    if (seen == 0) return anySunny ? 0.9 : 0.5;
    return std::clamp(sunny / seen, 0.1, 0.9);
}

double localScale(const Daylight& day, const GroundRing& ring) {
    double sum = 0, count = 1;  // one sector's worth for the drive
    for (const auto& light : ring) {
        if (!light) continue;
        const bool bright = day.sun && meanOf(*light) > day.border();
        const double off = std::log(std::max(1e-4, meanOf(*light)) /
                                    std::max(1e-4, meanOf(bright ? day.sunny : day.shady)));
        if (std::abs(off) > kMostLocal) continue;
        sum += off;
        count += 1;
    }
    return std::exp(sum / count);
}

}  // namespace djpete::texture
