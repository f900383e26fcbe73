#include "djpete/texture/completion.h"

#include <cmath>

#include "facing.h"
#include "point_grid.h"
#include "vectors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;

bool insideBox(const Vec3& p, const Vec3& size_m, double margin_m) {
    for (int i = 0; i < 3; ++i) {
        if (std::abs(p[i]) > 0.5 * size_m[i] + margin_m) return false;
    }
    return true;
}

/// True if the model has a surface at p: near along it, and not too far across it.
bool somethingAt(const ObjectModel& model, const PointGrid& grid, const Vec3& p, const Vec3& n,
                 const SymmetryOptions& options) {
    bool found = false;
    grid.forWithin(p, std::hypot(options.same_place_m, options.same_depth_m),
                   [&](uint32_t i, double d2) {
                       const double across = n.dot(p - vec3(model.point(i)));
                       const double along2 = d2 - across * across;
                       const bool near = std::abs(across) < options.same_depth_m &&
                                         along2 < options.same_place_m * options.same_place_m;
                       found |= near && n.dot(vec3(model.normals[i])) > 0;
                   });
    return found;
}

/// True if sensors looked through the surface itself, not only along its outside or at what is
/// inside.
bool seenThrough(const FreeSpace& space, const Vec3& p, const Vec3& n) {
    const double step_m = 0.7 * static_cast<double>(FreeSpace::kCell_m);
    return space.isFree(p) && space.isFree(p + step_m * n) && space.isFree(p - step_m * n);
}

/// Mean colour of coloured points near p that face the same way, nearest first; weight 0: none.
ColourSum colourAt(const ObjectModel& model, const PointGrid& coloured, const Vec3& p,
                   const Vec3& n, double radius_m) {
    ColourSum out;
    coloured.forWithin(p, radius_m, [&](uint32_t i, double d2) {
        const double facing = n.dot(vec3(model.normals[i]));
        if (facing < 0.5) return;
        const double spread = radius_m / 3;
        const double weight = facing * std::exp(-d2 / (2 * spread * spread));
        out.add(model.colours[i].mean, static_cast<float>(weight));
    });
    return out;
}

/// An inferred colour counts as one sample and has no spread.
ColourSum inferred(const ColourSum& from) {
    ColourSum out;
    out.add(from.mean, 1.0F);
    return out;
}

}  // namespace

SymmetryReport symmetrise(ObjectModel& model, const SymmetryOptions& options) {
    SymmetryReport report;
    report.fit = fitSymmetry(model, options);
    if (model.size() == 0) return report;
    model = model.clone();
    const SymmetryPlane& plane = report.fit.plane;
    const ObjectModel before = model;  // shares the cloud: only positions and old lists are read
    const auto seenColour = [&](uint32_t i) {
        return before.colours[i].count > 0 && (before.flags[i] & flag::kInferredColour) == 0;
    };
    const PointGrid all(before, 0.1), coloured(before, 0.1, seenColour);
    const auto count = static_cast<uint32_t>(before.size());
    for (uint32_t i = 0; i < count; ++i) {
        const Vec3 p = plane.mirrored(vec3(before.point(i)));
        const Vec3 n = plane.mirroredDirection(vec3(before.normals[i]));
        if (before.colours[i].count == 0) {
            const ColourSum partner = colourAt(before, coloured, p, n, options.same_colour_m);
            if (partner.count > 0) {
                model.colours[i] = inferred(partner);
                model.flags[i] |= flag::kInferredColour;
                model.showColour(i);
                ++report.coloured;
            }
        }
        if ((before.flags[i] & flag::kInferredPoint) != 0 || facesInwards(p, n)) continue;
        if (!insideBox(p, before.size_m, options.box_margin_m)) {
            ++report.outside;
            continue;
        }
        if (somethingAt(before, all, p, n, options)) continue;
        if (seenThrough(before.freeSpace, p, n)) {
            ++report.contradicted;
            continue;
        }
        const std::size_t to = model.size();
        model.addPoint(floats(p), floats(n), before.radius_m[i],
                       flag::kInferredPoint | flag::kInferredColour |
                           (before.flags[i] & (flag::kEdited | flag::kDarkPart)));
        if (!before.albedo.empty()) model.albedo[to] = before.albedo[i];
        if (before.colours[i].count > 0) {
            model.colours[to] = inferred(before.colours[i]);
            model.showColour(to);
        }
        ++report.added;
    }
    return report;
}

}  // namespace djpete::texture
