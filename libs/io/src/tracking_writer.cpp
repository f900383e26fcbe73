#include "djpete/io/tracking_writer.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "djpete/geometry/cuboid.h"
#include "djpete/map/object_rules.h"
#include "text_file.h"

namespace djpete::io {

namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

constexpr double kNearest_m = 0.5;

/// The box's projection, not cut to the image; nothing if no corner is in front of the camera.
std::optional<obs::ImageBox> projection(const geometry::StereoCamera& camera, const SE3& T_cam_obj,
                                        const Vec3& size_m) {
    std::optional<obs::ImageBox> out;
    for (const Vec3& corner : geometry::Cuboid{size_m}.corners()) {
        Vec3 p_cam = T_cam_obj * corner;
        if (p_cam.z() < kNearest_m) continue;
        const Eigen::Vector2f uv = camera.project(p_cam).cast<float>();
        if (!out) out = obs::ImageBox{uv.x(), uv.y(), uv.x(), uv.y()};
        out->left = std::min(out->left, uv.x());
        out->top = std::min(out->top, uv.y());
        out->right = std::max(out->right, uv.x());
        out->bottom = std::max(out->bottom, uv.y());
    }
    return out;
}

obs::ImageBox cutTo(const geometry::StereoCamera& camera, const obs::ImageBox& box) {
    const auto width = static_cast<float>(camera.width_px - 1);
    const auto height = static_cast<float>(camera.height_px - 1);
    return {std::clamp(box.left, 0.F, width), std::clamp(box.top, 0.F, height),
            std::clamp(box.right, 0.F, width), std::clamp(box.bottom, 0.F, height)};
}

struct Row {
    uint64_t frame = 0;
    const map::ObjectTrack* object = nullptr;
    double score = 0;
};

/// KITTI's rotation_y: about the camera's y axis (down), 0 along its x axis.
double rotationY(const SE3& T_cam_obj) {
    const Vec3 forward_cam = T_cam_obj.rotation().col(0);
    return std::atan2(-forward_cam.z(), forward_cam.x());
}

void writeRow(TextFile& out, const Row& row, const geometry::StereoCamera& camera,
              const SE3& T_cam_obj, const std::optional<obs::ImageBox>& seen) {
    const auto whole = projection(camera, T_cam_obj, row.object->size_m);
    if (!whole || T_cam_obj.translation().z() < kNearest_m) return;
    const obs::ImageBox cut = cutTo(camera, *whole);
    if (!seen && cut.area() <= 0) return;
    const obs::ImageBox box = seen ? *seen : cut;
    const double truncated =
        whole->area() > 0 ? 1 - static_cast<double>(cut.area() / whole->area()) : 1;
    const Vec3& centre = T_cam_obj.translation();
    // The bottom face's centre; boxes of KITTI stand upright in the camera.
    const Vec3 bottom = centre + Vec3(0, 0.5 * row.object->size_m.z(), 0);
    const double ry = rotationY(T_cam_obj);
    const double alpha = geometry::wrapAngle(ry - std::atan2(centre.x(), centre.z()));
    out.text(std::to_string(row.frame) + " " + std::to_string(row.object->id.value) + " " +
             obs::toString(row.object->objectClass));
    out.number(truncated, ' ');
    out.text(" -1");
    out.number(alpha, ' ');
    for (float v : {box.left, box.top, box.right, box.bottom}) {
        out.number(static_cast<double>(v), ' ');
    }
    for (int i : {2, 1, 0}) out.number(row.object->size_m[i], ' ');
    for (int i = 0; i < 3; ++i) out.number(bottom[i], ' ');
    out.number(ry, ' ');
    out.number(row.score, ' ');
    out.text("\n");
}

/// Relative to the camera of `frame`: as seen there, or as the nearest views before and after it
/// say, if the object stands. Nothing if no view says more than the map.
std::optional<SE3> seenFrom(const map::SlamMap& map, const map::ObjectTrack& object,
                            map::FrameId frame) {
    if (object.moving || object.views.empty()) return std::nullopt;
    const auto after = object.views.lower_bound(frame);
    const auto a = after == object.views.begin() ? after : std::prev(after);
    const auto b = after == object.views.end() ? a : after;
    const SE3 T_world_a = *map.cameraAt(a->first) * a->second;
    const SE3 T_world_b = *map.cameraAt(b->first) * b->second;
    double share = 0;
    if (a != b && frame > a->first) {
        share = static_cast<double>(frame.value - a->first.value) /
                static_cast<double>(b->first.value - a->first.value);
    }
    share = std::min(share, 1.0);
    const SE3 T_world_obj = T_world_a * SE3::exp(share * (T_world_a.inverse() * T_world_b).log());
    return map.cameraAt(frame)->inverse() * T_world_obj;
}

/// Where a moving object was before its first state or will be after its last, by its twist.
SE3 goneOn(const map::SlamMap& map, const map::ObjectTrack& object, const map::FramePose& now) {
    const auto& state = now.frame < object.states.begin()->first ? object.states.begin()->second
                                                                 : object.states.rbegin()->second;
    const auto& then = map.frames().at(state.frame);
    const double dt = std::chrono::duration<double>(now.stamp - then.stamp).count();
    return map.T_world_obj(state) * SE3::exp(dt * state.twist);
}

bool inLongGap(const map::ObjectTrack& object, map::FrameId frame, unsigned maxGap) {
    const auto after = object.states.lower_bound(frame);
    if (after == object.states.begin() || after == object.states.end()) return false;
    if (after->first == frame) return false;
    return after->first.value - std::prev(after)->first.value > maxGap + 1;
}

}  // namespace

void writeTracking(const map::SlamMap& map, const std::string& file, map::FrameId first,
                   const TrackingOptions& options) {
    TextFile out(file);
    std::map<map::FrameId, std::vector<const map::ObjectTrack*>> objectsAt;
    for (const auto& [id, object] : map.objects()) {
        if (object.states.empty()) continue;
        auto from = map.frames().find(object.states.begin()->first);
        auto to = map.frames().find(object.states.rbegin()->first);
        for (unsigned i = 0; i < options.before && from != map.frames().begin(); ++i) --from;
        for (unsigned i = 0; i < options.after && std::next(to) != map.frames().end(); ++i) ++to;
        for (auto f = from; f != std::next(to); ++f) {
            if (!inLongGap(object, f->first, options.maxGap))
                objectsAt[f->first].push_back(&object);
        }
    }
    for (const auto& [frame, objects] : objectsAt) {
        if (frame < first) continue;
        const auto& pose = map.frames().at(frame);
        const auto& camera = map.keyframes().at(pose.reference).camera;
        const SE3 T_cam_world = map.cameraAt(frame)->inverse();
        for (const auto* object : objects) {
            const auto known = map.objectPoseAt(object->id, frame);
            const SE3 T_world_obj = known ? *known : goneOn(map, *object, pose);
            const auto view = seenFrom(map, *object, frame);
            const auto seen = object->observations.find(frame);
            writeRow(out, {frame.value - first.value, object, map::objectScore(*object)}, camera,
                     view ? *view : T_cam_world * T_world_obj,
                     seen == object->observations.end() ? std::nullopt : seen->second.box);
        }
    }
    out.close();
}

}  // namespace djpete::io
