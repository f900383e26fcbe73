/// Two corners that may show one point: how well a relative pose explains them, and the best pose.
#pragma once

#include <optional>
#include <vector>

#include "djpete/geometry/se3.h"
#include "djpete/places/place_view.h"
#include "djpete/places/view_match.h"

namespace djpete::places {

/// Indices into PlaceView::corners of a and b.
struct CornerPair {
    uint32_t a = 0, b = 0;
};

/// The two views and how their corners are judged.
struct ViewPair {
    const PlaceView& a;
    const PlaceView& b;
    const MatchOptions& options;
};

/// The difference of a corner and its transfer from the other view.
struct Transfer {
    int rows = 2;                ///< 2: (u, v); 3: (u, v in px, 1/z in 1/m)
    geometry::Vec3 error;        ///< measured minus predicted
    geometry::Mat3 information;  ///< with the noise of both corners; its third row is 0 with 2 rows
    geometry::Mat36 jacobian;    ///< of the prediction by T_a_b's right perturbation
    double chi2() const { return error.dot(information * error); }
};

/// Nothing if neither corner has a point, or if it lies behind the other camera.
std::optional<Transfer> transfer(const ViewPair& views, const CornerPair& pair,
                                 const geometry::SE3& T_a_b);

/// The pairs that T_a_b explains up to options.maxChi2.
std::vector<CornerPair> agreeing(const ViewPair& views, const std::vector<CornerPair>& pairs,
                                 const geometry::SE3& T_a_b);

struct RefinedPose {
    geometry::SE3 T_a_b;
    geometry::Mat6 information = geometry::Mat6::Zero();  ///< right perturbation, of `agreeing`
    std::vector<CornerPair> agreeing;
};
/// Robust Gauss-Newton from T_a_b over all pairs. The kernel begins `widening` times as wide.
RefinedPose refinePose(const ViewPair& views, const std::vector<CornerPair>& pairs,
                       const geometry::SE3& T_a_b, double widening);

}  // namespace djpete::places
