#include "djpete/places/view_match.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "djpete/geometry/point_residuals.h"
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

/// Corners of `from` with a point that lies well inside the image of `to`.
std::size_t expectedIn(const PlaceView& from, const PlaceView& to, const SE3& T_to_from) {
    constexpr double kBorder_px = 20;
    std::size_t count = 0;
    for (const auto& c : from.corners) {
        if (!c.p_cam) continue;
        const geometry::Vec3 p_to = T_to_from * *c.p_cam;
        if (p_to.z() <= geometry::kMinDepth_m) continue;
        count += to.camera.contains(to.camera.project(p_to), kBorder_px) ? 1 : 0;
    }
    return count;
}

double shareSeenAgain(const ViewPair& views, const RefinedPose& pose) {
    const std::size_t expected = std::min(expectedIn(views.a, views.b, pose.T_a_b.inverse()),
                                          expectedIn(views.b, views.a, pose.T_a_b));
    return static_cast<double>(pose.agreeing.size()) /
           static_cast<double>(std::max<std::size_t>(1, expected));
}

/// Refines the pose, looks for pairs within `radius_px` of it, and refines again.
RefinedPose guided(const ViewPair& views, const SE3& T_a_b, double radius_px) {
    return refinePose(views, pairsNear(views, T_a_b, radius_px), T_a_b, 1);
}

/// From a first pose to the answer: refine, look for more pairs near it, refine again.
std::optional<ViewMatch> finish(const ViewPair& views, const std::vector<CornerPair>& pairs,
                                const SE3& T_a_b) {
    constexpr std::size_t kEnoughToGoOn = 8;
    constexpr double kGuided_px = 8;
    RefinedPose pose = refinePose(views, pairs, T_a_b, 3);
    if (pose.agreeing.size() < kEnoughToGoOn) return std::nullopt;
    pose = guided(views, pose.T_a_b, kGuided_px * std::max(1.0, views.options.sigma_px));
    if (pose.agreeing.size() < views.options.minInliers || !wellSpread(views, pose)) {
        return std::nullopt;
    }
    ViewMatch out;
    out.T_a_b = pose.T_a_b;
    out.information = pose.information;
    out.share = shareSeenAgain(views, pose);
    if (out.share < views.options.minShare) return std::nullopt;
    for (const auto& p : pose.agreeing) {
        out.features.emplace_back(views.a.corners[p.a].feature, views.b.corners[p.b].feature);
    }
    return out;
}

}  // namespace

std::optional<ViewMatch> matchViews(const PlaceView& a, const PlaceView& b,
                                    const MatchOptions& options, uint64_t seed) {
    constexpr std::size_t kEnoughToGoOn = 6;
    const ViewPair views{a, b, options};
    const auto pairs = pairsByLooks(views);
    const auto sampled = samplePose(views, pairs, std::nullopt, seed);
    if (!sampled || sampled->support < kEnoughToGoOn) return std::nullopt;
    // What looks alike may repeat along a street, so that too few pairs led here. About the pose,
    // corners compete with their surroundings only: a better pose may show itself.
    const RefinedPose pose = refinePose(views, pairs, sampled->T_a_b, 3);
    return matchViewsNear(a, b, pose.T_a_b, options);
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
