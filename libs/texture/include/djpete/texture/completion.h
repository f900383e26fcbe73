/// What no sensor saw of an object: taken from its other side, and colours from neighbours.
#pragma once

#include <cstddef>
#include <optional>

#include "djpete/texture/object_model.h"

namespace djpete::texture {

/// An upright plane through (0, offset, 0) of frame obj, turned by yaw from the box's x-z plane.
struct SymmetryPlane {
    double offset_m = 0;
    double yaw_rad = 0;

    geometry::Vec3 normal() const;
    geometry::Vec3 mirrored(const geometry::Vec3& p_obj) const;
    geometry::Vec3 mirroredDirection(const geometry::Vec3& direction_obj) const;
};

struct SymmetryOptions {
    double max_offset_m = 0.15;   ///< of the plane from the box's
    double max_yaw_rad = 0.0698;  ///< of the plane from the box's
    double min_overlap = 0.05;    ///< fraction of the points that face sideways on both sides
    double same_place_m = 0.08;   ///< along the surface: a point is there already
    double same_depth_m = 0.15;   ///< across the surface: a point is there already
    double box_margin_m = 0.10;   ///< mirrored points may lie so far outside the box
    double same_colour_m = 0.12;  ///< partners of points without a colour, at most so far
};

struct SymmetryFit {
    SymmetryPlane plane;   ///< the box's x-z plane if the points cannot tell
    bool refined = false;  ///< the points told the plane
    double overlap = 0;    ///< fraction of points that face sideways and meet one when mirrored
    /// Median over points that face sideways, mirrored to the surface there; nothing if no surface
    /// is near.
    std::optional<double> distance_m;
    std::optional<double> box_distance_m;  ///< the same with the box's plane
};

struct SymmetryReport {
    SymmetryFit fit;
    std::size_t added = 0;         ///< mirrored points
    std::size_t coloured = 0;      ///< points that were there and took their partner's colour
    std::size_t contradicted = 0;  ///< not added: rays passed there and behind
    std::size_t outside = 0;       ///< not added: beyond the box
};

/// Finds the plane that maps what was seen best onto itself; the box's is believed unless enough
/// points tell another. Points that are inferred or face inwards do not count.
SymmetryFit fitSymmetry(const ObjectModel& model,
                        const SymmetryOptions& options = SymmetryOptions());

/// Adds the mirrored points of what was seen and faces outwards, where no point is near, no ray
/// passed (ObjectModel::freeSpace) and the box reaches, flagged kInferredPoint | kInferredColour;
/// points without a colour take the one of their mirrored place (kInferredColour). Inferred colours
/// have a count of 1 and are of no view. Wheels, text and plates are mirrored too.
SymmetryReport symmetrise(ObjectModel& model, const SymmetryOptions& options = SymmetryOptions());

struct FillOptions {
    double reach_m = 0.15;        ///< between neighbours on the surface
    double mirror_reach_m = 0.1;  ///< around mirrored places (box's x-z plane); 0: one side alone
    double max_distance_m = 1.5;  ///< to the nearest colour, across gaps of the surface
    unsigned sweeps = 60;         ///< of smoothing
};

/// Gives points without a colour one that goes over smoothly into those of their neighbours on the
/// surface and on the object's other side (kInferredColour); returns how many. Points too far from
/// any colour stay without.
std::size_t fillColours(ObjectModel& model, const FillOptions& options = FillOptions());

}  // namespace djpete::texture
