/// A map as a list of numbers, to compare runs bit for bit.
#pragma once

#include <cstring>
#include <vector>

#include "djpete/map/slam_map.h"

namespace djpete_test {

inline void append(std::vector<double>& out, const djpete::geometry::SE3& T) {
    const Eigen::Matrix4d m = T.matrix();
    out.insert(out.end(), m.data(), m.data() + 16);
}

/// Every camera of the map.
inline std::vector<double> cameraNumbers(const djpete::map::SlamMap& map) {
    std::vector<double> out;
    for (const auto& [frame, pose] : map.frames()) {
        out.push_back(static_cast<double>(frame.value));
        append(out, *map.cameraAt(frame));
    }
    return out;
}

/// Everything that was estimated.
inline std::vector<double> mapNumbers(const djpete::map::SlamMap& map) {
    std::vector<double> out = cameraNumbers(map);
    for (const auto& [id, l] : map.landmarks()) {
        out.insert(out.end(), {static_cast<double>(id.value), l.p_world.x(), l.p_world.y(),
                               l.p_world.z(), static_cast<double>(l.observations.size())});
    }
    for (const auto& [id, o] : map.objects()) {
        out.insert(out.end(), {static_cast<double>(id.value), o.size_m.x(), o.size_m.y(),
                               o.size_m.z(), o.moving ? 1.0 : 0.0});
        for (const auto& [frame, s] : o.states) {
            out.push_back(static_cast<double>(frame.value));
            append(out, map.T_world_obj(s));
            out.insert(out.end(), s.twist.data(), s.twist.data() + 6);
            out.insert(out.end(), s.covariance.data(), s.covariance.data() + 36);
        }
    }
    return out;
}

inline bool sameBytes(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), 8 * a.size()) == 0;
}

}  // namespace djpete_test
