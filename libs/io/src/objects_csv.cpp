#include "djpete/io/objects_csv.h"

#include <cmath>

#include "text_file.h"

namespace djpete::io {

namespace {

void writeHeader(const map::SlamMap& map, map::FrameId from, TextFile& out) {
    const auto begin = map.frames().lower_bound(from);
    if (begin != map.frames().end()) {
        const map::FrameId first = begin->first;
        const Eigen::Matrix4d T_world_firstcam = map.cameraAt(first)->matrix();
        out.text("# T_world_firstcam");
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 4; ++c) out.number(T_world_firstcam(r, c), ' ');
        }
        out.text("\n# first_frame " + std::to_string(first.value - from.value) + "\n");
    }
    out.text(
        "object_id,class,frame,time_s,x,y,z,qx,qy,qz,qw,length,width,height,vx,vy,vz,"
        "sigma_x,sigma_y,sigma_z,sigma_yaw,observations,moving\n");
}

void writeRow(const map::SlamMap& map, const map::ObjectTrack& object,
              const map::ObjectState& state, map::FrameId from, TextFile& out) {
    const geometry::SE3 T_world_obj = map.T_world_obj(state).normalised();
    out.text(std::to_string(object.id.value) + "," + obs::toString(object.objectClass) + "," +
             std::to_string(state.frame.value - from.value) + ",");
    const auto frame = map.frames().find(state.frame);
    if (frame != map.frames().end()) out.seconds(frame->second.stamp);
    for (double v : poseNumbers(T_world_obj)) out.number(v, ',');
    for (int i = 0; i < 3; ++i) out.number(object.size_m[i], ',');
    const geometry::Vec3 velocity_world = T_world_obj.rotation() * state.twist.head<3>();
    for (int i = 0; i < 3; ++i) out.number(velocity_world[i], ',');
    for (int i : {0, 1, 2, 5}) out.number(std::sqrt(state.covariance(i, i)), ',');
    out.text("," + std::to_string(object.observations.size()) + (object.moving ? ",1\n" : ",0\n"));
}

}  // namespace

void writeObjectsCsv(const map::SlamMap& map, const std::string& file, map::FrameId from) {
    TextFile out(file);
    writeHeader(map, from, out);
    for (const auto& [id, object] : map.objects()) {
        for (auto s = object.states.lower_bound(from); s != object.states.end(); ++s) {
            writeRow(map, object, s->second, from, out);
        }
    }
    out.close();
}

}  // namespace djpete::io
