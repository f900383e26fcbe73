/// The colour of one point from all samples of it.
#pragma once

#include <array>
#include <cstddef>

#include "djpete/texture/object_model.h"

namespace djpete::texture {

/// What one view shows of a point, on the common scale of exposures.
struct ColourSample {
    std::array<float, 3> rgb{0, 0, 0};
    float weight = 0;   ///< above 0
    unsigned view = 0;  ///< below ObjectModel::kMaxViews
};

struct PointColour {
    ColourSum sum;        ///< of the samples that agree
    uint32_t seenIn = 0;  ///< bits of their views
};

/// Tukey's biweight mean around the sample of median brightness (weighted; at most
/// ObjectModel::kMaxViews), so that a highlight or a slip onto another surface in a few views does
/// not show. With two samples or less: their weighted mean. Scale: the weighted median of the
/// deviations, at least 6 grey levels. Deterministic in the order of the samples.
PointColour robustColour(const ColourSample* samples, std::size_t count);

}  // namespace djpete::texture
