#include "descriptor.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "djpete/obs/mixing.h"

namespace djpete::frontend {

namespace {

constexpr int kReach = 15;           // the farthest a comparison looks, per axis
constexpr double kSmoothing_px = 2;  // of the image, 1-sigma
constexpr std::size_t kBits = 256;

struct Comparison {
    std::array<int, 2> x{}, y{};  // of the two places, from the corner
};

/// A sum of three uniform numbers of -5..5: bell-shaped, 1-sigma 5.5, never beyond kReach.
int offset(uint64_t number) {
    const uint64_t h = obs::mixed(number);
    return static_cast<int>(h % 11 + (h >> 20) % 11 + (h >> 40) % 11) - kReach;
}

/// The law of the descriptor: descriptors of other comparisons cannot be compared.
std::array<Comparison, kBits> comparisons() {
    constexpr int kApart2 = 16;  // nearer places mostly compare noise
    std::array<Comparison, kBits> out;
    uint64_t number = 0;
    for (auto& c : out) {
        int dx = 0, dy = 0;
        do {
            for (std::size_t k = 0; k < 2; ++k) {
                c.x[k] = offset(number++);
                c.y[k] = offset(number++);
            }
            dx = c.x[1] - c.x[0];
            dy = c.y[1] - c.y[0];
        } while (dx * dx + dy * dy < kApart2);
    }
    return out;
}

/// The smoothed image with its border repeated, so that every corner can be described. Smoothing
/// of 8 bit images is exact in integers, the same with any instruction set.
cv::Mat smoothed(const cv::Mat& grey) {
    cv::Mat soft, out;
    cv::GaussianBlur(grey, soft, {9, 9}, kSmoothing_px, kSmoothing_px, cv::BORDER_REPLICATE);
    cv::copyMakeBorder(soft, out, kReach, kReach, kReach, kReach, cv::BORDER_REPLICATE);
    return out;
}

}  // namespace

void describe(const cv::Mat& grey, std::vector<obs::KeyframeFeature>& features) {
    if (features.empty()) return;
    static const std::array<Comparison, kBits> kComparisons = comparisons();
    const cv::Mat image = smoothed(grey);
    const auto stride = static_cast<std::ptrdiff_t>(image.step);
    std::array<std::array<std::ptrdiff_t, 2>, kBits> places;
    for (std::size_t i = 0; i < kBits; ++i) {
        for (std::size_t k = 0; k < 2; ++k) {
            places[i][k] = kComparisons[i].y[k] * stride + kComparisons[i].x[k];
        }
    }
    for (auto& f : features) {
        const auto x = static_cast<int>(std::lround(f.u_px)),
                   y = static_cast<int>(std::lround(f.v_px));
        const uint8_t* centre = image.ptr<uint8_t>(y + kReach) + x + kReach;
        obs::Descriptor d{};
        for (std::size_t i = 0; i < kBits; ++i) {
            const uint64_t bit = centre[places[i][0]] < centre[places[i][1]] ? 1 : 0;
            d[i / 64] |= bit << (i % 64);
        }
        f.descriptor = d;
    }
}

}  // namespace djpete::frontend
