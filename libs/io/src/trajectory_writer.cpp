#include "djpete/io/trajectory_writer.h"

#include <cstdio>

#include "text_file.h"

namespace djpete::io {

namespace {

/// Calls f(frame pose, T_firstcam_cam) for every frame from `from` on, in order.
template <class F>
void forEachFrame(const map::SlamMap& map, map::FrameId from, F f) {
    geometry::SE3 T_firstcam_world;
    bool first = true;
    for (auto it = map.frames().lower_bound(from); it != map.frames().end(); ++it) {
        const auto& [id, pose] = *it;
        const geometry::SE3 T_world_cam = *map.cameraAt(id);
        if (first) T_firstcam_world = T_world_cam.inverse();
        first = false;
        f(pose, (T_firstcam_world * T_world_cam).normalised());
    }
}

}  // namespace

void writeTrajectoryTum(const map::SlamMap& map, const std::string& file, map::FrameId from) {
    TextFile out(file);
    forEachFrame(map, from, [&](const map::FramePose& pose, const geometry::SE3& T_firstcam_cam) {
        out.seconds(pose.stamp);
        for (double v : poseNumbers(T_firstcam_cam)) out.number(v, ' ');
        out.text("\n");
    });
    out.close();
}

void writeTrajectoryKitti(const map::SlamMap& map, const std::string& file, map::FrameId from) {
    TextFile out(file);
    forEachFrame(map, from, [&](const map::FramePose&, const geometry::SE3& T_firstcam_cam) {
        const Eigen::Matrix4d T = T_firstcam_cam.matrix();
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 4; ++c) out.number(T(r, c), r + c == 0 ? '\0' : ' ');
        }
        out.text("\n");
    });
    out.close();
}

}  // namespace djpete::io
