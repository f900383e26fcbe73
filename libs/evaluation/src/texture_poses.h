/// Models between the estimated and the true frame. Private to the room.
#pragma once

#include <optional>

#include "djpete/evaluation/texture_evaluation.h"

namespace djpete::evaluation {

/// Where the view that coloured most points has the model's frame, seen from the true one:
/// T_true_est = T_cam_true^-1 T_cam_est. Nothing if no view of the model has both poses.
std::optional<geometry::SE3> poseByBestView(const texture::ObjectModel& model, int64_t object,
                                            int64_t actor, const EstimatedDrive& estimate,
                                            const TrueDrive& truth);

/// Views of the model from which the actor was at most so far away.
std::size_t nearViews(const texture::ObjectModel& model, int64_t actor, const TrueDrive& truth,
                      double maxRange_m);

}  // namespace djpete::evaluation
