#include "pose_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "djpete/geometry/point_residuals.h"
#include "djpete/obs/mixing.h"

namespace djpete::places {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

namespace {

/// A point of one view and where the other view sees it.
struct Sight {
    Vec3 p_from;
    Vec2 px_to;
};

struct Direction {
    std::vector<Sight> sights;
    geometry::StereoCamera camera;  // of the view that sees
};

/// Squared distance of a sight from its projection, at most `limit2`.
double cost(const Direction& d, const SE3& T_to_from, double limit2, std::size_t& support) {
    double sum = 0;
    for (const auto& s : d.sights) {
        const Vec3 p = T_to_from * s.p_from;
        double e2 = limit2;
        if (p.z() > geometry::kMinDepth_m) {
            e2 = std::min(limit2, (d.camera.project(p) - s.px_to).squaredNorm());
        }
        if (e2 < limit2) ++support;
        sum += e2;
    }
    return sum;
}

/// Poses T_to_from that see three points where they are.
std::vector<SE3> posesFromThree(const Direction& d, const std::array<std::size_t, 3>& sample) {
    std::array<cv::Point3d, 3> points;
    std::array<cv::Point2d, 3> rays;
    for (std::size_t k = 0; k < 3; ++k) {
        const Sight& s = d.sights[sample[k]];
        const Vec3 r = d.camera.ray(s.px_to);
        points[k] = {s.p_from.x(), s.p_from.y(), s.p_from.z()};
        rays[k] = {r.x(), r.y()};
    }
    std::vector<cv::Mat> rvecs, tvecs;
    cv::solveP3P(cv::Mat(3, 3, CV_64F, points.data()), cv::Mat(3, 2, CV_64F, rays.data()),
                 cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rvecs, tvecs, cv::SOLVEPNP_AP3P);
    std::vector<SE3> out;
    for (std::size_t i = 0; i < rvecs.size(); ++i) {
        const Vec3 phi(rvecs[i].at<double>(0), rvecs[i].at<double>(1), rvecs[i].at<double>(2));
        const Vec3 t(tvecs[i].at<double>(0), tvecs[i].at<double>(1), tvecs[i].at<double>(2));
        if (phi.allFinite() && t.allFinite()) out.emplace_back(geometry::so3Exp(phi), t);
    }
    return out;
}

/// Samples after which three good pairs were drawn once, with 99.9 %.
double samplesNeeded(double goodShare) {
    const double allGood = goodShare * goodShare * goodShare;
    return allGood >= 1 ? 1 : std::log(0.001) / std::log(1 - allGood);
}

}  // namespace

std::optional<SampledPose> samplePose(const ViewPair& views, const std::vector<CornerPair>& pairs,
                                      const std::optional<SE3>& guess_T_a_b, uint64_t seed) {
    constexpr double kWide_px = 4;  // corners' and depths' own noise is not weighed here
    Direction aToB{{}, views.b.camera}, bToA{{}, views.a.camera};
    for (const auto& pair : pairs) {
        const auto& a = views.a.corners[pair.a];
        const auto& b = views.b.corners[pair.b];
        if (a.p_cam) aToB.sights.push_back({*a.p_cam, b.px});
        if (b.p_cam) bToA.sights.push_back({*b.p_cam, a.px});
    }
    const double limit_px = kWide_px * std::max(1.0, views.options.sigma_px);
    const double limit2 = limit_px * limit_px;
    const std::size_t all = aToB.sights.size() + bToA.sights.size();
    std::optional<SampledPose> best;
    double bestCost = 0;
    const auto offer = [&](const SE3& T_a_b) {
        SampledPose s{T_a_b, 0};
        const double c =
            cost(aToB, T_a_b.inverse(), limit2, s.support) + cost(bToA, T_a_b, limit2, s.support);
        if (!best || c < bestCost) {
            best = s;
            bestCost = c;
        }
    };
    if (guess_T_a_b && all > 0) offer(*guess_T_a_b);
    uint64_t state = seed;
    for (unsigned i = 0; i < views.options.maxSamples; ++i) {
        const bool forward = i % 2 == 0 ? aToB.sights.size() >= 4 : bToA.sights.size() < 4;
        const Direction& d = forward ? aToB : bToA;
        const std::size_t n = d.sights.size();
        if (n < 4) return std::nullopt;
        const std::array<std::size_t, 3> sample{
            obs::nextRandom(state) % n, obs::nextRandom(state) % n, obs::nextRandom(state) % n};
        if (sample[0] == sample[1] || sample[1] == sample[2] || sample[0] == sample[2]) continue;
        for (const SE3& T : posesFromThree(d, sample)) offer(forward ? T.inverse() : T);
        if (best &&
            i >= samplesNeeded(static_cast<double>(best->support) / static_cast<double>(all))) {
            break;
        }
    }
    return best;
}

}  // namespace djpete::places
