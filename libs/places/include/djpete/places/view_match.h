/// Do two keyframes show the same place, and where does one stand in the other's camera?
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "djpete/geometry/se3.h"
#include "djpete/places/place_view.h"

namespace djpete::places {

/// Section [place_match].
struct MatchOptions : public mrpt::config::CLoadableOptions {
    /// Corners with at most so many differing bits (of 256) are compared further.
    unsigned maxHamming = 70;
    /// The best corner must have at most this share of the second best's differing bits.
    double maxRatio = 0.85;
    /// Corners must agree within this 1-sigma, in both images: corners found anew stand elsewhere
    /// by part of a pixel, more than a followed corner's own sigma says.
    double sigma_px = 1.0;
    /// Squared whitened error up to which a pair agrees, 2 or 3 dof.
    double maxChi2 = 11.3;
    /// Samples of three pairs at most.
    unsigned maxSamples = 300;
    /// Pairs that must agree. Chosen from true and false pairs as djpete_bench_places shows them.
    unsigned minInliers = 40;
    /// ... and their least share of the corners that the other view should see again: a repeated
    /// house front agrees well, but what stands around it does not.
    double minShare = 0.2;
    /// Around a predicted pixel, in matchViewsNear.
    double searchRadius_px = 40;
    /// A solution must be known at least so well, 1-sigma, or its pairs are badly spread.
    double maxSigma_m = 0.15;
    double maxSigma_rad = 0.0175;  ///< in the INI: max_sigma_deg
    /// Pairs do not err independently: neighbours share the errors of depth and of what is matched.
    /// The information of the pose is divided by this, which at true revisits brings the squared
    /// whitened error near its 6 degrees of freedom.
    double dependence = 4;
    /// The image is cut into 8 x 4 cells; agreeing pairs must lie in so many of them.
    unsigned minCells = 6;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

struct ViewMatch {
    geometry::SE3 T_a_b;         ///< camera b in camera a
    geometry::Mat6 information;  ///< of T_a_b, right perturbation, frame b, order (rho, phi)
    std::vector<std::pair<uint32_t, uint32_t>> features;  ///< (feature of a, of b) that agree
    double share = 0;  ///< of the corners to be seen again that agree; see MatchOptions::minShare
};

/// Descriptor matches checked by geometry: P3P-RANSAC both ways on measured points, then a robust
/// refinement over the reprojections in both images, with a guided search for more pairs. Nothing
/// if fewer than options.minInliers agree, or if the solution is not well spread (degenerate).
std::optional<ViewMatch> matchViews(const PlaceView& a, const PlaceView& b,
                                    const MatchOptions& options, uint64_t seed);

/// The same with a guess of T_a_b (guided search near the predicted pixel; larger yield).
std::optional<ViewMatch> matchViewsNear(const PlaceView& a, const PlaceView& b,
                                        const geometry::SE3& T_a_b, const MatchOptions& options);

}  // namespace djpete::places
