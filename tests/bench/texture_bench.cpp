/// Speed and memory of object textures: one car of up to 20,000 points that grows and is seen view
/// after view, and a thousand cars with what is kept of them.
///
///     djpete_bench_texture [views = 40] [objects = 1000]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include "box_world.h"
#include "djpete/texture/object_texturer.h"

namespace {

using namespace djpete_test;
using djpete::map::ObjectId;
using djpete::obs::FrameId;
using djpete::texture::ObjectTexturer;
using djpete::texture::TextureView;

const Vec3 kSize(4.2, 1.8, 1.5);
const std::array<Rgb, 6> kFaces{
    {{220, 30, 30}, {30, 200, 40}, {40, 60, 210}, {220, 200, 40}, {240, 240, 240}, {10, 10, 10}}};

StereoCamera kittiCamera() {
    StereoCamera camera;
    camera.fx = camera.fy = 718;
    camera.cx = 607;
    camera.cy = 185;
    camera.width_px = 1241;
    camera.height_px = 376;
    return camera;
}

/// Points all over the car, as many scans give them, `spacing_m` apart; every `part`-th from
/// `first`.
std::vector<Vec3> surface(double spacing_m, std::size_t part, std::size_t first) {
    std::vector<Vec3> out;
    std::size_t n = 0;
    const Vec3 half = 0.5 * kSize;
    for (int axis = 0; axis < 3; ++axis) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        for (double u = -half[a]; u <= half[a]; u += spacing_m) {
            for (double v = -half[b]; v <= half[b]; v += spacing_m) {
                for (const double side : {-1.0, 1.0}) {
                    if (n++ % part != first) continue;
                    Vec3 p;
                    p[axis] = side * half[axis];
                    p[a] = u;
                    p[b] = v;
                    out.push_back(p);
                }
            }
        }
    }
    return out;
}

/// View `k` of car `id`, whose image is the same for all: only the points are new.
TextureView viewOf(ObjectId id, uint64_t frame, const mrpt::img::CImage& image,
                   const SE3& T_world_cam, const SE3& T_world_car,
                   const std::vector<Vec3>& points) {
    TextureView view;
    view.frame = FrameId{frame};
    view.images.camera.model = kittiCamera();
    view.images.left = image;
    view.T_world_cam = T_world_cam;
    view.T_world_vehicle = SE3::fromYaw(0, T_world_cam.translation());
    view.scan.emplace();
    const SE3 T_vehicle_car = view.T_world_vehicle.inverse() * T_world_car;
    for (const Vec3& p : points) {
        const Vec3 q = T_vehicle_car * p;
        view.scan->points.push_back({static_cast<float>(q.x()), static_cast<float>(q.y()),
                                     static_cast<float>(q.z()), 0.5F});
    }
    djpete::texture::ObjectInView object;
    object.id = id;
    object.size_m = kSize;
    object.T_world_obj = T_world_car;
    view.objects.push_back(object);
    return view;
}

double seconds(const std::chrono::steady_clock::time_point& since) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

double residentMemory_mb() {
    std::ifstream in("/proc/self/statm");
    double total = 0, resident = 0;
    in >> total >> resident;
    return resident * 4096 / 1e6;
}

void report(const char* what, std::vector<double> ms, double points) {
    std::sort(ms.begin(), ms.end());
    double sum = 0;
    for (const double t : ms) sum += t;
    std::printf("%s: p50 %.1f ms, p95 %.1f ms, max %.1f ms a view; %.1f million points/s\n", what,
                ms[ms.size() / 2], ms[ms.size() * 95 / 100], ms.back(), points / sum / 1e3);
}

/// FNV-1a of the colours, so that two builds can be compared.
uint64_t checksum(const djpete::texture::ObjectModel& model) {
    uint64_t sum = 14695981039346656037ULL;
    const auto add = [&](const auto& value) {
        std::array<unsigned char, sizeof value> bytes;
        std::memcpy(bytes.data(), &value, sizeof value);
        for (const unsigned char b : bytes) sum = (sum ^ b) * 1099511628211ULL;
    };
    for (std::size_t i = 0; i < model.size(); ++i) {
        const auto& colour = model.colours[i];
        add(colour.weight), add(colour.count), add(colour.mean), add(colour.m2);
        add(model.normals[i]), add(model.seenIn[i]);
    }
    return sum;
}

void oneCar(uint64_t views) {
    const SE3 T_world_car = SE3::fromYaw(0, {0, 0, 0.75});
    const BoxWorld world{{{T_world_car, kSize, kFaces, 0.1}}, Rgb{90, 90, 90}};
    const SE3 T_world_cam = lookAt({7, -6, 1.7}, {0, 0, 0.75});
    const mrpt::img::CImage image = world.image(kittiCamera(), T_world_cam);
    ObjectTexturer texturer;
    std::vector<double> growing, grown;
    double pointsGrowing = 0, pointsGrown = 0;
    for (uint64_t k = 0; k < views; ++k) {
        const bool grows = k < views / 2;
        const auto points =
            grows ? surface(0.02, views / 2, k) : std::vector<Vec3>{Vec3(0, 0, 0.75)};
        const auto view = viewOf(ObjectId{1}, k, image, T_world_cam, T_world_car, points);
        const auto begin = std::chrono::steady_clock::now();
        const auto done = texturer.addView(view);
        (grows ? growing : grown).push_back(1e3 * seconds(begin));
        (grows ? pointsGrowing : pointsGrown) += static_cast<double>(done.pointsProjected);
    }
    const auto& model = texturer.models().at(ObjectId{1});
    std::printf("one car, %zu points, coverage %.2f, %zu views kept, checksum %016llx\n",
                model.size(), model.coverage(), model.views.size(),
                static_cast<unsigned long long>(checksum(model)));
    report("  while it grows (with new normals)", growing, pointsGrowing);
    report("  all points there", grown, pointsGrown);
    const auto begin = std::chrono::steady_clock::now();
    texturer.settle();
    std::printf("  settle: %.0f ms\n", 1e3 * seconds(begin));
}

void manyCars(uint64_t objects) {
    constexpr uint64_t kViews = 8;
    const SE3 T_world_car = SE3::fromYaw(0, {0, 0, 0.75});
    const BoxWorld world{{{T_world_car, kSize, kFaces, 0.1}}, Rgb{90, 90, 90}};
    const SE3 T_world_cam = lookAt({7, -6, 1.7}, {0, 0, 0.75});
    const mrpt::img::CImage image = world.image(kittiCamera(), T_world_cam);
    const double before = residentMemory_mb();
    ObjectTexturer texturer;
    std::size_t points = 0;
    const auto begin = std::chrono::steady_clock::now();
    for (uint64_t k = 0; k < kViews; ++k) {
        const auto some = surface(0.08, kViews, k);
        for (uint64_t id = 0; id < objects; ++id) {
            // Each car has frames of its own, as along a street.
            texturer.addView(
                viewOf(ObjectId{id}, id * kViews + k, image, T_world_cam, T_world_car, some));
        }
    }
    const double adding = seconds(begin);
    const double grown_mb = residentMemory_mb() - before;
    const auto settling = std::chrono::steady_clock::now();
    texturer.settle(2);
    for (const auto& [id, model] : texturer.models()) points += model.size();
    std::printf(
        "%llu cars of %zu points, %llu views each: %.0f MB while they grow, %.0f MB after "
        "(%.0f MB cut-outs and samples), %.1f ms a view, settle %.1f s on 2 threads\n",
        static_cast<unsigned long long>(objects), points / objects,
        static_cast<unsigned long long>(kViews), grown_mb, residentMemory_mb() - before,
        static_cast<double>(texturer.viewBytes()) / 1e6,
        1e3 * adding / static_cast<double>(objects * kViews), seconds(settling));
}

}  // namespace

int main(int argc, char** argv) {
    const int views = argc > 1 ? std::max(4, std::atoi(argv[1])) : 40;
    const int objects = argc > 2 ? std::max(1, std::atoi(argv[2])) : 1000;
    oneCar(static_cast<uint64_t>(views));
    manyCars(static_cast<uint64_t>(objects));
    return 0;
}
