#include "patch_sampling.h"

#include <cmath>
#include <opencv2/core/hal/intrin.hpp>

namespace djpete::frontend {

namespace {

using cv::v_float32x4;

v_float32x4 floats(const uint8_t* p) {
    return cv::v_cvt_f32(cv::v_reinterpret_as_s32(cv::v_load_expand_q(p)));
}

float sumOf(const v_float32x4& v) {
    alignas(16) std::array<float, 4> a;
    cv::v_store_aligned(a.data(), v);
    return (a[0] + a[1]) + (a[2] + a[3]);
}

/// Columns blended between x and x + 1: `registers` times four from `p` on.
template <int registers>
CV_ALWAYS_INLINE void blendColumns(const uint8_t* p, const v_float32x4& left,
                                   const v_float32x4& right, v_float32x4* out) {
    for (int k = 0; k < registers; ++k)
        out[k] = left * floats(p + 4 * k) + right * floats(p + 4 * k + 1);
}

/// rows x (4 * registers) samples from the corner (x, y) on, one pixel apart.
template <int registers>
CV_ALWAYS_INLINE void sampleBlock(const cv::Mat& grey, double x, double y, int rows, float* out,
                                  int stride) {
    const int xi = static_cast<int>(x), yi = static_cast<int>(y);
    const auto fx = static_cast<float>(x - xi), fy = static_cast<float>(y - yi);
    const auto left = cv::v_setall_f32(1 - fx), right = cv::v_setall_f32(fx);
    const auto upper = cv::v_setall_f32(1 - fy), lower = cv::v_setall_f32(fy);
    v_float32x4 above[registers], below[registers];
    blendColumns<registers>(grey.ptr<uint8_t>(yi) + xi, left, right, above);
    for (int r = 0; r < rows; ++r) {
        blendColumns<registers>(grey.ptr<uint8_t>(yi + r + 1) + xi, left, right, below);
        for (int k = 0; k < registers; ++k) {
            cv::v_store_aligned(out + r * stride + 4 * k, upper * above[k] + lower * below[k]);
            above[k] = below[k];
        }
    }
}

/// Samples from the corner (x, y) to (x + wide, y + high), with the pixels that registers and
/// blending read beyond, lie in the image.
bool insideImage(const cv::Mat& grey, double x, double y, int wide, int high) {
    return x >= 0 && y >= 0 && x + wide + 1 < grey.cols && y + high + 1 < grey.rows;
}

}  // namespace

bool sampleUpright(const cv::Mat& grey, double x, double y, Patch& out) {
    if (!insideImage(grey, x - kHalf, y - kHalf, kStride, kSide)) return false;
    sampleBlock<3>(grey, x - kHalf, y - kHalf, kSide, out.values.data(), kStride);
    return true;
}

bool sampleSheared(const cv::Mat& grey, double x, double y, double shear, Patch& out) {
    const double lean = kHalf * std::abs(shear);
    if (!insideImage(grey, x - kHalf - lean, y - kHalf, kStride, kSide) ||
        !insideImage(grey, x - kHalf + lean, y - kHalf, kStride, kSide))
        return false;
    for (int r = 0; r < kSide; ++r) {
        const double xr = x + shear * (r - kHalf) - kHalf;
        sampleBlock<3>(grey, xr, y - kHalf + r, 1, out.values.data() + r * kStride, kStride);
    }
    return true;
}

bool sampleWide(const cv::Mat& grey, double x, double y, WidePatch& out) {
    constexpr int kReach = kHalf + 1;
    if (!insideImage(grey, x - kReach, y - kReach, WidePatch::kStride, WidePatch::kSide))
        return false;
    sampleBlock<4>(grey, x - kReach, y - kReach, WidePatch::kSide, out.values.data(),
                   WidePatch::kStride);
    return true;
}

bool sampleWarped(const cv::Mat& grey, double x, double y, const geometry::Mat2& step,
                  WidePatch& out) {
    constexpr int kReach = kHalf + 1;
    const double reachX = kReach * (std::abs(step(0, 0)) + std::abs(step(0, 1)));
    const double reachY = kReach * (std::abs(step(1, 0)) + std::abs(step(1, 1)));
    if (!(x - reachX >= 0 && x + reachX + 1 < grey.cols && y - reachY >= 0 &&
          y + reachY + 1 < grey.rows))
        return false;
    // Patches are small: floats relative to the corner keep a hundred thousandth of a pixel.
    const int x0 = static_cast<int>(x - reachX), y0 = static_cast<int>(y - reachY);
    const auto sx = static_cast<float>(step(0, 0)), sy = static_cast<float>(step(1, 0));
    for (int r = 0; r < WidePatch::kSide; ++r) {
        const double dr = r - kReach;
        auto xs = static_cast<float>(x - x0 - step(0, 0) * kReach + step(0, 1) * dr);
        auto ys = static_cast<float>(y - y0 - step(1, 0) * kReach + step(1, 1) * dr);
        float* row = out.values.data() + r * WidePatch::kStride;
        for (int c = 0; c < WidePatch::kSide; ++c, xs += sx, ys += sy) {
            const int xi = static_cast<int>(xs), yi = static_cast<int>(ys);
            const float fx = xs - static_cast<float>(xi), fy = ys - static_cast<float>(yi);
            const uint8_t* a = grey.ptr<uint8_t>(y0 + yi) + x0 + xi;
            const uint8_t* b = a + grey.step[0];
            const float top = static_cast<float>(a[0]) + fx * static_cast<float>(a[1] - a[0]);
            const float low = static_cast<float>(b[0]) + fx * static_cast<float>(b[1] - b[0]);
            row[c] = top + fy * (low - top);
        }
    }
    return true;
}

float dot(const Patch& a, const Patch& b) {
    const float *p = a.values.data(), *q = b.values.data();
    v_float32x4 s0 = cv::v_setzero_f32(), s1 = s0, s2 = s0;
    for (int i = 0; i < kSide * kStride; i += kStride) {
        s0 += cv::v_load_aligned(p + i) * cv::v_load_aligned(q + i);
        s1 += cv::v_load_aligned(p + i + 4) * cv::v_load_aligned(q + i + 4);
        s2 += cv::v_load_aligned(p + i + 8) * cv::v_load_aligned(q + i + 8);
    }
    return sumOf((s0 + s1) + s2);
}

PatchSums sumAndSquare(const Patch& p) {
    const v_float32x4 mask(1, 1, 1, 0);
    const float* a = p.values.data();
    v_float32x4 sum = cv::v_setzero_f32(), square = sum;
    for (int i = 0; i < kSide * kStride; i += kStride) {
        const auto v0 = cv::v_load_aligned(a + i), v1 = cv::v_load_aligned(a + i + 4);
        const auto v2 = mask * cv::v_load_aligned(a + i + 8);
        sum += (v0 + v1) + v2;
        square += (v0 * v0 + v1 * v1) + v2 * v2;
    }
    return {sumOf(sum), sumOf(square)};
}

}  // namespace djpete::frontend
