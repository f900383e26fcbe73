/// Where an object will be in the next frame: two simple models, weighed by how well they did.
#pragma once

#include "djpete/geometry/se3.h"

namespace djpete::backend {

struct FilterOptions {
    /// Random walk of a standing object's position, m per sqrt(s).
    double staticWalk = 0.05;
    /// 1-sigma of a moving object's acceleration.
    double acceleration_mps2 = 3.0;
    /// Random walk of the yaw, rad per sqrt(s).
    double yawWalk = 0.2;
    /// 1-sigma of the speed of an object seen once: along its length, and across.
    double speed_mps = 10.0, crossSpeed_mps = 1.5;
};

/// Position and yaw of a detection in `world`, with covariance.
struct PositionYaw {
    geometry::Vec3 p_world{0, 0, 0};
    geometry::Mat3 covariance = geometry::Mat3::Identity();
    double yaw_rad = 0, yawVariance = 1;
};

/// A standing model (3 states) and a constant-velocity model (6 states) of an object's position
/// run side by side; each keeps a weight by its likelihood. Yaw is filtered alone.
class ObjectFilter {
  public:
    ObjectFilter() = default;
    ObjectFilter(const PositionYaw& first, const FilterOptions& options);

    void predict(double dt_s, const FilterOptions& options);
    /// Distances of a detection to one model's prediction.
    struct Match {
        double distance2 = 0;       ///< squared Mahalanobis, position only
        double logDeterminant = 0;  ///< of the innovation's covariance
        double logWeight = 0;       ///< of the model, <= 0
        geometry::Vec3 p_world;     ///< predicted
    };
    /// The better of both models for this detection, by distance + logDeterminant - 2 logWeight.
    Match match(const PositionYaw& z) const;
    /// `z.yaw_rad` must already be turned to the filter's heading.
    void update(const PositionYaw& z, const FilterOptions& options);

    /// x -> R x + t of everything, R and t of T; headings turn with it.
    void transform(const geometry::SE3& T_new_old);
    void turnRound();

    double yaw_rad() const { return yaw_rad_; }
    double yawVariance() const { return yawVariance_; }
    /// Of the model with the larger weight.
    geometry::Vec3 p_world() const;
    geometry::Vec3 velocity_mps() const { return moving_.tail<3>(); }
    bool likelyStatic() const { return logStatic_ >= logMoving_; }

  private:
    geometry::Vec3 static_{0, 0, 0};
    geometry::Mat3 staticP_ = geometry::Mat3::Identity();
    geometry::Vec6 moving_ = geometry::Vec6::Zero();  // position, velocity
    geometry::Mat6 movingP_ = geometry::Mat6::Identity();
    double yaw_rad_ = 0, yawVariance_ = 1;
    double logStatic_ = 0, logMoving_ = 0;
};

}  // namespace djpete::backend
