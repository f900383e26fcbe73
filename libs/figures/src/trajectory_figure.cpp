#include <cmath>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "canvas.h"
#include "djpete/evaluation/alignment.h"
#include "djpete/evaluation/trajectory_errors.h"
#include "parts.h"

namespace djpete::figures {

namespace {

using geometry::Vec3;

const cv::Scalar kEstimate(30, 90, 230), kTruth(60, 60, 60);
constexpr int kMargin_px = 70, kWidth_px = 1400;

/// 1, 2 or 5 times a power of ten: about `count` steps in `length`.
double niceStep(double length, int count) {
    const double rough = length / count;
    const double power = std::pow(10, std::floor(std::log10(rough)));
    for (const double f : {1.0, 2.0, 5.0}) {
        if (rough <= f * power) return f * power;
    }
    return 10 * power;
}

/// Metres in world (x forward at the start, y left) to pixels; equal scales.
struct Plot {
    cv::Mat picture;
    Eigen::Vector2d low{0, 0};
    double scale = 1;

    Plot(const std::vector<Vec3>& points) {
        Eigen::Vector2d high(-1e18, -1e18);
        low = -high;
        for (const auto& p : points) {
            low = low.cwiseMin(p.head<2>());
            high = high.cwiseMax(p.head<2>());
        }
        const double least = 0.15 * std::max(1.0, (high - low).maxCoeff());
        for (int i = 0; i < 2; ++i) {  // a straight drive has a little breadth, too
            const double lacking = std::max(0.0, 2 * least - (high[i] - low[i]));
            low[i] -= 0.5 * lacking;
            high[i] += 0.5 * lacking;
        }
        const Eigen::Vector2d size = high - low;
        scale = (kWidth_px - 2 * kMargin_px) / std::max(size.x(), size.y());
        const auto px = [&](double m) { return static_cast<int>(m * scale) + 2 * kMargin_px; };
        picture = cv::Mat(px(size.y()), px(size.x()), CV_8UC3, cv::Scalar::all(255));
        axes(high);
    }

    cv::Point at(double x, double y) const {
        return {kMargin_px + static_cast<int>(std::lround((x - low.x()) * scale)),
                picture.rows - kMargin_px - static_cast<int>(std::lround((y - low.y()) * scale))};
    }
    void axes(const Eigen::Vector2d& high) {
        const double step =
            std::min(niceStep((high - low).maxCoeff(), 8), niceStep((high - low).minCoeff(), 4));
        for (int i = 0; i < 2; ++i) {
            for (double v = std::ceil(low[i] / step) * step; v <= high[i]; v += step) {
                const cv::Point a = i == 0 ? at(v, low.y()) : at(low.x(), v);
                const cv::Point b = i == 0 ? at(v, high.y()) : at(high.x(), v);
                cv::line(picture, a, b, cv::Scalar::all(225), 1, cv::LINE_AA);
                std::ostringstream label;
                label << (std::abs(v) < 1e-9 ? 0.0 : v);
                text(picture, label.str(), i == 0 ? a + cv::Point(-12, 20) : a + cv::Point(-50, 5),
                     cv::Scalar::all(90), 0.45);
            }
        }
        text(picture, "x (forward at the start), m", {picture.cols / 2 - 90, picture.rows - 18},
             cv::Scalar::all(60));
        text(picture, "y, m", {12, kMargin_px - 20}, cv::Scalar::all(60));
    }
    void path(const std::vector<Vec3>& points, const cv::Scalar& colour, int width) {
        for (std::size_t i = 1; i < points.size(); ++i) {
            cv::line(picture, at(points[i - 1].x(), points[i - 1].y()),
                     at(points[i].x(), points[i].y()), colour, width, cv::LINE_AA);
        }
        cv::circle(picture, at(points[0].x(), points[0].y()), width + 3, colour, cv::FILLED,
                   cv::LINE_AA);
    }
};

}  // namespace

Figure trajectoryFigure(const evaluation::CameraPath& estimate,
                        const std::map<std::size_t, geometry::SE3>& truth) {
    evaluation::Trajectory mine, theirs;
    for (std::size_t i = 0; i < estimate.T_world_cam.size(); ++i) {
        const auto it = truth.find(estimate.firstFrame + i);
        if (it == truth.end()) continue;
        mine.push_back(estimate.T_world_cam[i]);
        theirs.push_back(it->second);
    }
    std::vector<Vec3> path, truePath;
    for (const auto& T : estimate.T_world_cam) path.push_back(T.translation());
    std::ostringstream caption;
    caption.precision(3);
    if (mine.size() > 1) {
        // The truth goes to the run's world, so that the axes are those of the run.
        const auto back = evaluation::alignSe3(theirs, mine);
        for (const auto& T : theirs) truePath.push_back(back * T.translation());
        const auto errors = evaluation::evaluateTrajectory(mine, theirs);
        caption << "Trajectory (red) over the truth (grey), SE(3)-aligned: ATE " << errors.ate_se3_m
                << " m over " << errors.frames << " frames";
        if (errors.t_rel_percent) caption << ", drift " << *errors.t_rel_percent << " %";
    } else {
        caption << "Trajectory; no truth is known";
    }
    std::vector<Vec3> all = path;
    all.insert(all.end(), truePath.begin(), truePath.end());
    Plot plot(all);
    if (!truePath.empty()) plot.path(truePath, kTruth, 5);
    plot.path(path, kEstimate, 2);
    return {captioned(plot.picture, caption.str()), ""};
}

}  // namespace djpete::figures
