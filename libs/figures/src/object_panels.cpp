#include "object_panels.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "canvas.h"
#include "djpete/geometry/cuboid.h"

namespace djpete::figures {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

namespace {

/// A camera that sees the object from the side that the sensor saw, a little from above.
VirtualCamera objectCamera(const Vec3& sensor_obj, const Vec3& size_m, int width_px,
                           int height_px) {
    Vec3 level(sensor_obj.x(), sensor_obj.y(), 0);
    level = level.norm() > 1e-6 ? Vec3(level.normalized()) : Vec3(1, 0, 0);
    const double distance = 2.1 * size_m.head<2>().norm();
    const Vec3 eye = distance * level + Vec3(0, 0, 0.35 * distance);
    return lookingAt(eye, Vec3(0, 0, -0.05), 21, width_px, height_px);
}

cv::Scalar colourByHeight(double z_obj, double height_m) {
    const double height = std::clamp(0.5 + z_obj / height_m, 0.0, 1.0);
    return {200 - 160 * height, 90 + 40 * height, 30 + 190 * height};
}

cv::Scalar ownColour(const texture::ObjectModel& model, std::size_t i) {
    float r = 0, g = 0, b = 0;
    model.cloud->getPointColor(i, r, g, b);
    return {255.0 * double(b), 255.0 * double(g), 255.0 * double(r)};
}

}  // namespace

void overlay(const texture::RenderedModel& render, cv::Mat& on) {
    for (int v = 0; v < render.height_px; ++v) {
        for (int u = 0; u < render.width_px; ++u) {
            const auto pixel =
                static_cast<std::size_t>(v) * static_cast<std::size_t>(render.width_px) +
                static_cast<std::size_t>(u);
            if (!render.covered(pixel)) continue;
            const auto& c = render.rgb[pixel];
            on.at<cv::Vec3b>(v, u) = cv::Vec3b(c[2], c[1], c[0]);
        }
    }
}

cv::Rect around(const geometry::StereoCamera& camera, const SE3& T_cam_obj, const Vec3& size_m,
                const cv::Size& image) {
    Vec2 low(1e9, 1e9), high(-1e9, -1e9);
    for (const auto& corner : geometry::Cuboid{size_m}.corners()) {
        const Vec3 p = T_cam_obj * corner;
        if (p.z() < 0.5) continue;
        const Vec2 uv = camera.project(p);
        low = low.cwiseMin(uv);
        high = high.cwiseMax(uv);
    }
    const double border = 0.15 * (high - low).maxCoeff();
    const cv::Rect wanted(cv::Point(int(low.x() - border), int(low.y() - border)),
                          cv::Point(int(high.x() + border) + 1, int(high.y() + border) + 1));
    return wanted & cv::Rect(cv::Point(0, 0), image);
}

cv::Mat enlarged(const cv::Mat& image, const cv::Rect& part) {
    const double scale = double(kPanelHeight_px) / part.height;
    cv::Mat out;
    cv::resize(image(part), out, cv::Size(int(part.width * scale), kPanelHeight_px), 0, 0,
               cv::INTER_CUBIC);
    return out;
}

cv::Mat pointsPanel(const texture::ObjectModel& model, const Vec3& sensor_obj, PointColour colour) {
    constexpr int width_px = kPanelWidth_px, height_px = kPanelHeight_px;
    const auto view = objectCamera(sensor_obj, model.size_m, width_px, height_px);
    cv::Mat out(height_px, width_px, CV_8UC3, cv::Scalar::all(255));
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const auto p = model.point(i);
        order.emplace_back(-(view.T_cam_base * Vec3(p[0], p[1], p[2])).z(), i);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [minusDepth, i] : order) {
        const auto p = model.point(i);
        const Vec2 uv = view.model.project(view.T_cam_base * Vec3(p[0], p[1], p[2]));
        cv::circle(out, cv::Point(int(std::lround(uv.x())), int(std::lround(uv.y()))), 1,
                   colour == PointColour::Height ? colourByHeight(p[2], model.size_m.z())
                                                 : ownColour(model, i),
                   cv::FILLED);
    }
    drawBox(out, view.model, view.T_cam_base, model.size_m, cv::Scalar(60, 60, 60), 1);
    return out;
}

cv::Mat placementPanel(const texture::ObjectModel& model, const SE3& T_world_obj,
                       const Vec3& size_m, const ShownFrame& frame) {
    constexpr int width_px = kPanelWidth_px, height_px = kPanelHeight_px;
    const Vec3 sensor = frame.T_world_vehicle.translation(), at = T_world_obj.translation();
    Vec3 level = at - sensor;
    level.z() = 0;
    level.normalize();
    const Vec3 side(-level.y(), level.x(), 0);
    const Vec3 eye = at - 12 * level + 5 * side + Vec3(0, 0, 7);
    const auto view = lookingAt(eye, at, 34, width_px, height_px);
    cv::Mat out(height_px, width_px, CV_8UC3, cv::Scalar::all(255));
    const SE3 T_view_velo = view.T_cam_base * frame.T_world_vehicle * frame.scan->T_vehicle_velo;
    for (const auto& point : frame.scan->points) {
        const Vec3 p = T_view_velo * point.position();
        if (p.z() < 1) continue;
        const Vec2 uv = view.model.project(p);
        if (!view.model.contains(uv, 1)) continue;
        cv::circle(out, cv::Point(int(std::lround(uv.x())), int(std::lround(uv.y()))), 1,
                   cv::Scalar::all(std::clamp(90 + 2.5 * p.z(), 90.0, 200.0)), cv::FILLED);
    }
    texture::RenderOptions options;
    options.onlySeen = true;
    overlay(texture::renderModel(model, view.model, view.T_cam_base * T_world_obj, options), out);
    drawBox(out, view.model, view.T_cam_base * T_world_obj, size_m, cv::Scalar(40, 40, 230), 2);
    return out;
}

}  // namespace djpete::figures
