/// A small map with everything that the writers write, and its textured objects.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/map/slam_map.h"
#include "djpete/texture/object_model.h"

namespace djpete_test {

using namespace djpete;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

constexpr double kStart_s = 1317617735.25;

inline SE3 cameraPose(double x) {
    return SE3::fromYaw(0.02 * x, {x, 0.1 * x, 0.01 * x}) * SE3::fromYaw(0, {0.3, 0.1, -0.1}) *
           geometry::opticalToVehicleAxes();
}

inline map::ObjectObservation detection(uint64_t frame, const SE3& T_cam_obj) {
    map::ObjectObservation out;
    out.frame = map::FrameId{frame};
    out.T_cam_obj = T_cam_obj;
    out.information = obs::diagonalInformation({0.3, 0.2, 0.1}, {0.01, 0.02, 0.05});
    out.size_m = Vec3(4, 1.8, 1.5);
    return out;
}

/// Frames 3..7, keyframes at 3, 5, 7 one metre apart per frame; object 0 parked, object 1 driving.
inline map::SlamMap smallMap() {
    map::SlamMap m;
    const auto stamp = [](uint64_t frame) {
        return mrpt::Clock::fromDouble(kStart_s + 0.1 * static_cast<double>(frame - 3));
    };
    for (uint64_t frame = 3; frame <= 7; ++frame) {
        const double x = static_cast<double>(frame - 3);
        if (frame % 2 == 1) {
            map::Keyframe kf;
            kf.frame = map::FrameId{frame};
            kf.stamp = stamp(frame);
            kf.camera = {718.856, 718.856, 607.2, 185.2, 0.537, 1241, 376};
            kf.T_vehicle_cam = SE3::fromYaw(0, {0.3, 0.1, -0.1}) * geometry::opticalToVehicleAxes();
            kf.T_odom_cam = kf.T_world_cam = cameraPose(x);
            m.addKeyframe(kf, true);
        } else {
            m.addFrame({map::FrameId{frame}, stamp(frame), m.lastKeyframe()->id,
                        cameraPose(x - 1).inverse() * cameraPose(x), true});
        }
    }
    m.addLandmark(Vec3(10, 3, 1), {200, 100, 50});
    m.addLandmark(Vec3(12, -3, 0.5), {20, 10, 250});
    const SE3 T_world_parked = SE3::fromYaw(0.3, {12.123456789012, -4, -0.8});
    map::ObjectTrack parked;
    parked.size_m = Vec3(4.1, 1.75, 1.52);
    map::ObjectTrack driving;
    driving.objectClass = obs::ObjectClass::Van;
    driving.moving = true;
    driving.size_m = Vec3(5, 2, 2);
    for (uint64_t frame : {3U, 4U, 5U, 7U}) {
        const double x = static_cast<double>(frame - 3);
        const SE3 T_world_cam = cameraPose(x);
        const map::KeyframeId anchor = m.frames().at(map::FrameId{frame}).reference;
        const SE3 T_anchor_world = m.keyframes().at(anchor).T_world_cam.inverse();
        map::ObjectState state;
        state.frame = map::FrameId{frame};
        state.anchor = anchor;
        state.T_anchor_obj = T_anchor_world * T_world_parked;
        state.covariance.diagonal() << 0.01, 0.04, 0.09, 1, 1, 0.0025;
        parked.states[state.frame] = state;
        parked.observations[state.frame] = detection(frame, T_world_cam.inverse() * T_world_parked);
        const SE3 T_world_driving = SE3::fromYaw(M_PI / 2, {15 - x, 3, 0});
        state.T_anchor_obj = T_anchor_world * T_world_driving;
        state.twist << 10, 1, 0, 0, 0, 0;
        driving.states[state.frame] = state;
        driving.observations[state.frame] =
            detection(frame, T_world_cam.inverse() * T_world_driving);
    }
    m.addObject(parked);
    m.addObject(driving);
    m.check();
    return m;
}

/// A red sheet with one point that nobody saw.
inline texture::ObjectModel redModel(uint64_t id) {
    texture::ObjectModel model;
    model.id = map::ObjectId{id};
    model.size_m = Vec3(4.1, 1.75, 1.52);
    model.cloud = mrpt::maps::CColouredPointsMap::Create();
    for (int i = 0; i < 400; ++i) {
        const bool seen = i != 0;
        const float grey = texture::ObjectModel::kNeutralGrey;
        model.cloud->insertPointRGB(-2 + 0.2F * static_cast<float>(i / 20), -0.8F,
                                    -0.7F + 0.07F * static_cast<float>(i % 20), seen ? 1.0F : grey,
                                    seen ? 0.2F : grey, seen ? 0.0F : grey);
        model.colours.emplace_back();
        if (seen) {
            model.colours.back().add({250, 51, 0}, 1);
            model.colours.back().add({260, 51, 0}, 1);
        }
        model.normals.push_back({0, -1, 0});
        model.radius_m.push_back(0.1F);
    }
    return model;
}

/// A folder of its own that goes away again.
class TestFolder {
  public:
    TestFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "djpete_io_XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~TestFolder() { std::filesystem::remove_all(path_); }
    std::string operator/(const std::string& file) const { return path_ + "/" + file; }

  private:
    std::string path_;
};

inline std::vector<std::string> linesOf(const std::string& file) {
    std::ifstream in(file);
    std::vector<std::string> out;
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

inline std::vector<double> numbersOf(const std::string& line) {
    std::istringstream in(line);
    std::vector<double> out;
    for (double v = 0; in >> v;) out.push_back(v);
    return out;
}

inline std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> out;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
    return out;
}

}  // namespace djpete_test
