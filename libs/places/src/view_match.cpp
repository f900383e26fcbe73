#include "djpete/places/view_match.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "pair_geometry.h"
#include "pair_search.h"
#include "pose_sampler.h"

namespace djpete::places {

using geometry::Mat6;
using geometry::SE3;

namespace {

/// Cells of an 8 x 4 grid in which corners lie.
std::size_t cellsCovered(const std::vector<CornerPair>& pairs, const PlaceView& view,
                         uint32_t CornerPair::*index) {
    constexpr int kColumns = 8, kRows = 4;
    std::set<int> cells;
    for (const auto& pair : pairs) {
        const geometry::Vec2& px = view.corners[pair.*index].px;
        const int c = static_cast<int>(px.x() * kColumns / std::max(1, view.camera.width_px));
        const int r = static_cast<int>(px.y() * kRows / std::max(1, view.camera.height_px));
        cells.insert(std::clamp(r, 0, kRows - 1) * kColumns + std::clamp(c, 0, kColumns - 1));
    }
    return cells.size();
}

bool wellSpread(const ViewPair& views, const RefinedPose& pose) {
    const auto inA = cellsCovered(pose.agreeing, views.a, &CornerPair::a);
    const auto inB = cellsCovered(pose.agreeing, views.b, &CornerPair::b);
    if (std::min(inA, inB) < views.options.minCells) return false;
    const Eigen::LLT<Mat6> llt(pose.information);
    if (llt.info() != Eigen::Success) return false;
    const Mat6 covariance = llt.solve(Mat6::Identity());
    const auto largest = [&](int first) {
        const geometry::Mat3 block = covariance.block<3, 3>(first, first);
        return std::sqrt(
            Eigen::SelfAdjointEigenSolver<geometry::Mat3>(block, Eigen::EigenvaluesOnly)
                .eigenvalues()
                .maxCoeff());
    };
    // Written so that a NaN is refused.
    return largest(0) <= views.options.maxSigma_m && largest(3) <= views.options.maxSigma_rad;
}

/// From a first pose to the answer: refine, look for more pairs near it, refine again.
std::optional<ViewMatch> finish(const ViewPair& views, const std::vector<CornerPair>& pairs,
                                const SE3& T_a_b) {
    constexpr std::size_t kEnoughToGoOn = 8;
    constexpr double kGuided_px = 8;
    RefinedPose pose = refinePose(views, pairs, T_a_b, 3);
    if (pose.agreeing.size() < kEnoughToGoOn) return std::nullopt;
    const auto more = pairsNear(views, pose.T_a_b, kGuided_px * views.options.sigma_px);
    pose = refinePose(views, more, pose.T_a_b, 1);
    if (pose.agreeing.size() < views.options.minInliers || !wellSpread(views, pose)) {
        return std::nullopt;
    }
    ViewMatch out;
    out.T_a_b = pose.T_a_b;
    out.information = pose.information;
    for (const auto& p : pose.agreeing) {
        out.features.emplace_back(views.a.corners[p.a].feature, views.b.corners[p.b].feature);
    }
    return out;
}

}  // namespace

std::optional<ViewMatch> matchViews(const PlaceView& a, const PlaceView& b,
                                    const MatchOptions& options, uint64_t seed) {
    const ViewPair views{a, b, options};
    const auto pairs = pairsByLooks(views);
    const auto sampled = samplePose(views, pairs, std::nullopt, seed);
    if (!sampled) return std::nullopt;
    return finish(views, pairs, sampled->T_a_b);
}

std::optional<ViewMatch> matchViewsNear(const PlaceView& a, const PlaceView& b, const SE3& T_a_b,
                                        const MatchOptions& options) {
    const ViewPair views{a, b, options};
    const auto pairs = pairsNear(views, T_a_b, options.searchRadius_px);
    // The guess is only good to the search radius: samples find the pose that pairs agree on.
    const auto sampled = samplePose(views, pairs, T_a_b, 0x706C61636573ULL);
    if (!sampled) return std::nullopt;
    return finish(views, pairs, sampled->T_a_b);
}

}  // namespace djpete::places
