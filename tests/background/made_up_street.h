/// A street with a wall, a parked car and a car that drives by, seen by a driving vehicle.
#pragma once

#include "../texture/box_world.h"
#include "djpete/background/octo_background.h"

namespace djpete_test {

namespace background = djpete::background;
namespace map = djpete::map;
using djpete::obs::FrameId;
using djpete::texture::ObjectInView;
using djpete::texture::TextureView;

const Rgb kRoad{90, 90, 90}, kWall{200, 120, 40}, kParked{20, 30, 230}, kMover{20, 200, 30};
const Vec3 kCarSize(4, 1.8, 1.5);

/// Frame f is f seconds into the drive; the vehicle drives 1 m, the other car 2.5 m per frame.
struct Street {
    static SE3 T_world_vehicle(int f) { return SE3::fromYaw(0, {1.0 * f, 0, 1.7}); }
    static SE3 T_world_mover(int f) { return SE3::fromYaw(M_PI, {30 - 2.5 * f, 3, 0.78}); }
    static SE3 T_world_parked() { return SE3::fromYaw(0.1, {14, -4, 0.78}); }

    /// The wall is speckled if `speckle_m` is above 0, so that stereo can see it.
    static BoxWorld at(int f, bool withMover = true, double speckle_m = 0) {
        BoxWorld world;
        world.ground = kRoad;
        world.boxes.push_back(
            {SE3::fromYaw(0, {20, 8.1, 3}), Vec3(60, 2, 6), allFaces(kWall), speckle_m});
        world.boxes.push_back({T_world_parked(), kCarSize, allFaces(kParked), 0});
        // The street ends: rays without a return carve nothing.
        world.boxes.push_back({SE3::fromYaw(0, {56, 0, 5}), Vec3(2, 60, 10), allFaces(kWall), 0});
        if (withMover) world.boxes.push_back({T_world_mover(f), kCarSize, allFaces(kMover), 0});
        return world;
    }

    static StereoCamera camera() {
        StereoCamera c;
        c.fx = c.fy = 160;
        c.cx = 159.5;
        c.cy = 59.5;
        c.width_px = 320;
        c.height_px = 120;
        return c;
    }

    static TextureView view(int f, bool withBoxes, bool withMover = true) {
        const BoxWorld world = at(f, withMover);
        TextureView out;
        out.frame = FrameId{static_cast<uint64_t>(f)};
        out.T_world_vehicle = T_world_vehicle(f);
        out.T_world_cam = out.T_world_vehicle * T_vehicle_cam();
        out.images.camera.model = camera();
        out.images.camera.T_vehicle_cam = T_vehicle_cam();
        out.images.left = world.image(camera(), out.T_world_cam);
        out.scan = world.scan(out.T_world_vehicle, 0.4);
        if (!withBoxes) return out;
        out.objects.push_back({map::ObjectId{0}, {}, kCarSize, T_world_parked(), {}});
        if (withMover) {
            out.objects.push_back({map::ObjectId{1}, {}, kCarSize, T_world_mover(f), {}});
        }
        return out;
    }

    static SE3 T_vehicle_cam() {
        djpete::geometry::Mat3 axes;  // columns: right, down, ahead
        axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
        return SE3(axes, Vec3(0.2, 0, -0.1));
    }
};

/// Keyframes 0 .. count-1 at `correction` * where the street's vehicle was; without objects.
inline map::SlamMap streetMap(int count, const SE3& correction = SE3()) {
    map::SlamMap out;
    for (int f = 0; f < count; ++f) {
        map::Keyframe keyframe;
        keyframe.frame = FrameId{static_cast<uint64_t>(f)};
        keyframe.camera = Street::camera();
        keyframe.T_vehicle_cam = Street::T_vehicle_cam();
        keyframe.T_world_cam = correction * Street::T_world_vehicle(f) * Street::T_vehicle_cam();
        out.addKeyframe(keyframe, true);
    }
    return out;
}

/// Adds an object with one state per keyframe at `T_world_obj(f)`.
template <class Pose>
void addTrack(map::SlamMap& map, uint64_t id, bool moving, Pose T_world_obj) {
    map::ObjectTrack track;
    track.id = map::ObjectId{id};
    track.size_m = kCarSize;
    track.moving = moving;
    for (const auto& [kf, keyframe] : map.keyframes()) {
        map::ObjectObservation seen;
        seen.frame = keyframe.frame;
        seen.size_m = kCarSize;
        seen.information.setIdentity();
        const SE3 T_cam_obj =
            keyframe.T_world_cam.inverse() * T_world_obj(static_cast<int>(keyframe.frame.value));
        seen.T_cam_obj = T_cam_obj;
        map::ObjectState state;
        state.frame = keyframe.frame;
        state.anchor = kf;
        state.T_anchor_obj = T_cam_obj;
        track.observations[keyframe.frame] = seen;
        track.states[keyframe.frame] = state;
    }
    map.addObject(std::move(track));
}

/// Occupied voxels whose centre lies in the box, above `clearance_m` over its bottom.
inline std::size_t occupiedIn(const background::OctoBackground& tree, const SE3& T_world_box,
                              const Vec3& size_m, double clearance_m = 0.2) {
    std::size_t count = 0;
    for (const auto& p : tree.points(true)) {
        const Vec3 p_box = T_world_box.inverse() * Vec3(p.x, p.y, p.z);
        if ((p_box.cwiseAbs() - 0.5 * size_m).maxCoeff() > 0) continue;
        count += p_box.z() > -0.5 * size_m.z() + clearance_m ? 1U : 0U;
    }
    return count;
}

}  // namespace djpete_test
