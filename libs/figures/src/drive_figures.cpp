#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "canvas.h"
#include "djpete/geometry/cuboid.h"
#include "object_panels.h"
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
    const auto crop = [&](const cv::Mat& image) { return enlarged(image, part); };
    cv::Mat boxed = frame.image.clone(), projected = frame.image.clone();
    drawBox(boxed, frame.camera, T_cam_obj, row->size_m, cv::Scalar(40, 220, 60), 1);
    texture::RenderOptions options;
    options.onlySeen = true;
    overlay(texture::renderModel(model, frame.camera, T_cam_obj, options), projected);
    const Vec3 sensor_obj = T_cam_obj.inverse().translation();
    const std::string name = "Object " + std::to_string(id);
    std::vector<cv::Mat> panels{
        captioned(pointsPanel(model, sensor_obj, PointColour::Height),
                  name + ": " + std::to_string(model.size()) + " points"),
        captioned(crop(boxed), "Frame " + std::to_string(frame.frame) + " with its box"),
        captioned(crop(projected), "Model projected")};
    if (frame.scan) {
        panels.push_back(captioned(placementPanel(model, row->T_world_obj, row->size_m, frame),
                                   "In the scan of the frame"));
    }
    return {beside(panels), ""};
}

}  // namespace djpete::figures
