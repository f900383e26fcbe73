/// The returns of a scan that may belong to a detected object.
#pragma once

#include <vector>

#include "djpete/obs/CObservationDetectedObjects.h"
#include "djpete/obs/sensor_frame.h"

namespace djpete::observers {

struct GatherLimits {
    double margin_m = 0.5;  ///< a detection may be off by about so much
    unsigned body = 250;    ///< points kept of an object; thinned evenly over its surface
    unsigned ground = 50;   ///< points kept of the ground around it
};

/// A scan sorted into the cells of a plan, so that objects are looked up in a few of them. Keeps a
/// reference to the scan.
class PointGatherer {
  public:
    explicit PointGatherer(const obs::LidarScan& scan);

    /// Returns around a box, in frame velo; T_velo_obj places the box. What belongs to the ground
    /// is told by its height: the lowest level around the box at which many returns lie. Null if
    /// nothing is left above the ground.
    obs::ObjectPointsPtr gather(const geometry::SE3& T_velo_obj, const geometry::Vec3& size_m,
                                const GatherLimits& limits) const;

  private:
    std::size_t cellOf(float x, float y) const;

    const obs::LidarScan& scan_;
    std::vector<uint32_t> begin_;  // of each cell in order_
    std::vector<uint32_t> order_;  // indices of points, cell by cell
};

/// Gives every detection without points of its own those of the scan, in the frame of the
/// detections' sensor.
void gatherPoints(obs::CObservationDetectedObjects& objects, const obs::LidarScan& scan,
                  const GatherLimits& limits);

}  // namespace djpete::observers
