#include "djpete/obs/overlap.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace djpete::obs {

namespace {

using geometry::Vec2;
using Polygon = std::vector<Vec2>;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Corners in counter-clockwise order, relative to `origin` so that numbers stay small.
Polygon groundRectangle(const UprightBox& box, const Vec2& origin) {
    const Vec2 centre = box.centre.head<2>() - origin;
    const Vec2 forward = 0.5 * box.size_m.x() * Vec2(std::cos(box.yaw_rad), std::sin(box.yaw_rad));
    const Vec2 left = 0.5 * box.size_m.y() * Vec2(-std::sin(box.yaw_rad), std::cos(box.yaw_rad));
    return {centre + forward + left, centre - forward + left, centre - forward - left,
            centre + forward - left};
}

/// The part of a convex polygon left of the line a -> b (Sutherland and Hodgman).
Polygon clip(const Polygon& polygon, const Vec2& a, const Vec2& b) {
    Polygon out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2& p = polygon[i];
        const Vec2& q = polygon[(i + 1) % polygon.size()];
        const double sp = cross(b - a, p - a), sq = cross(b - a, q - a);
        if (sp >= 0) out.push_back(p);
        if ((sp >= 0) != (sq >= 0)) out.push_back(p + sp / (sp - sq) * (q - p));
    }
    return out;
}

double area(const Polygon& polygon) {
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    }
    return 0.5 * std::abs(twice);
}

double groundIntersection(const UprightBox& a, const UprightBox& b) {
    const Vec2 between = (b.centre - a.centre).head<2>();
    if (2 * between.norm() > a.size_m.head<2>().norm() + b.size_m.head<2>().norm()) return 0;
    const Vec2 origin = a.centre.head<2>();
    Polygon polygon = groundRectangle(a, origin);
    const Polygon other = groundRectangle(b, origin);
    for (std::size_t i = 0; i < other.size() && polygon.size() >= 3; ++i) {
        polygon = clip(polygon, other[i], other[(i + 1) % other.size()]);
    }
    return polygon.size() < 3 ? 0 : area(polygon);
}

double overUnion(double intersection, double a, double b) {
    const double together = a + b - intersection;
    return together > 0 ? intersection / together : 0;
}

double common(double middleA, double sizeA, double middleB, double sizeB) {
    const double top = std::min(middleA + 0.5 * sizeA, middleB + 0.5 * sizeB);
    const double bottom = std::max(middleA - 0.5 * sizeA, middleB - 0.5 * sizeB);
    return std::max(0.0, top - bottom);
}

}  // namespace

UprightBox uprightBox(const geometry::SE3& T_world_obj, const geometry::Vec3& size_m) {
    return {T_world_obj.translation(), T_world_obj.yaw_rad(), size_m};
}

double birdsEyeOverlap(const UprightBox& a, const UprightBox& b) {
    return overUnion(groundIntersection(a, b), a.size_m.head<2>().prod(),
                     b.size_m.head<2>().prod());
}

double volumeOverlap(const UprightBox& a, const UprightBox& b) {
    const double height = common(a.centre.z(), a.size_m.z(), b.centre.z(), b.size_m.z());
    return overUnion(height * groundIntersection(a, b), a.size_m.prod(), b.size_m.prod());
}

double imageOverlap(const ImageBox& a, const ImageBox& b) {
    const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
    const double height = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
    const double intersection = std::max(0.0, width) * std::max(0.0, height);
    return overUnion(intersection, static_cast<double>(a.area()), static_cast<double>(b.area()));
}

}  // namespace djpete::obs
