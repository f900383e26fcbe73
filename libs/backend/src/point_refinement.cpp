#include "point_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "djpete/backend/box_from_points.h"

namespace djpete::backend {

namespace {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using Edge = ObjectProblem::Edge;
using Edges = std::vector<const Edge*>;
using Point = obs::ObjectPoints::Point;

constexpr float kVoxel_m = 0.05F;
constexpr float kBeside_m = 0.8F;  // points farther from the object's middle than its half and this
constexpr double kLeastSigma_m = 0.02, kLeastYawSigma_rad = 0.004;
constexpr double kLeastSizeSigma_m = 0.05;
constexpr double kMemory_s = 1.0;    // a smoother's error lasts so long
constexpr double kMedianLoss = 1.6;  // a median's variance against that of a mean

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

/// `n` of the indices of edges that have points, spread evenly.
std::vector<std::size_t> views(const Edges& edges, std::size_t n) {
    std::vector<std::size_t> all, out;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i]->points) all.push_back(i);
    }
    const std::size_t take = std::min(n, all.size());
    for (std::size_t i = 0; i < take; ++i) {
        out.push_back(all[take == 1 ? 0 : i * (all.size() - 1) / (take - 1)]);
    }
    return out;
}

/// Detections that disagree on a size do not know it; those that agree may still all be wrong.
Vec3 sizeSigma(const Edges& edges, const Vec3& size_m) {
    Vec3 sigma;
    for (int k = 0; k < 3; ++k) {
        std::vector<double> off;
        for (const Edge* e : edges) off.push_back(std::abs(e->size_m[k] - size_m[k]));
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

/// What the points alone say: the fit's certainty without the prior's.
Mat6 ofPointsAlone(const BoxFit& fit, const BoxPrior& prior) {
    Mat6 out = Mat6::Zero();
    const auto gain = [](double sigma, double before) {
        return std::max(0.0, 1 / (sigma * sigma) - 1 / (before * before));
    };
    for (int k = 0; k < 3; ++k) out(k, k) = gain(fit.sigma_m[k], prior.sigma_m[k]);
    out(5, 5) = gain(fit.yawSigma_rad, prior.yawSigma_rad);
    return out;
}

/// Where detections, on the whole, have the object against its states. What single views show of a
/// side is alike in all of them, so their many measurements do not make its place surer, whereas
/// detections err each in its own way.
struct Offset {
    SE3 T_state_detected;  ///< a shift
    Mat6 covariance;
};

Offset offsetOfDetections(const Edges& edges, const std::vector<ChainNode>& nodes) {
    Offset offset;
    std::array<std::vector<double>, 3> apart;
    Mat6 information = Mat6::Zero(), covariance = Mat6::Zero();
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Edge& e = *edges[i];
        const Vec3 p = (nodes[i].T_world_obj.inverse() * e.T_world_cam * e.T_cam_obj).translation();
        for (std::size_t k = 0; k < 3; ++k) apart[k].push_back(p[Eigen::Index(k)]);
        information += e.information;
        covariance += nodes[i].covariance / double(edges.size());
    }
    // Headings follow from the way the object goes; an error that all states share is smaller than
    // that of each.
    covariance /= 1 + (edges.back()->time_s - edges.front()->time_s) / kMemory_s;
    for (int k = 0; k < 3; ++k) {
        auto& values = apart[std::size_t(k)];
        const auto middle = values.begin() + static_cast<long>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        offset.T_state_detected.translation()[k] = *middle;
        covariance(k, k) = kMedianLoss / std::max(information(k, k), 1.0);
    }
    offset.covariance = covariance;
    return offset;
}

/// Each view's pose by its own points, near the node's, becomes one more measurement of the node.
void addPoseOfPoints(const Edge& e, const Vec3& size_m, const Vec3& sizeSigma_m, ChainNode& node) {
    if (!e.points) return;
    BoxPoints points;
    add(*e.points, node.T_world_obj.inverse() * e.T_world_cam, size_m, points);
    // The node only says where to look.
    BoxPrior prior = priorOf(4 * node.covariance, size_m, sizeSigma_m);
    prior.sigma_m = prior.sigma_m.cwiseMax(0.15).cwiseMin(0.4);
    prior.yawSigma_rad = std::clamp(prior.yawSigma_rad, 0.03, 0.15);
    const auto fit = fitBox(points, prior);
    if (!fit) return;
    node.measured.push_back(
        {(node.T_world_obj * fit->T_obj_fitted).normalised(), ofPointsAlone(*fit, prior), true});
}

/// One box for the points of all views, fixed to the object.
void fitCommonBox(const Edges& edges, const ObjectOptions& options, std::vector<ChainNode>& nodes,
                  Vec3& size_m) {
    const auto used = views(edges, options.pointViews);
    const Offset offset = offsetOfDetections(edges, nodes);
    BoxPoints points;
    for (const std::size_t i : used) {
        const SE3 T_world_prior = nodes[i].T_world_obj * offset.T_state_detected;
        add(*edges[i]->points, T_world_prior.inverse() * edges[i]->T_world_cam, size_m, points);
    }
    points.body = thinned(points.body);
    points.ground = thinned(points.ground);
    const auto fit = fitBox(points, priorOf(offset.covariance, size_m, sizeSigma(edges, size_m)));
    if (!fit) return;
    size_m = fit->size_m;
    const SE3 T_state_fitted = offset.T_state_detected * fit->T_obj_fitted;
    const Mat6 adjoint = T_state_fitted.inverse().adjoint();
    for (auto& node : nodes) {
        node.T_world_obj = (node.T_world_obj * T_state_fitted).normalised();
        node.twist = adjoint * node.twist;
    }
}

}  // namespace

void refineMoving(const Edges& edges, const ObjectOptions& options, const MotionPrior& motion,
                  const ChainOptions& chain, std::vector<ChainNode>& nodes, Vec3& size_m) {
    if (views(edges, 1).empty()) return;
    const Vec3 sigma = sizeSigma(edges, size_m);
    auto refined = nodes;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        addPoseOfPoints(*edges[i], size_m, sigma, refined[i]);
    }
    if (!smooth(refined, motion, chain).usable) return;
    nodes = std::move(refined);
    fitCommonBox(edges, options, nodes, size_m);
}

void refineStanding(const ObjectProblem::Object& in, const ObjectOptions& options,
                    ObjectUpdate::Object& out) {
    if (out.states.empty()) return;
    Edges edges;
    for (const auto& e : in.edges) edges.push_back(&e);
    const auto used = views(edges, options.pointViews);
    if (used.empty()) return;
    // All states are the same, on one anchor.
    map::ObjectState state = out.states.back();
    const auto anchor = std::find_if(in.edges.begin(), in.edges.end(),
                                     [&](const Edge& e) { return e.anchor == state.anchor; });
    if (anchor == in.edges.end()) return;
    const SE3 T_obj_world = (anchor->T_world_anchor * state.T_anchor_obj).inverse();
    BoxPoints points;
    for (const std::size_t i : used) {
        add(*edges[i]->points, T_obj_world * edges[i]->T_world_cam, out.size_m, points);
    }
    points.body = thinned(points.body);
    points.ground = thinned(points.ground);
    const auto fit =
        fitBox(points, priorOf(state.covariance, out.size_m, sizeSigma(edges, out.size_m)));
    if (!fit) return;
    out.size_m = fit->size_m;
    for (auto& s : out.states) {
        s.T_anchor_obj = (s.T_anchor_obj * fit->T_obj_fitted).normalised();
        setCovariance(*fit, s.covariance);
    }
}

}  // namespace djpete::backend
