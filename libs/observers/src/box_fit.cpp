#include "box_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace djpete::observers {

namespace {

using geometry::Vec2;

constexpr double kDegree = 0.017453292519943295;
constexpr double kDistanceFloor_m = 0.04;  // LiDAR noise: closer than this is on the line

struct Closeness {
    double value = -std::numeric_limits<double>::infinity();
    Rectangle rectangle;
};

Closeness closenessAt(double theta_rad, const std::vector<Vec2>& points,
                      std::vector<Vec2>& scratch) {
    Closeness out;
    Rectangle& r = out.rectangle;
    r.theta_rad = theta_rad;
    const Vec2 e1 = r.axis(0), e2 = r.axis(1);
    const double inf = std::numeric_limits<double>::infinity();
    r.low = Vec2(inf, inf);
    r.high = -r.low;
    scratch.clear();
    for (const auto& p : points) {
        scratch.emplace_back(e1.dot(p), e2.dot(p));
        r.low = r.low.cwiseMin(scratch.back());
        r.high = r.high.cwiseMax(scratch.back());
    }
    // The side of each axis that the points hug as a whole.
    double toLow[2] = {0, 0}, toHigh[2] = {0, 0};
    for (const auto& q : scratch) {
        for (int k = 0; k < 2; ++k) {
            toLow[k] += (q[k] - r.low[k]) * (q[k] - r.low[k]);
            toHigh[k] += (r.high[k] - q[k]) * (r.high[k] - q[k]);
        }
    }
    out.value = 0;
    for (const auto& q : scratch) {
        double d = inf;
        for (int k = 0; k < 2; ++k) {
            d = std::min(d, toLow[k] <= toHigh[k] ? q[k] - r.low[k] : r.high[k] - q[k]);
        }
        out.value += 1.0 / std::max(d, kDistanceFloor_m);
    }
    return out;
}

std::vector<cv::Point2f> cornersOf(const Rectangle& r) {
    std::vector<cv::Point2f> out;
    for (const auto& q :
         {r.low, Vec2(r.high.x(), r.low.y()), r.high, Vec2(r.low.x(), r.high.y())}) {
        const Vec2 p = r.fromAxes(q);
        out.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    }
    return out;
}

}  // namespace

Rectangle fitRectangle(const std::vector<Vec2>& outline) {
    std::vector<Vec2> scratch;
    scratch.reserve(outline.size());
    Closeness best;
    for (int step = 0; step < 45; ++step) {
        const auto c = closenessAt(step * 2 * kDegree, outline, scratch);
        if (c.value > best.value) best = c;
    }
    const double coarse = best.rectangle.theta_rad;
    for (int step = -7; step <= 7; ++step) {
        double theta = coarse + step * 0.25 * kDegree;
        if (theta < 0) theta += 90 * kDegree;
        if (theta >= 90 * kDegree) theta -= 90 * kDegree;
        const auto c = closenessAt(theta, outline, scratch);
        if (c.value > best.value) best = c;
    }
    return best.rectangle;
}

double meanDistanceToVisibleSides(const Rectangle& r, const std::vector<Vec2>& outline) {
    double sum = 0;
    for (const auto& p : outline) {
        const Vec2 q = r.toAxes(p);
        double d = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 2; ++k) {
            if (r.low[k] > 0) d = std::min(d, std::abs(q[k] - r.low[k]));
            if (r.high[k] < 0) d = std::min(d, std::abs(q[k] - r.high[k]));
        }
        if (std::isfinite(d)) sum += d;
    }
    return sum / static_cast<double>(outline.size());
}

double overlapOfSmaller(const Rectangle& a, const Rectangle& b) {
    const double reach = 0.5 * (a.extent().norm() + b.extent().norm());
    if ((a.centre() - b.centre()).norm() >= reach) return 0;
    std::vector<cv::Point2f> common;
    const double area = cv::intersectConvexConvex(cornersOf(a), cornersOf(b), common);
    const double smaller = std::min(a.extent().prod(), b.extent().prod());
    return smaller > 0 ? area / smaller : 0;
}

}  // namespace djpete::observers
