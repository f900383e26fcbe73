/// How large an object is, from many detections and what its class usually measures.
#pragma once

#include <vector>

#include "djpete/obs/detection.h"

namespace djpete::backend {

/// What vehicles of a class measure on the road: mean and standard deviation per dimension, m.
/// Rounded figures of European cars, vans and trucks. Other classes get a wide prior.
struct ClassSize {
    geometry::Vec3 mean_m, sigma_m;
};
ClassSize usualSize(obs::ObjectClass objectClass);

struct SeenSize {
    geometry::Vec3 size_m;
    double sigma = 1;  ///< 1-sigma as a share of each dimension
};

/// Robust weighted mean of ln(size) per dimension, with the class as one more (wider) measurement;
/// `priorWeight` multiplies its information, 0 leaves it out. `seen` must not be empty.
geometry::Vec3 estimateSize(const std::vector<SeenSize>& seen, obs::ObjectClass objectClass,
                            double priorWeight);

}  // namespace djpete::backend
