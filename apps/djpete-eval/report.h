/// How djpete-eval tells its results.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "djpete/evaluation/loop_errors.h"
#include "djpete/evaluation/object_errors.h"
#include "djpete/evaluation/trajectory_errors.h"

namespace djpete::apps {

struct EvaluationResults {
    std::size_t frames = 0;
    std::optional<evaluation::TrajectoryErrors> trajectory;  ///< nothing without --truth
    std::optional<evaluation::LoopErrors> loops;             ///< nothing without --loops
    std::optional<evaluation::ObjectErrors> objects;         ///< nothing without --objects
};

/// One JSON object. Always the keys ate_se3_m, ate_unaligned_m, ate_sim3_m, sim3_scale,
/// t_rel_percent, r_rel_deg_per_100m, frames; with loops also revisits, revisits_found, loop_pairs,
/// loop_pairs_wrong, loop_error_median_m, loop_error_median_deg; with objects also
/// objects_labelled, objects_matched_one_to_one, objects_duplicated, objects_missed, objects_false,
/// objects_without_switch, object_switches, objects_seen_again, objects_known_again,
/// centre_error_median_m, centre_error_p90_m, bev_error_median_m, yaw_error_median_deg,
/// yaw_mod_pi_error_median_deg. What cannot be computed is null.
std::string jsonReport(const EvaluationResults& results);

/// A table for people, with some figures more.
std::string textReport(const EvaluationResults& results);

}  // namespace djpete::apps
