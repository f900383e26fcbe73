#include "development.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {

namespace {

/// Light of the scene to 0..1 of the tone curve at exposure 1.
constexpr float kNominal = 2.1F;
/// Mean brightness (brightnessOf) at which the exposure is 1: that of an open street in sun.
constexpr double kNominalBrightness = 0.34;
constexpr std::size_t kTones = 4096;

/// Nearly linear: chosen so that sunny and shaded road differ about 4 to 1, as in pictures of
/// KITTI's odometry 00. The curve of its cameras is not documented.
float toneMap(float x) { return 255.F * std::pow(x, 1.F / 1.15F); }

/// Standard normal of the lowest 11 bits; bounded at about 3.5.
float normalOf(uint32_t bits) {
    static const std::vector<float> table = [] {
        constexpr std::size_t kSize = 2048;
        // Quantiles by walking along the integral of the density in small steps.
        std::vector<float> t(kSize);
        double x = -6, area = 0;
        constexpr double kStep = 1e-3;
        for (std::size_t i = 0; i < kSize; ++i) {
            const double wanted = (static_cast<double>(i) + 0.5) / kSize;
            while (area < wanted) {
                const double middle = x + 0.5 * kStep;
                area += kStep * std::exp(-0.5 * middle * middle) / std::sqrt(2 * M_PI);
                x += kStep;
            }
            t[i] = static_cast<float>(x);
        }
        return t;
    }();
    return table[bits & 2047U];
}

float lumaOf(const Vec3f& c) { return 0.299F * c[0] + 0.587F * c[1] + 0.114F * c[2]; }

}  // namespace

double exposureFor(const CameraModel& model, double brightness) {
    const double wanted =
        std::pow(kNominalBrightness / std::max(brightness, 1e-3), model.adaptation);
    return std::clamp(wanted, model.leastExposure, model.mostExposure);
}

Exposure withTotal(const CameraModel& model, double total) {
    Exposure e;
    e.shutter = std::min(total, model.longestShutter);
    e.gain = total / e.shutter;
    return e;
}

double brightnessOf(const std::vector<Vec3f>& colours) {
    double sum = 0;
    for (const auto& c : colours)
        sum += static_cast<double>(std::clamp(kNominal * lumaOf(c), 0.F, 1.F));
    return colours.empty() ? 0 : sum / static_cast<double>(colours.size());
}

Development::Development(const CameraModel& model, const Exposure& exposure,
                         const geometry::StereoCamera& camera, uint32_t noise)
    : camera_(camera),
      noise_(noise),
      exposure_(kNominal * static_cast<float>(exposure.total())),
      chroma_(static_cast<float>(model.chromaNoise)) {
    const double x = std::max(camera.cx, camera.width_px - 1.0 - camera.cx);
    const double y = std::max(camera.cy, camera.height_px - 1.0 - camera.cy);
    vignetting_ = static_cast<float>(model.vignetting / (x * x + y * y));
    tones_.resize(kTones + 2);
    for (std::size_t i = 0; i < tones_.size(); ++i) {
        const double light = static_cast<double>(i) / kTones;
        const double signal =
            std::min(static_cast<double>(toneMap(static_cast<float>(light))) / 255.0, 1.0);
        // Electrons arrive by chance, the amplifier adds its own; gain scales both.
        const double sigma =
            std::sqrt(exposure.gain * model.shotNoise * signal +
                      exposure.gain * exposure.gain * model.readNoise * model.readNoise);
        tones_[i] = {static_cast<float>(255 * signal), static_cast<float>(255 * sigma)};
    }
}

Development::Tone Development::toneOf(float light) const {
    const float x = std::clamp(light, 0.F, 1.F) * static_cast<float>(kTones);
    const auto i = static_cast<std::size_t>(x);
    const float f = x - static_cast<float>(i);
    const Tone &a = tones_[i], &b = tones_[i + 1];
    return {a.value + f * (b.value - a.value), a.sigma};
}

void Development::developRow(int v, const std::vector<Vec3f>& colours, RenderedImage& out) const {
    const auto w = static_cast<std::size_t>(camera_.width_px);
    const std::size_t first = static_cast<std::size_t>(v) * w;
    const float y = static_cast<float>(v) - static_cast<float>(camera_.cy);
    for (std::size_t u = 0; u < w; ++u) {
        const std::size_t at = first + u;
        const float x = static_cast<float>(u) - static_cast<float>(camera_.cx);
        const float light = exposure_ * (1.F - vignetting_ * (x * x + y * y));
        const uint32_t h = hash(noise_, static_cast<uint32_t>(at)), more = hash(h);
        const float common = normalOf(h);
        const std::array<uint32_t, 3> own{h >> 11, more, more >> 11};
        for (std::size_t c = 0; c < 3; ++c) {
            const Tone tone = toneOf(light * colours[at][static_cast<Eigen::Index>(c)]);
            const float value = tone.value + tone.sigma * (common + chroma_ * normalOf(own[c]));
            out.rgb[at][c] = static_cast<uint8_t>(std::clamp(value + 0.5F, 0.F, 255.F));
        }
    }
}

}  // namespace djpete::simulator
