#pragma once

namespace djpete::frontend {

/// Geman-McClure's weight of a squared Mahalanobis distance.
inline double robustWeight(double chi2PerDof, double scale) {
    const double c2 = scale * scale;
    const double w = c2 / (c2 + chi2PerDof);
    return w * w;
}

}  // namespace djpete::frontend
