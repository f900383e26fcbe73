/// Sub-pixel alignment of small patches.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "djpete/geometry/types.h"

namespace djpete::frontend {

constexpr int kHalf = 5;  ///< patches reach this far from their centre
constexpr int kSide = 2 * kHalf + 1;
constexpr int kStride = kSide + 1;  ///< of a row in memory: three registers of four

/// Row by row; what stands in the last column of each row is not of the patch.
struct alignas(16) Patch {
    std::array<float, static_cast<std::size_t>(kSide* kStride)> values;
};

/// Where a patch lies in an image and how well it matches there.
struct PatchPlace {
    double u_px = 0, v_px = 0;
    double shear = 0;  ///< columns per row
    double correlation = 0;
    double sigma_px = 0;  ///< of u, from the patches' difference alone
};

/// What is believed of a place before looking, as standard deviations about the start.
struct PlacePrior {
    double row_px = 0;
    double shear = 0;  ///< 0: the shear stays what it was at the start, which must be 0 too
};

/// How far from the start a patch may be found.
struct SearchReach {
    double u_px = 0, v_px = 0;
};

/// A patch and its derivatives by column, row and shear, means removed, with the inverse of the
/// normal matrix of an alignment to it (inverse-compositional: computed once, on the template).
class PatchTemplate {
  public:
    /// The patch about (u, v). Nothing outside the image or without texture.
    static std::optional<PatchTemplate> from(const cv::Mat& grey, double u_px, double v_px,
                                             const PlacePrior& prior);
    /// The same, with 2x2 `stepsPerPixel` of `grey` for one pixel of the patch.
    static std::optional<PatchTemplate> warped(const cv::Mat& grey, double u_px, double v_px,
                                               const geometry::Mat2& stepsPerPixel,
                                               const PlacePrior& prior);

    /// Where the patch lies in `grey`, from `start`. Differences in mean brightness do not matter.
    std::optional<PatchPlace> align(const cv::Mat& grey, const PatchPlace& start,
                                    const SearchReach& reach) const;

  private:
    static constexpr int kWide = kSide + 2;  ///< with a frame of one for derivatives
    static std::optional<PatchTemplate> fromWide(const float* wide, int wideStride,
                                                 const PlacePrior& prior);

    Patch values_;
    std::array<Patch, 3> by_;
    std::array<float, 3> valuesBy_;  ///< products of values_ and by_
    float square_ = 0;               ///< of values_
    bool sheared_ = false;
    geometry::Mat3 prior_;
    geometry::Mat3 inverse_;
};

}  // namespace djpete::frontend
