#include "djpete/evaluation/trajectory_errors.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "djpete/evaluation/alignment.h"
#include "djpete/evaluation/statistics.h"
#include "djpete/obs/errors.h"

namespace djpete::evaluation {

using geometry::SE3;

namespace {

constexpr double kRadToDeg = 180.0 / M_PI;

double rootMeanSquare(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v * v;
    return std::sqrt(sum / static_cast<double>(values.size()));
}

std::vector<double> positionErrors(const Trajectory& estimate, const Trajectory& truth,
                                   const Alignment& alignment) {
    std::vector<double> errors(estimate.size());
    for (std::size_t i = 0; i < estimate.size(); ++i) {
        errors[i] = (alignment * estimate[i].translation() - truth[i].translation()).norm();
    }
    return errors;
}

/// The estimated motion from frame i to frame j against the true one; identity if they agree.
SE3 motionError(const Trajectory& estimate, const Trajectory& truth, std::size_t i, std::size_t j) {
    return (estimate[i].inverse() * estimate[j]).inverse() * (truth[i].inverse() * truth[j]);
}

std::vector<double> distanceTravelled(const Trajectory& path) {
    std::vector<double> distance(path.size(), 0.0);
    for (std::size_t i = 1; i < path.size(); ++i) {
        distance[i] = distance[i - 1] + (path[i].translation() - path[i - 1].translation()).norm();
    }
    return distance;
}

void addDrift(const Trajectory& estimate, const Trajectory& truth, TrajectoryErrors& out) {
    constexpr std::size_t kStartEvery = 10;
    const auto distance = distanceTravelled(truth);
    double sumTranslation = 0, sumRotation = 0;
    for (std::size_t first = 0; first < truth.size(); first += kStartEvery) {
        for (double length_m = 100; length_m <= 800; length_m += 100) {
            // The sub-path ends at the first frame that lies farther along than its length.
            const auto end =
                std::upper_bound(distance.begin(), distance.end(), distance[first] + length_m);
            if (end == distance.end()) break;
            const auto last = static_cast<std::size_t>(end - distance.begin());
            const SE3 error = motionError(estimate, truth, first, last);
            sumTranslation += error.translation().norm() / length_m;
            sumRotation += error.angle_rad() / length_m;
            ++out.segments;
        }
    }
    if (out.segments == 0) return;
    const double n = static_cast<double>(out.segments);
    out.t_rel_percent = 100 * sumTranslation / n;
    out.r_rel_deg_per_100m = 100 * kRadToDeg * sumRotation / n;
}

void addRelativePoseError(const Trajectory& estimate, const Trajectory& truth,
                          TrajectoryErrors& out) {
    if (truth.size() < 2) return;
    std::vector<double> translations, rotations;
    for (std::size_t i = 0; i + 1 < truth.size(); ++i) {
        const SE3 error = motionError(estimate, truth, i, i + 1);
        translations.push_back(error.translation().norm());
        rotations.push_back(kRadToDeg * error.angle_rad());
    }
    out.rpe_m = rootMeanSquare(translations);
    out.rpe_deg = rootMeanSquare(rotations);
}

}  // namespace

TrajectoryErrors evaluateTrajectory(const Trajectory& estimate, const Trajectory& truth) {
    if (estimate.size() != truth.size() || truth.empty()) {
        throw obs::InputError("trajectories of " + std::to_string(estimate.size()) + " and " +
                              std::to_string(truth.size()) +
                              " poses cannot be compared; expected equally many, at least one");
    }
    TrajectoryErrors out;
    out.frames = truth.size();
    const auto se3 = positionErrors(estimate, truth, alignSe3(estimate, truth));
    out.ate_se3_m = rootMeanSquare(se3);
    out.ate_se3_median_m = quantile(se3, 0.5).value();
    out.ate_se3_max_m = *std::max_element(se3.begin(), se3.end());
    out.ate_unaligned_m = rootMeanSquare(positionErrors(estimate, truth, Alignment{}));
    if (const auto sim3 = alignSim3(estimate, truth)) {
        out.ate_sim3_m = rootMeanSquare(positionErrors(estimate, truth, *sim3));
        out.sim3_scale = sim3->scale;
    }
    addDrift(estimate, truth, out);
    addRelativePoseError(estimate, truth, out);
    return out;
}

}  // namespace djpete::evaluation
