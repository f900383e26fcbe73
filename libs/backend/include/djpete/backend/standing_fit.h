/// The one pose of an object that stands still.
#pragma once

#include <optional>
#include <vector>

#include "djpete/backend/motion_chain.h"

namespace djpete::backend {

struct StandingFit {
    geometry::SE3 T_world_obj;
    geometry::Mat6 covariance = geometry::Mat6::Zero();  ///< frame obj, given the cameras
    double cost = 0;                                     ///< half of the sum of rho
};

/// "Its z axis is `up_world`": 1-sigma of the tilt.
struct UprightPrior {
    geometry::Vec3 up_world{0, 0, 1};
    double sigma_rad = 1;
};

/// The pose that all measurements together make most probable, under `kernel`. Starts from `start`
/// if there is one, else from the measurement that the others agree with most, with a kernel that
/// is wide first and narrows (graduated non-convexity), so that up to a third of rubbish does not
/// hold it. Nothing without measurements or if the problem is degenerate.
std::optional<StandingFit> fitStanding(const std::vector<ChainNode::Measured>& measured,
                                       const solver::RobustKernel& kernel,
                                       const std::optional<UprightPrior>& upright,
                                       const std::optional<geometry::SE3>& start);

}  // namespace djpete::backend
