/// A cluster judged as a car.
#pragma once

#include <optional>
#include <vector>

#include "box_fit.h"
#include "clusters.h"

namespace djpete::observers {

/// A box of car size over a cluster, completed where the sensor does not see.
struct Candidate {
    Rectangle box;                    ///< footprint, completed
    int lengthAxis = 0;               ///< which of the rectangle's axes is the car's length
    double height_m = 0;              ///< over the ground below it
    double score = 0;                 ///< 0..1
    geometry::Vec3 sigma_m;           ///< of the centre along (length, width, height)
    geometry::Vec3 sigma_rad;         ///< of the rotation about (length, width, height)
    std::vector<uint32_t> obstacles;  ///< indices into GroundPlan::obstacles()

    double length_m() const { return box.extent()[lengthAxis]; }
    double width_m() const { return box.extent()[1 - lengthAxis]; }
};

/// Fits and completes a box; nothing if the cluster cannot be a car. The score is the product of
/// factors in 0..1: sizes against a car's, fit of the outline, fill of the visible side, height and
/// its profile, ground not seen through the box, number of returns.
std::optional<Candidate> judge(const Cluster& cluster, const GroundPlan& plan,
                               const GeometricObserverOptions& options);

}  // namespace djpete::observers
