/// A made-up map with every kind of entity and every optional part, for the map file's tests.
#pragma once

#include <random>

#include "djpete/map/map_file.h"

namespace djpete::map {

struct WorldSize {
    uint64_t keyframes = 4, framesBetween = 2, features = 12, landmarks = 20, objects = 3;
    uint64_t statesPerObject = 5;
};

class MadeUpMap {
  public:
    explicit MadeUpMap(const WorldSize& size) : size_(size) {
        addKeyframes();
        addLandmarks();
        for (uint64_t i = 0; i < size_.objects; ++i) map_.addObject(object(i));
        // Gaps in the ids, as merged objects and culled landmarks leave them.
        if (size_.objects > 1) map_.removeObject({0});
        if (size_.landmarks > 1) map_.removeLandmark({size_.landmarks - 1});
    }
    SlamMap map() const { return map_; }

  private:
    double number() { return double(rng_() >> 11) * 0x1p-53; }
    float real() { return float(number()); }
    geometry::Vec3 vec3() { return {number(), number(), number()}; }
    geometry::SE3 pose() {
        geometry::Vec6 xi;
        xi << vec3(), vec3();
        return geometry::SE3::exp(xi);
    }
    geometry::Mat6 mat6() {
        geometry::Mat6 m;
        for (int i = 0; i < 36; ++i) m(i / 6, i % 6) = number();
        return m;
    }
    static mrpt::Clock::time_point stamp(uint64_t frame) {
        return mrpt::Clock::fromDouble(1.3e9 + 0.1 * double(frame));
    }

    obs::KeyframeFeature feature(uint64_t i) {
        obs::KeyframeFeature f;
        f.track = {rng_()};
        f.u_px = real(), f.v_px = real(), f.sigma_px = real(), f.uRightSigma_px = real();
        f.depthSigma_m = real();
        f.rgb = {uint8_t(i), uint8_t(2 * i), uint8_t(3 * i)};
        if (i % 2 == 0) f.uRight_px = real();
        if (i % 3 == 0) f.depth_m = real();
        if (i % 4 != 3) f.descriptor = obs::Descriptor{rng_(), rng_(), rng_(), rng_()};
        return f;
    }

    void addKeyframes() {
        for (uint64_t k = 0; k < size_.keyframes; ++k) {
            Keyframe kf;
            kf.frame = {k * (size_.framesBetween + 1)};
            kf.stamp = stamp(kf.frame.value);
            kf.camera = {707.1, 707.2, 601.9, 183.1, 0.537, 1226, 370};
            kf.segment = static_cast<uint32_t>(k / 2);
            kf.world = static_cast<uint32_t>(k / 3);
            kf.T_vehicle_cam = pose(), kf.T_odom_cam = pose(), kf.T_world_cam = pose();
            if (k % 2 == 1) kf.scanMotion = obs::ScanMotion{kf.frame, pose(), mat6()};
            for (uint64_t i = 0; i < size_.features; ++i) kf.features.push_back(feature(i));
            const auto id = map_.addKeyframe(kf, k != 1);
            for (uint64_t i = 1; i <= size_.framesBetween; ++i) {
                const FrameId frame{kf.frame.value + i};
                map_.addFrame({frame, stamp(frame.value), id, pose(), i != 2});
            }
        }
    }

    void addLandmarks() {
        for (uint64_t l = 0; l < size_.landmarks; ++l) {
            map_.addLandmark(vec3(), {uint8_t(l), 7, uint8_t(l / 3)});
        }
        for (const auto& [id, kf] : map_.keyframes()) {
            for (uint64_t i = 0; i < size_.features; ++i) {
                const LandmarkId landmark{(id.value * size_.features / 2 + i) % size_.landmarks};
                const auto& seen = map_.landmarks().at(landmark).observations;
                if (i % 5 != 4 && seen.count(id) == 0) map_.observe(landmark, id, uint32_t(i));
            }
        }
    }

    ObjectTrack object(uint64_t i) {
        ObjectTrack track;
        track.objectClass = obs::ObjectClass(i % 7);
        track.size_m = vec3();
        track.moving = i % 2 == 1;
        const uint64_t begin = size_.keyframes > 1 ? i % (size_.keyframes - 1) : 0;
        for (uint64_t n = 0; n < size_.statesPerObject; ++n) {
            const FrameId frame{begin * (size_.framesBetween + 1) + n};
            ObjectObservation o{frame,
                                pose(),
                                mat6(),
                                vec3(),
                                real(),
                                track.objectClass,
                                {},
                                {},
                                {},
                                {},
                                "label " + std::to_string(n)};
            if (n % 2 == 0) o.box = obs::ImageBox{real(), real(), real(), real()};
            if (n % 3 != 1) o.mask = obs::RleMask{1226, 370, std::vector<uint32_t>(80 + n, 5)};
            track.observations[frame] = o;
            if (n == 1) continue;  // observed, no state
            geometry::Vec6 twist;
            twist << vec3(), vec3();
            track.states[frame] = {frame, {begin}, pose(), twist, mat6()};
        }
        return track;
    }

    WorldSize size_;
    std::mt19937_64 rng_{7};
    SlamMap map_;
};

inline MapFileInfo someInfo() {
    return {"drive 00", {"00 morning", "00 evening"}, "1.2.3", {{ObjectId{1}, "tex/car.ply"}}};
}

}  // namespace djpete::map
