/// Bilinear samples of small patches, and sums over them. Written with OpenCV's universal
/// intrinsics of four floats, without fused multiply-add, and with sums in a fixed order: their
/// scalar twin (CV_SIMD128 off) gives the same bytes.
#pragma once

#include <opencv2/core.hpp>

#include "djpete/geometry/types.h"
#include "patch_alignment.h"

namespace djpete::frontend {

/// A patch with a frame of one pixel; four registers per row.
struct alignas(16) WidePatch {
    static constexpr int kSide = frontend::kSide + 2;
    static constexpr int kStride = 16;
    std::array<float, static_cast<std::size_t>(kSide* kStride)> values;
};

/// Samples about (x, y), one pixel apart; false if any lies outside the image.
bool sampleUpright(const cv::Mat& grey, double x, double y, Patch& out);
/// The same; each row is moved by `shear` columns more than the one above.
bool sampleSheared(const cv::Mat& grey, double x, double y, double shear, Patch& out);
/// The same with a frame of one.
bool sampleWide(const cv::Mat& grey, double x, double y, WidePatch& out);
/// The same, `step` apart.
bool sampleWarped(const cv::Mat& grey, double x, double y, const geometry::Mat2& step,
                  WidePatch& out);

/// Sum of products; the last column of one of the two must be zero.
float dot(const Patch& a, const Patch& b);

struct PatchSums {
    float sum = 0, square = 0;
};
/// Over all but the last column.
PatchSums sumAndSquare(const Patch& p);

}  // namespace djpete::frontend
