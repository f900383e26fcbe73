/// Silhouettes of several models in one image, and which mask belongs to which.
#pragma once

#include <optional>
#include <vector>

#include "djpete/evaluation/silhouette.h"
#include "djpete/obs/detection.h"

namespace djpete::evaluation {

/// A z-buffer over renderings of several models from one camera: of each pixel the nearest. Holes
/// and gaps of a rendering are closed first (see closedSilhouette) and lie as deep as the median of
/// its covered pixels.
class SilhouetteBuffer {
  public:
    SilhouetteBuffer(int width_px, int height_px);
    /// Returns the index by which visible() knows it: 0, 1, ... Requires the buffer's size.
    std::size_t add(const texture::RenderedModel& rendered, int closeRadius_px);
    /// What nothing nearer hides.
    MaskImage visible(std::size_t index) const;
    /// Pixels of it before anything hid some.
    std::size_t wholeArea(std::size_t index) const { return wholeArea_[index]; }

  private:
    int width_px_, height_px_;
    std::vector<float> depth_m_;
    std::vector<uint32_t> owner_;  ///< index + 1; 0: none
    std::vector<std::size_t> wholeArea_;
};

/// The smallest box around the mask's pixels, from the first column and row to those after the
/// last. Nothing for an empty mask.
std::optional<obs::ImageBox> boxOf(const MaskImage& mask);

/// The box around the projection of an object's cuboid, also beyond the image; nothing if part of
/// the cuboid is not ahead.
std::optional<obs::ImageBox> projectedBox(const geometry::Vec3& size_m,
                                          const geometry::SE3& T_cam_obj,
                                          const geometry::StereoCamera& camera);
obs::ImageBox partInImage(const obs::ImageBox& box, const geometry::StereoCamera& camera);

/// One to one, so that the sum of the boxes' overlaps (IoU) is greatest; pairs below `minOverlap`
/// are none. Of each silhouette the index of its truth. Shapes inside the boxes have no say.
std::vector<std::optional<std::size_t>> pairByBoxes(const std::vector<obs::ImageBox>& silhouettes,
                                                    const std::vector<obs::ImageBox>& truths,
                                                    double minOverlap);

/// How a silhouette fits its mask.
struct SilhouetteFit {
    double iou = 0;
    double excess = 0;   ///< share of the silhouette that is not mask
    double missing = 0;  ///< share of the mask that is not silhouette
};

/// Pixels of `ignored` (may be empty: none) do not count. Nothing if silhouette or mask has no
/// other pixel. Requires equal sizes.
std::optional<SilhouetteFit> fitSilhouette(const MaskImage& silhouette, const MaskImage& mask,
                                           const MaskImage& ignored);

}  // namespace djpete::evaluation
