/// Windows for local bundle adjustment: of a simulated street, and of a real drive.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "djpete/backend/map_keeper.h"
#include "djpete/frontend/visual_odometry.h"
#include "djpete/obs/rawlog_source.h"
#include "djpete_test/street_problem.h"

namespace djpete_bench {

using djpete::backend::BackboneProblem;

/// `points` points seen by at least one of `free` keyframes, with 15 fixed keyframes before them;
/// 0.5 px of noise, 3 % of the observations anywhere, one in six without a right column. The start
/// is off by 5 cm and 3 mrad per camera and 20 cm per point.
inline BackboneProblem streetWindow(int free, int points, unsigned seed) {
    constexpr int kFixed = 15;
    djpete_test::StreetOptions o;
    o.cameras = free + kFixed;
    o.points = 3 * points;
    o.spacing_m = 1.5;
    o.maxCamerasPerPoint = 12;
    o.sigma_px = 0.5;
    o.outliers = 0.03;
    o.seed = seed;
    const auto world = djpete_test::makeStreet(o);
    djpete_test::StartOptions disturbance;
    disturbance.fixedCameras = kFixed;
    disturbance.camera_rad = 0.003;
    disturbance.point_m = 0.2;
    const auto start = djpete_test::disturbed(world, disturbance);

    BackboneProblem out;
    for (int c = 0; c < o.cameras; ++c) {
        out.cameras.push_back(
            {{uint64_t(c)}, world.camera, start.T_world_cam[std::size_t(c)], c < kFixed});
    }
    std::vector<bool> wanted(world.p_world.size());
    for (const auto& z : world.observations) {
        if (z.camera >= kFixed) wanted[std::size_t(z.point)] = true;
    }
    std::vector<std::optional<std::size_t>> index(world.p_world.size());
    for (std::size_t p = 0; p < wanted.size() && int(out.points.size()) < points; ++p) {
        if (!wanted[p]) continue;
        index[p] = out.points.size();
        out.points.push_back({{uint64_t(p)}, start.p_world[p]});
    }
    for (std::size_t i = 0; i < world.observations.size(); ++i) {
        const auto& z = world.observations[i];
        if (!index[std::size_t(z.point)]) continue;
        djpete::obs::KeyframeFeature f;
        f.u_px = float(z.uvu.x());
        f.v_px = float(z.uvu.y());
        f.sigma_px = f.uRightSigma_px = 0.5F;
        if (i % 6 != 5) f.uRight_px = float(z.uvu.z());
        out.observations.push_back({std::size_t(z.camera), *index[std::size_t(z.point)], f});
    }
    return out;
}

/// The first job of local bundle adjustment at every `step`-th keyframe of a drive (at most
/// `frames` frames), as the back end would issue it with `windowSize` free keyframes.
inline std::vector<BackboneProblem> driveWindows(const std::string& rawlog, unsigned windowSize,
                                                 std::size_t step, std::size_t frames) {
    namespace be = djpete::backend;
    be::BackendOptions options;
    options.backbone.windowSize = windowSize;
    options.objects.mode = be::ObjectMode::Off;
    be::MapKeeper keeper(options, be::Mode::Lockstep);
    djpete::obs::RawlogSource source(rawlog);
    djpete::frontend::VisualOdometry odometry;
    std::vector<BackboneProblem> out;
    std::size_t keyframes = 0;
    for (std::size_t n = 0; n < frames; ++n) {
        const auto frame = source.next();
        if (!frame) break;
        const auto images = frame->loadMainImages();
        if (!images) continue;
        const auto keyframe =
            odometry.process({frame->id, frame->stamp, *images, nullptr, std::nullopt});
        keeper.addFrame(keyframe, nullptr);
        frame->unload();
        if (!keyframe->isKeyframe || ++keyframes % step != 0) continue;
        // The job of this keyframe is under way and not yet in the map: this is its problem.
        out.push_back(be::backboneProblem(keeper.map(), options.backbone, windowSize));
        if (out.back().cameras.empty()) out.pop_back();
    }
    return out;
}

}  // namespace djpete_bench
