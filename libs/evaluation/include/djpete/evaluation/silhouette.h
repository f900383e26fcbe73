/// A rendered model against an image it was not made from.
#pragma once

#include <optional>

#include "djpete/evaluation/image_files.h"
#include "djpete/texture/render_model.h"

namespace djpete::evaluation {

/// How alike image and rendering are inside the silhouette.
struct ImageMatch {
    std::size_t pixels = 0;
    double psnr_dB = 0;      ///< after a * rendering + b, one a and b for all three channels
    double flatPsnr_dB = 0;  ///< of the best even grey instead: how hard the image is
};

/// Over pixels that are in the mask and covered by the rendering. Nothing with fewer than 50 of
/// them. Best possible values are cut at 60 dB. Requires equal sizes.
std::optional<ImageMatch> matchImages(const texture::RenderedModel& rendered, const RgbImage& image,
                                      const MaskImage& mask);

/// Covered pixels, with holes and gaps up to 2 * radius_px wide closed (dilated, then eroded, by a
/// square).
MaskImage closedSilhouette(const texture::RenderedModel& rendered, int radius_px);

/// Intersection over union; pixels of `ignore` (may be empty: none) do not count. Nothing if both
/// are empty. Requires equal sizes.
std::optional<double> silhouetteIou(const MaskImage& silhouette, const MaskImage& mask,
                                    const MaskImage& ignore);

}  // namespace djpete::evaluation
