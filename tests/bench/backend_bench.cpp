/// Speed of the back end: local bundle adjustment and the object worker.
#include <chrono>
#include <cstdio>

#include "djpete/backend/map_keeper.h"
#include "djpete_test/synthetic_drive.h"

namespace {

using namespace djpete;
using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

template <class F>
backend::StageTimes timed(int runs, F&& f) {
    backend::StageTimes times;
    for (int i = 0; i < runs; ++i) {
        const auto begin = Clock::now();
        f();
        times.add(milliseconds(begin));
    }
    return times;
}

void print(const char* what, const backend::StageTimes& t) {
    std::printf("  %-28s %5zu x  p50 %8.2f  p95 %8.2f  max %8.2f ms\n", what, t.count(), t.p50_ms(),
                t.p95_ms(), t.max_ms());
}

djpete_test::DriveOptions drive() {
    djpete_test::DriveOptions o;
    o.frames = 120;
    o.pointsPerMetre = 24;
    return o;
}

void localAdjustment() {
    const auto d = djpete_test::makeDrive(drive());
    backend::MapKeeper keeper({}, backend::Mode::Lockstep);
    for (const auto& f : d.frames) keeper.addFrame(f.keyframe, nullptr);
    const backend::BackboneOptions options;
    const auto problem = backend::backboneProblem(keeper.map(), options, options.windowSize);
    std::size_t free = 0;
    for (const auto& c : problem.cameras) free += c.fixed ? 0U : 1U;
    const auto update = backend::solve(problem, options);
    std::printf(
        "local adjustment: %zu free + %zu fixed keyframes, %zu landmarks, %zu observations; "
        "%d iterations in the second round\n",
        free, problem.cameras.size() - free, problem.points.size(), problem.observations.size(),
        update.report.iterations);
    print("building the problem",
          timed(20, [&] { backend::backboneProblem(keeper.map(), options, options.windowSize); }));
    print("solving a solved one", timed(20, [&] { backend::solve(problem, options); }));
    print("solving, per keyframe", keeper.statistics().stages.at("backbone"));
    print("inserting a frame", keeper.statistics().stages.at("insert"));
}

backend::ObjectProblem objects(std::size_t n, unsigned views, bool moving) {
    djpete_test::Random random(1);
    backend::ObjectProblem problem;
    for (std::size_t k = 0; k < n; ++k) {
        backend::ObjectProblem::Object object;
        object.id = {k};
        object.moving = moving;
        for (unsigned i = 0; i < views; ++i) {
            backend::ObjectProblem::Edge e;
            e.frame = {i};
            e.time_s = 0.1 * i;
            e.T_world_cam = geometry::SE3::fromYaw(0.01 * i, geometry::Vec3(0.8 * i, 0, 0));
            const double forward = 20 + (moving ? 0.7 * i : 0);
            geometry::Vec6 noise;
            noise << random.normal3(0.3), random.normal3(0.05);
            const auto T = geometry::SE3::fromYaw(0, {forward, 4.0 * static_cast<double>(k), 0});
            e.T_cam_obj = e.T_world_cam.inverse() * T * geometry::SE3::exp(noise);
            e.information = obs::diagonalInformation(geometry::Vec3::Constant(0.3),
                                                     geometry::Vec3::Constant(0.05));
            e.size_m = {4.2, 1.7, 1.5};
            object.edges.push_back(e);
        }
        problem.objects.push_back(std::move(object));
    }
    return problem;
}

void objectWorker() {
    std::printf("object worker: 50 objects with 30 observations each\n");
    const auto standing = objects(50, 30, false), moving = objects(50, 30, true);
    const backend::ObjectOptions options;
    print("standing", timed(20, [&] { backend::solve(standing, options); }));
    print("moving", timed(20, [&] { backend::solve(moving, options); }));
}

/// Every other one moves.
backend::ObjectProblem mixed(std::size_t n, unsigned views) {
    auto problem = objects(n, views, false);
    const auto moving = objects(n, views, true);
    for (std::size_t k = 1; k < n; k += 2) problem.objects[k] = moving.objects[k];
    return problem;
}

/// The map holds 200 objects; after a correction of the cameras all are due, else the few in view.
void fullMap() {
    std::printf("object worker with 200 objects in the map, 60 views each\n");
    const auto all = mixed(200, 60);
    auto usual = all;
    usual.objects.resize(15);
    backend::ObjectOptions options;
    print("all 200 due", timed(20, [&] { backend::solve(all, options); }));
    print("15 due", timed(50, [&] { backend::solve(usual, options); }));
    options.threads = 1;
    print("all 200 due, one thread", timed(20, [&] { backend::solve(all, options); }));
    print("15 due, one thread", timed(50, [&] { backend::solve(usual, options); }));
}

void wholeDrive() {
    const auto d = djpete_test::makeDrive(drive());
    std::printf("drive of %zu frames, threaded\n", d.frames.size());
    backend::MapKeeper keeper({}, backend::Mode::Threaded);
    const auto begin = Clock::now();
    for (const auto& f : d.frames) keeper.addFrame(f.keyframe, f.detections);
    const double driving_ms = milliseconds(begin);
    keeper.finish();
    for (const auto& [stage, times] : keeper.statistics().stages) print(stage.c_str(), times);
    std::printf("  %.1f ms per frame while driving\n",
                driving_ms / static_cast<double>(d.frames.size()));
}

}  // namespace

int main() {
    localAdjustment();
    objectWorker();
    fullMap();
    wholeDrive();
    return 0;
}
