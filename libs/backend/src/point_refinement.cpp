#include "point_refinement.h"

#include <algorithm>
#include <cmath>

#include "djpete/backend/box_from_points.h"

namespace djpete::backend {

namespace {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using Edge = ObjectProblem::Edge;
using Point = obs::ObjectPoints::Point;

constexpr float kVoxel_m = 0.05F;
constexpr float kBeside_m = 0.8F;  // points farther from the object's middle than its half and this
constexpr double kLeastSigma_m = 0.02, kLeastYawSigma_rad = 0.004;
constexpr double kLeastSizeSigma_m = 0.05;

/// The mean of the points in each cube of a grid.
std::vector<Point> thinned(const std::vector<Point>& points) {
    std::vector<std::pair<uint64_t, uint32_t>> keyed;
    keyed.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        uint64_t key = 0;
        for (int k = 0; k < 3; ++k) {
            const auto cell = static_cast<int32_t>(std::floor(points[i][k] / kVoxel_m));
            key = (key << 20U) | (static_cast<uint64_t>(cell + (1 << 19)) & 0xFFFFFU);
        }
        keyed.emplace_back(key, static_cast<uint32_t>(i));
    }
    std::sort(keyed.begin(), keyed.end());
    std::vector<Point> out;
    for (std::size_t i = 0; i < keyed.size();) {
        Point sum = Point::Zero();
        std::size_t j = i;
        for (; j < keyed.size() && keyed[j].first == keyed[i].first; ++j) {
            sum += points[keyed[j].second];
        }
        out.push_back(sum / static_cast<float>(j - i));
        i = j;
    }
    return out;
}

/// `n` of the edges that have points, spread evenly.
std::vector<const Edge*> views(const std::vector<Edge>& edges, std::size_t n) {
    std::vector<const Edge*> all, out;
    for (const auto& e : edges) {
        if (e.points) all.push_back(&e);
    }
    const std::size_t take = std::min(n, all.size());
    for (std::size_t i = 0; i < take; ++i) {
        out.push_back(all[take == 1 ? 0 : i * (all.size() - 1) / (take - 1)]);
    }
    return out;
}

/// Detections that disagree on a size do not know it; those that agree may still all be wrong.
Vec3 sizeSigma(const std::vector<Edge>& edges, const Vec3& size_m) {
    Vec3 sigma;
    for (int k = 0; k < 3; ++k) {
        std::vector<double> off;
        for (const auto& e : edges) off.push_back(std::abs(e.size_m[k] - size_m[k]));
        const auto middle = off.begin() + static_cast<long>(off.size() / 2);
        std::nth_element(off.begin(), middle, off.end());
        sigma[k] = std::hypot(kLeastSizeSigma_m, 1.48 * *middle);
    }
    return sigma;
}

BoxPrior priorOf(const Mat6& covariance, const Vec3& size_m, const Vec3& sizeSigma_m) {
    BoxPrior prior;
    prior.size_m = size_m;
    prior.sizeSigma_m = sizeSigma_m;
    for (int k = 0; k < 3; ++k) {
        prior.sigma_m[k] = std::clamp(std::sqrt(covariance(k, k)), kLeastSigma_m, 1.0);
    }
    prior.yawSigma_rad = std::clamp(std::sqrt(covariance(5, 5)), kLeastYawSigma_rad, 0.3);
    return prior;
}

/// Adds a view's points to `sum`, in obj.
void add(const obs::ObjectPoints& view, const SE3& T_obj_cam, const Vec3& size_m, BoxPoints& sum) {
    const auto in = view.in(T_obj_cam);
    const Point half = (0.5 * size_m).cast<float>();
    const auto near = [&half](const Point& p) {
        return (p.cwiseAbs() - half).maxCoeff() < kBeside_m;
    };
    std::copy_if(in.body.begin(), in.body.end(), std::back_inserter(sum.body), near);
    std::copy_if(in.ground.begin(), in.ground.end(), std::back_inserter(sum.ground), near);
    sum.origins.push_back(in.origin);
}

void setCovariance(const BoxFit& fit, Mat6& covariance) {
    for (const int k : {0, 1, 2, 5}) {
        covariance.row(k).setZero();
        covariance.col(k).setZero();
        const double sigma = k == 5 ? fit.yawSigma_rad : fit.sigma_m[k];
        covariance(k, k) = sigma * sigma;
    }
}

}  // namespace

void refineStanding(const ObjectProblem::Object& in, const ObjectOptions& options,
                    ObjectUpdate::Object& out) {
    if (out.states.empty()) return;
    const auto used = views(in.edges, options.pointViews);
    if (used.empty()) return;
    // All states are the same, on one anchor.
    map::ObjectState state = out.states.back();
    const auto anchor = std::find_if(in.edges.begin(), in.edges.end(),
                                     [&](const Edge& e) { return e.anchor == state.anchor; });
    if (anchor == in.edges.end()) return;
    const SE3 T_world_obj = anchor->T_world_anchor * state.T_anchor_obj;
    BoxPoints points;
    for (const Edge* e : used) {
        add(*e->points, T_world_obj.inverse() * e->T_world_cam, out.size_m, points);
    }
    points.body = thinned(points.body);
    points.ground = thinned(points.ground);
    const auto fit =
        fitBox(points, priorOf(state.covariance, out.size_m, sizeSigma(in.edges, out.size_m)));
    if (!fit) return;
    out.size_m = fit->size_m;
    for (auto& s : out.states) {
        s.T_anchor_obj = (s.T_anchor_obj * fit->T_obj_fitted).normalised();
        setCovariance(*fit, s.covariance);
    }
}

}  // namespace djpete::backend
