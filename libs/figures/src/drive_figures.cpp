#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "canvas.h"
#include "djpete/geometry/cuboid.h"
#include "djpete/texture/render_model.h"
#include "parts.h"

namespace djpete::figures {

namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

constexpr double kInView_m = 40, kNear_m = 3;

/// Of a point at least kNear_m ahead of the main camera, within a half angle of `deg`.
bool wellInView(const Vec3& p_cam, double deg) {
    return p_cam.z() > kNear_m && p_cam.norm() < kInView_m &&
           std::abs(std::atan2(p_cam.x(), p_cam.z())) < deg * M_PI / 180;
}

/// Draws `model` over `on`, as if it stood there.
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

/// The part of an image around a box, with some border.
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

/// A camera that sees the object from the side that the sensor saw, a little from above.
VirtualCamera objectCamera(const Vec3& sensor_obj, const Vec3& size_m, int width_px,
                           int height_px) {
    Vec3 level(sensor_obj.x(), sensor_obj.y(), 0);
    level = level.norm() > 1e-6 ? Vec3(level.normalized()) : Vec3(1, 0, 0);
    const double distance = 2.1 * size_m.head<2>().norm();
    const Vec3 eye = distance * level + Vec3(0, 0, 0.35 * distance);
    return lookingAt(eye, Vec3(0, 0, -0.05), 21, width_px, height_px);
}

cv::Mat pointsPanel(const texture::ObjectModel& model, const Vec3& sensor_obj, int width_px,
                    int height_px) {
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
        const double height = std::clamp(0.5 + double(p[2]) / model.size_m.z(), 0.0, 1.0);
        cv::circle(out, cv::Point(int(std::lround(uv.x())), int(std::lround(uv.y()))), 1,
                   cv::Scalar(200 - 160 * height, 90 + 40 * height, 30 + 190 * height), cv::FILLED);
    }
    drawBox(out, view.model, view.T_cam_base, model.size_m, cv::Scalar(60, 60, 60), 1);
    return out;
}

/// The scan around the object in grey, its model in colour, its box.
cv::Mat placementPanel(const texture::ObjectModel& model, const SE3& T_world_obj,
                       const Vec3& size_m, const ShownFrame& frame, int width_px, int height_px) {
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

/// Writes id and speed over an object, higher up where others are in the way. Returns its place.
cv::Rect label(cv::Mat& on, const ShownFrame& frame, const evaluation::ObjectRow& row,
               const std::vector<cv::Rect>& taken) {
    const SE3 T_cam_obj = frame.T_world_cam.inverse() * row.T_world_obj;
    const Vec2 top = frame.camera.project(T_cam_obj * Vec3(0, 0, 0.5 * row.size_m.z()));
    std::string what = std::to_string(row.objectId);
    if (row.moving) {
        char speed[32];
        std::snprintf(speed, sizeof(speed), " %.0f km/h", 3.6 * row.velocity_world.norm());
        what += speed;
    }
    const cv::Size size = cv::getTextSize(what, cv::FONT_HERSHEY_SIMPLEX, 0.5, 1, nullptr);
    cv::Rect place(int(top.x()) - size.width / 2 - 3, int(top.y()) - size.height - 10,
                   size.width + 6, size.height + 6);
    place.x = std::clamp(place.x, 0, std::max(0, on.cols - place.width));
    place.y = std::max(0, place.y);
    const auto busy = [&] {
        return std::any_of(taken.begin(), taken.end(),
                           [&](const cv::Rect& other) { return (other & place).area() > 0; });
    };
    while (place.y > 0 && busy()) --place.y;
    if (place.y + place.height < int(top.y()) - 14) {
        cv::line(on, cv::Point(place.x + place.width / 2, place.y + place.height),
                 cv::Point(int(top.x()), int(top.y())), colourOf(row.objectId), 1, cv::LINE_AA);
    }
    cv::rectangle(on, place, cv::Scalar::all(20), cv::FILLED);
    text(on, what, {place.x + 3, place.y + place.height - 4}, colourOf(row.objectId));
    return place;
}

}  // namespace

const evaluation::ObjectRow* rowOf(const RunResult& result, int64_t object, std::size_t frame) {
    for (const auto& row : result.objects.rows) {
        if (row.objectId == object && row.frame == frame) return &row;
    }
    return nullptr;
}

std::optional<std::size_t> busiestFrame(const RunResult& result) {
    std::map<std::size_t, int> count;
    for (const auto& row : result.objects.rows) {
        const Vec3 p_cam = result.cameras.at(row.frame).inverse() * row.T_world_obj.translation();
        if (wellInView(p_cam, 35)) ++count[row.frame];
    }
    std::optional<std::size_t> best;
    for (const auto& [frame, objects] : count) {
        if (!best || objects > count.at(*best)) best = frame;
    }
    return best;
}

Figure perceptionFigure(const RunResult& result, const ShownFrame& frame) {
    cv::Mat on = frame.image.clone();
    // Far ones first; a label gives way to those of nearer objects.
    std::vector<std::pair<double, const evaluation::ObjectRow*>> order;
    for (const auto& row : result.objects.rows) {
        if (row.frame != frame.frame) continue;
        const Vec3 p_cam = frame.T_world_cam.inverse() * row.T_world_obj.translation();
        if (p_cam.z() > 1 && frame.camera.contains(frame.camera.project(p_cam))) {
            order.emplace_back(p_cam.z(), &row);
        }
    }
    std::sort(order.begin(), order.end());
    for (auto it = order.rbegin(); it != order.rend(); ++it) {
        const auto& row = *it->second;
        drawBox(on, frame.camera, frame.T_world_cam.inverse() * row.T_world_obj, row.size_m,
                colourOf(row.objectId));
    }
    std::vector<cv::Rect> taken;
    for (const auto& [depth, row] : order) {
        taken.push_back(label(on, frame, *row, taken));
    }
    return {
        captioned(on, "Frame " + std::to_string(frame.frame) + ": " + std::to_string(order.size()) +
                          " objects of the map in view; the crossed face is the front"),
        ""};
}

std::optional<std::size_t> bestFrameOf(int64_t object, const RunResult& result) {
    std::optional<std::size_t> best;
    double bestScore = 0;
    for (const auto& row : result.objects.rows) {
        if (row.objectId != object) continue;
        const Vec3 p_cam = result.cameras.at(row.frame).inverse() * row.T_world_obj.translation();
        if (p_cam.z() < 1) continue;
        // The nearest view in which all of it is in the image.
        const SE3 T_cam_obj = result.cameras.at(row.frame).inverse() * row.T_world_obj;
        bool whole = true;
        for (const auto& corner : geometry::Cuboid{row.size_m}.corners()) {
            whole = whole && wellInView(T_cam_obj * corner, 36);
        }
        const double score = (whole ? 10 : 1) / p_cam.norm();
        if (score > bestScore) {
            bestScore = score;
            best = row.frame;
        }
    }
    return best;
}

Figure objectFigure(const texture::ObjectModel& model, const RunResult& result,
                    const ShownFrame& frame) {
    const auto id = static_cast<int64_t>(model.id.value);
    const auto* row = rowOf(result, id, frame.frame);
    if (!row) return {{}, "the object is not in frame " + std::to_string(frame.frame)};
    const SE3 T_cam_obj = frame.T_world_cam.inverse() * row->T_world_obj;
    const cv::Rect part = around(frame.camera, T_cam_obj, row->size_m, frame.image.size());
    if (part.width < 8 || part.height < 8) return {{}, "the object is not in the image"};
    constexpr int kHeight_px = 340, kWidth_px = 460;
    const double scale = double(kHeight_px) / part.height;
    const auto crop = [&](const cv::Mat& image) {
        cv::Mat out;
        cv::resize(image(part), out, cv::Size(int(part.width * scale), kHeight_px), 0, 0,
                   cv::INTER_CUBIC);
        return out;
    };
    cv::Mat boxed = frame.image.clone(), projected = frame.image.clone();
    drawBox(boxed, frame.camera, T_cam_obj, row->size_m, cv::Scalar(40, 220, 60), 1);
    texture::RenderOptions options;
    options.onlySeen = true;
    overlay(texture::renderModel(model, frame.camera, T_cam_obj, options), projected);
    const Vec3 sensor_obj = T_cam_obj.inverse().translation();
    const std::string name = "Object " + std::to_string(id);
    std::vector<cv::Mat> panels{
        captioned(pointsPanel(model, sensor_obj, kWidth_px, kHeight_px),
                  name + ": " + std::to_string(model.size()) + " points"),
        captioned(crop(boxed), "Frame " + std::to_string(frame.frame) + " with its box"),
        captioned(crop(projected), "Model projected")};
    if (frame.scan) {
        panels.push_back(captioned(
            placementPanel(model, row->T_world_obj, row->size_m, frame, kWidth_px, kHeight_px),
            "In the scan of the frame"));
    }
    return {beside(panels), ""};
}

}  // namespace djpete::figures
