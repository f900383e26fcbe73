/// The box of an object.
#pragma once

#include <array>

#include "djpete/geometry/se3.h"

namespace djpete::geometry {

/// Size of an object's box in its own frame `obj`: origin at the box centre, x along length, y
/// along width (to the left), z up along height.
struct Cuboid {
    Vec3 size_m = Vec3::Zero();  ///< (length, width, height)

    /// True if p_obj lies in the box grown by `margin_m` on every side.
    bool contains(const Vec3& p_obj, double margin_m = 0) const {
        return (p_obj.cwiseAbs() - 0.5 * size_m).maxCoeff() <= margin_m;
    }
    /// The eight corners in `obj`; bit 0 of the index is +x, bit 1 is +y, bit 2 is +z.
    std::array<Vec3, 8> corners() const {
        std::array<Vec3, 8> out;
        for (unsigned i = 0; i < 8; ++i) {
            const Vec3 sign((i & 1U) ? 0.5 : -0.5, (i & 2U) ? 0.5 : -0.5, (i & 4U) ? 0.5 : -0.5);
            out[i] = sign.cwiseProduct(size_m);
        }
        return out;
    }
};

}  // namespace djpete::geometry
