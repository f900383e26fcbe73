#include "object_mask.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace djpete::observers {

namespace {

struct Disc {
    cv::Point centre;
    int radius_px;
};

}  // namespace

std::optional<MaskAndBox> maskOfPoints(const std::vector<geometry::Vec3>& p_cam,
                                       const geometry::StereoCamera& camera, double reach_m) {
    std::vector<Disc> discs;
    cv::Rect bounds;
    for (const auto& p : p_cam) {
        if (p.z() < 0.5) continue;
        const geometry::Vec2 uv = camera.project(p);
        if (!camera.contains(uv)) continue;
        const int radius =
            std::clamp(static_cast<int>(std::lround(reach_m * camera.fx / p.z())), 1, 60);
        const cv::Point at(static_cast<int>(std::lround(uv.x())),
                           static_cast<int>(std::lround(uv.y())));
        discs.push_back({at, radius});
        const cv::Rect own(at.x - radius, at.y - radius, 2 * radius + 1, 2 * radius + 1);
        bounds = discs.size() == 1 ? own : (bounds | own);
    }
    if (discs.size() < 3) return std::nullopt;
    bounds &= cv::Rect(0, 0, camera.width_px, camera.height_px);
    cv::Mat patch = cv::Mat::zeros(bounds.size(), CV_8UC1);
    for (const auto& d : discs) {
        cv::circle(patch, d.centre - bounds.tl(), d.radius_px, cv::Scalar(255), cv::FILLED);
    }
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(patch, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    cv::drawContours(patch, outlines, -1, cv::Scalar(255), cv::FILLED);

    cv::Mat image = cv::Mat::zeros(camera.height_px, camera.width_px, CV_8UC1);
    patch.copyTo(image(bounds));
    MaskAndBox out;
    out.mask = obs::RleMask::fromDense(image.data, static_cast<uint32_t>(image.cols),
                                       static_cast<uint32_t>(image.rows), image.step);
    const cv::Rect tight = cv::boundingRect(patch) + bounds.tl();
    out.box = {static_cast<float>(tight.x), static_cast<float>(tight.y),
               static_cast<float>(tight.x + tight.width - 1),
               static_cast<float>(tight.y + tight.height - 1)};
    return out;
}

}  // namespace djpete::observers
