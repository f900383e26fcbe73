#include <algorithm>
#include <cmath>

#include "renderer_impl.h"

namespace djpete::simulator {

namespace {

std::size_t indexOf(const World& world, const Actor& actor) {
    std::size_t index = 0;
    while (world.actors().at(index).id != actor.id) ++index;
    return index;
}

}  // namespace

double Renderer::visibleFraction(uint64_t frame, const Actor& actor,
                                 const geometry::SE3& T_vehicle_cam) {
    impl_->setFrame(frame);
    const auto& world = impl_->scene.world();
    const std::size_t index = indexOf(world, actor);
    const Mesh& mesh = impl_->scene.body(index).mesh;
    const geometry::SE3 T_world_obj = world.T_world_obj(actor, frame);
    const geometry::Vec3 eye = (world.T_world_vehicle(frame) * T_vehicle_cam).translation();
    std::vector<Ray> rays;             // to the middles of the faces that look at the camera
    constexpr std::size_t kEvery = 3;  // a third of them will do
    for (std::size_t k = 0; k < mesh.triangles.size(); k += kEvery) {
        const auto& t = mesh.triangles[k].vertex;
        const Vec3f a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
        const geometry::Vec3 p = T_world_obj * ((a + b + c) / 3.F).cast<double>().eval();
        const geometry::Vec3 n = T_world_obj.rotation() * (b - a).cross(c - a).cast<double>();
        if (n.norm() < 1e-9 || n.dot(eye - p) <= 0) continue;
        rays.push_back({eye.cast<float>(), (p - eye).normalized().cast<float>()});
    }
    const std::size_t facing = rays.size();
    std::size_t seen = 0;
    for (std::size_t first = 0; first < facing; first += 8) {
        std::array<Ray, 8> packet;
        std::array<bool, 8> active{};
        std::array<Hit, 8> hits;
        for (std::size_t i = 0; i < 8; ++i) {
            active[i] = first + i < facing;
            packet[i] = rays[active[i] ? first + i : first];
        }
        impl_->scene.cast(packet, active, hits);
        for (std::size_t i = 0; i < 8; ++i) seen += active[i] && hits[i].actor == index ? 1U : 0U;
    }
    return facing == 0 ? 0.0 : static_cast<double>(seen) / static_cast<double>(facing);
}

std::optional<ImageBox> Renderer::imageBox(uint64_t frame, const Actor& actor,
                                           const geometry::StereoCamera& camera,
                                           const geometry::SE3& T_vehicle_cam) {
    constexpr double kNear_m = 0.1;
    const World& world = impl_->scene.world();
    const Mesh& mesh = impl_->scene.body(indexOf(world, actor)).mesh;
    const geometry::SE3 T_cam_obj =
        (world.T_world_vehicle(frame) * T_vehicle_cam).inverse() * world.T_world_obj(actor, frame);
    std::vector<geometry::Vec3> p_cam;
    for (const auto& p : mesh.vertices) p_cam.push_back(T_cam_obj * p.cast<double>().eval());
    std::optional<ImageBox> box;
    const auto add = [&](const geometry::Vec3& p) {
        const geometry::Vec2 uv = camera.project(p);
        if (!box) box = ImageBox{uv.x(), uv.y(), uv.x(), uv.y()};
        box->left = std::min(box->left, uv.x());
        box->right = std::max(box->right, uv.x());
        box->top = std::min(box->top, uv.y());
        box->bottom = std::max(box->bottom, uv.y());
    };
    for (const auto& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const geometry::Vec3 &a = p_cam[t.vertex[k]], &b = p_cam[t.vertex[(k + 1) % 3]];
            if (a.z() >= kNear_m) add(a);
            if ((a.z() < kNear_m) != (b.z() < kNear_m))
                add(a + (kNear_m - a.z()) / (b.z() - a.z()) * (b - a));
        }
    }
    return box;
}

}  // namespace djpete::simulator
