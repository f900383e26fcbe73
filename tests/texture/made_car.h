/// A made-up car of two boxes with painted panels, as points on its surface; frame obj.
#pragma once

#include <cmath>
#include <functional>

#include "djpete/texture/object_model.h"

namespace djpete_test {

using djpete::geometry::Vec3;
using djpete::texture::ObjectModel;

struct MadeCar {
    Vec3 size_m{4.2, 1.8, 1.5};
    double step_m = 0.04;
    double offset_m = 0;  ///< of the car's middle to the left of the box's
    double yaw_rad = 0;   ///< of the car in the box
    std::array<float, 3> paint{180, 40, 40};
    /// True where a camera saw the colour; where false there is no point (or none with colour).
    std::function<bool(const Vec3& p_car, const Vec3& n_car)> seen;
    bool keepUnseen = false;  ///< unseen points stay, without a colour

    /// Lower half: the body with a stripe that is white left and right; upper half: the cabin of
    /// dark windows with a painted roof; front blue-grey, back dark.
    std::array<float, 3> colourAt(const Vec3& p, const Vec3& n) const {
        if (n.z() > 0.7) return p.z() > 0.3 ? paint : std::array<float, 3>{160, 60, 60};
        if (p.z() > 0) return {40, 45, 60};
        if (n.x() > 0.7) return {90, 100, 140};
        if (n.x() < -0.7) return {60, 20, 20};
        return p.z() > -0.3 && p.z() < -0.15 ? std::array<float, 3>{230, 230, 230} : paint;
    }

    ObjectModel model() const {
        ObjectModel out;
        out.id = {7};
        out.size_m = size_m;
        out.cloud = mrpt::maps::CColouredPointsMap::Create();
        const double h = 0.5 * size_m.z(), l = 0.5 * size_m.x(), w = 0.5 * size_m.y();
        addBox({-l, -w, -h}, {l, w, 0}, {-0.55 * l, -0.85 * w, 0}, {0.35 * l, 0.85 * w, 0}, out);
        addBox({-0.55 * l, -0.85 * w, 0}, {0.35 * l, 0.85 * w, h}, {0, 0, 0}, {0, 0, 0}, out);
        return out;
    }

  private:
    /// The box's faces but its bottom, and but the part of its top from `cutLow` to `cutHigh`.
    void addBox(const Vec3& low, const Vec3& high, const Vec3& cutLow, const Vec3& cutHigh,
                ObjectModel& out) const {
        for (int axis = 0; axis < 3; ++axis) {
            for (const int side : {-1, 1}) {
                if (axis == 2 && side < 0) continue;
                const int a = (axis + 1) % 3, b = (axis + 2) % 3;
                const auto steps = [&](int i) {
                    return static_cast<int>(std::floor((high[i] - low[i]) / step_m));
                };
                for (int i = 0; i <= steps(a); ++i) {
                    for (int j = 0; j <= steps(b); ++j) {
                        Vec3 p, n = Vec3::Zero();
                        n[axis] = side;
                        p[axis] = side < 0 ? low[axis] : high[axis];
                        p[a] = low[a] + (high[a] - low[a]) * i / steps(a);
                        p[b] = low[b] + (high[b] - low[b]) * j / steps(b);
                        const bool cut = axis == 2 && p.x() > cutLow.x() && p.x() < cutHigh.x() &&
                                         p.y() > cutLow.y() && p.y() < cutHigh.y();
                        if (!cut) addPoint(p, n, out);
                    }
                }
            }
        }
    }

    void addPoint(const Vec3& p, const Vec3& n, ObjectModel& out) const {
        const bool visible = !seen || seen(p, n);
        if (!visible && !keepUnseen) return;
        const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
        const auto turned = [&](const Vec3& v) {
            return std::array<float, 3>{static_cast<float>(c * v.x() - s * v.y()),
                                        static_cast<float>(s * v.x() + c * v.y()),
                                        static_cast<float>(v.z())};
        };
        auto p_obj = turned(p);
        p_obj[1] += static_cast<float>(offset_m);
        out.addPoint(p_obj, turned(n), static_cast<float>(0.9 * step_m));
        if (!visible) return;
        out.colours.back().add(colourAt(p, n), 1);
        out.colours.back().add(colourAt(p, n), 1);
        out.seenIn.back() = 1;
        out.showColour(out.size() - 1);
    }
};

}  // namespace djpete_test
