/// Sub-pixel alignment of small patches.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "djpete/geometry/types.h"

namespace djpete::frontend {

constexpr int kHalf = 5;  ///< patches reach this far from their centre
constexpr std::size_t kSide = 2 * kHalf + 1;
constexpr std::size_t kArea = kSide * kSide;

/// Row by row; the padding beyond kArea stays zero, so that sums may run over whole registers.
using Patch = Eigen::Matrix<float, 128, 1>;

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
    double shear = 0;
};

/// A patch and its derivatives by column, row and shear, means removed, with the inverse of the
/// normal matrix of an alignment to it (inverse-compositional: computed once, on the template).
class PatchTemplate {
  public:
    /// The patch about (u, v), 2x2 `stepsPerPixel` of `from` for one pixel of the patch. Nothing
    /// outside the image or without texture.
    static std::optional<PatchTemplate> from(const cv::Mat& grey, double u_px, double v_px,
                                             const geometry::Mat2& stepsPerPixel,
                                             const PlacePrior& prior);

    /// Where the patch lies in `grey`, from `start`; at most `maxShift_px` away in u, 1.5 in v.
    /// Differences in mean brightness do not matter.
    std::optional<PatchPlace> align(const cv::Mat& grey, const PatchPlace& start,
                                    double maxShift_px) const;

  private:
    Patch values_;
    std::array<Patch, 3> by_;
    geometry::Mat3 prior_;
    geometry::Mat3 inverse_;
};

}  // namespace djpete::frontend
