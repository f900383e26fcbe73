#include "ray_scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace djpete::simulator {

namespace {

constexpr float kFar_m = 600.F;

template <class RayN>
void fill(RayN& r, const std::array<Ray, 8>& rays, float reach_m) {
    for (std::size_t i = 0; i < 8; ++i) {
        r.org_x[i] = rays[i].origin.x();
        r.org_y[i] = rays[i].origin.y();
        r.org_z[i] = rays[i].origin.z();
        r.dir_x[i] = rays[i].direction.x();
        r.dir_y[i] = rays[i].direction.y();
        r.dir_z[i] = rays[i].direction.z();
        r.tnear[i] = 1e-3F;
        r.tfar[i] = reach_m;
        r.time[i] = 0;
        r.mask[i] = 0xFFFFFFFFU;
        r.id[i] = static_cast<unsigned>(i);
        r.flags[i] = 0;
    }
}

void fillMask(const std::array<bool, 8>& active, int* mask) {
    for (std::size_t i = 0; i < 8; ++i) mask[i] = active[i] ? -1 : 0;
}

}  // namespace

RayScene::RayScene(const World& world)
    : world_(world), street_(buildStreet(world.network(), world.options().seed)) {
    // One thread builds the trees, and no wider vectors than AVX2: the same hits everywhere.
    device_ = rtcNewDevice("threads=1,max_isa=avx2");
    if (device_ == nullptr) throw std::runtime_error("Embree cannot be started on this machine");
    if (rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) == 0)
        throw std::runtime_error("Ray tracing needs a processor with AVX");
    scene_ = rtcNewScene(device_);
    addInstance(newMeshScene(street_.mesh), street_.mesh);  // geometry 0
    things_.clear();
    bodies_.reserve(world.actors().size());
    for (const auto& actor : world.actors()) {
        auto& shapes = bodies_.emplace_back();
        auto& scenes = bodyScenes_.emplace_back();
        for (uint32_t k = 0; k < phasesOf(actor.type); ++k) shapes.push_back(makeBody(actor, k));
        for (const auto& shape : shapes) scenes.push_back(newMeshScene(shape.mesh));
        addInstance(scenes.front(), shapes.front().mesh);
    }
    addPlants();
    T_world_obj_.resize(bodies_.size());
    phase_.assign(bodies_.size(), 0);
    setFrame(0);
}

RayScene::~RayScene() {
    for (auto g : instances_) rtcReleaseGeometry(g);
    rtcReleaseScene(scene_);
    for (auto s : meshScenes_) rtcReleaseScene(s);
    rtcReleaseDevice(device_);
}

RTCScene RayScene::newMeshScene(const Mesh& mesh) {
    RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
    for (const auto& p : mesh.vertices) {
        for (int k = 0; k < 3; ++k) *v++ = p[k];
    }
    auto* t = static_cast<unsigned*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0,
                                                             RTC_FORMAT_UINT3, 3 * sizeof(unsigned),
                                                             mesh.triangles.size()));
    for (const auto& tri : mesh.triangles) {
        for (uint32_t i : tri.vertex) *t++ = i;
    }
    rtcCommitGeometry(g);
    RTCScene scene = rtcNewScene(device_);
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);  // the scene keeps it
    rtcCommitScene(scene);
    meshScenes_.push_back(scene);
    return scene;
}

void RayScene::addInstance(RTCScene scene, const Mesh& mesh) {
    RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, scene);
    const Eigen::Matrix4f here = Eigen::Matrix4f::Identity();
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, here.data());
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(scene_, instance, static_cast<unsigned>(instances_.size()));
    instances_.push_back(instance);
    things_.push_back({&mesh, Eigen::Matrix3f::Identity()});
}

void RayScene::addPlants() {
    std::vector<RTCScene> scenes;
    for (const auto& mesh : street_.prototypes) scenes.push_back(newMeshScene(mesh));
    for (const auto& plant : street_.plants) {
        addInstance(scenes[plant.prototype], street_.prototypes[plant.prototype]);
        const geometry::SE3 turn =
            geometry::SE3::fromYaw(static_cast<double>(plant.yaw_rad), plant.foot.cast<double>());
        things_.back().R_world_obj = turn.rotation().cast<float>();
        Eigen::Matrix4f m = turn.matrix().cast<float>();
        m.topLeftCorner<3, 3>() *= plant.scale;
        rtcSetGeometryTransform(instances_.back(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, m.data());
        rtcCommitGeometry(instances_.back());
    }
}

void RayScene::placeCars(uint64_t frame) {
    const Vec3f own = world_.T_world_vehicle(frame).translation().cast<float>();
    gridCorner_ = own - Vec3f::Constant(0.5F * kCells * kCell_m);
    carsNear_.assign(kCells * kCells, {});
    for (uint32_t i = 0; i < bodies_.size(); ++i) {
        if (!world_.present(world_.actors()[i], frame)) continue;
        const Vec3f c = T_world_obj_[i].translation().cast<float>() - gridCorner_;
        const float reach = 0.5F * static_cast<float>(world_.actors()[i].size_m.x()) + 1.F;
        const auto cell = [](float x) { return static_cast<int>(std::floor(x / kCell_m)); };
        for (int y = std::max(0, cell(c.y() - reach));
             y <= std::min(kCells - 1, cell(c.y() + reach)); ++y)
            for (int x = std::max(0, cell(c.x() - reach));
                 x <= std::min(kCells - 1, cell(c.x() + reach)); ++x)
                carsNear_[static_cast<std::size_t>(y * kCells + x)].push_back(i);
    }
}

float RayScene::openness(const Vec3f& p_world) const {
    const Vec3f q = (p_world - gridCorner_) / kCell_m;
    if (q.x() < 0 || q.y() < 0 || q.x() >= kCells || q.y() >= kCells) return 1.F;
    float open = 1;
    for (uint32_t i : carsNear_[static_cast<std::size_t>(static_cast<int>(q.y()) * kCells +
                                                         static_cast<int>(q.x()))]) {
        const Vec3f p = things_[i].R_world_obj.transpose() *
                        (p_world - T_world_obj_[i].translation().cast<float>());
        const Vec3f half = 0.5F * world_.actors()[i].size_m.cast<float>();
        const float dx = std::abs(p.x()) - half.x(), dy = std::abs(p.y()) - half.y();
        const float outside =
            std::hypot(std::max(dx, 0.F), std::max(dy, 0.F)) + std::min(std::max(dx, dy), 0.F);
        const float t = std::clamp((outside + 0.35F) / 0.85F, 0.F, 1.F);
        open *= 0.12F + 0.88F * t * t * (3.F - 2.F * t);
    }
    return open;
}

void RayScene::setFrame(uint64_t frame) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const auto& actor = world_.actors()[i];
        RTCGeometry instance = instances_[i + 1];
        if (!world_.present(actor, frame)) {
            rtcDisableGeometry(instance);
            continue;
        }
        rtcEnableGeometry(instance);
        T_world_obj_[i] = world_.T_world_obj(actor, frame);
        things_[i].R_world_obj = T_world_obj_[i].rotation().cast<float>();
        if (const uint32_t now = world_.phase(actor, frame); now != phase_[i]) {
            phase_[i] = now;
            things_[i].mesh = &bodies_[i][now].mesh;
            rtcSetGeometryInstancedScene(instance, bodyScenes_[i][now]);
        }
        const Eigen::Matrix4f m = T_world_obj_[i].matrix().cast<float>();
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, m.data());
        rtcCommitGeometry(instance);
    }
    placeCars(frame);
    rtcCommitScene(scene_);
}

void RayScene::cast(const std::array<Ray, 8>& rays, const std::array<bool, 8>& active,
                    std::array<Hit, 8>& hits) const {
    alignas(32) int mask[8];
    fillMask(active, mask);
    RTCRayHit8 rh;
    fill(rh.ray, rays, kFar_m);
    for (std::size_t i = 0; i < 8; ++i) {
        rh.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        rh.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        rh.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(mask, scene_, &context, &rh);
    for (std::size_t i = 0; i < 8; ++i) {
        hits[i] = Hit();
        if (!active[i] || rh.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        const uint32_t thing = rh.hit.instID[0][i] - 1U;  // of the street: kNoHit
        hits[i] = {rh.ray.tfar[i], rh.hit.primID[i], thing, thing < bodies_.size() ? thing : kNoHit,
                   rh.hit.u[i],    rh.hit.v[i]};
    }
}

void RayScene::occluded(const std::array<Ray, 8>& rays, const std::array<bool, 8>& active,
                        float reach_m, std::array<bool, 8>& blocked) const {
    alignas(32) int mask[8];
    fillMask(active, mask);
    RTCRay8 r;
    fill(r, rays, reach_m);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(mask, scene_, &context, &r);
    for (std::size_t i = 0; i < 8; ++i) blocked[i] = active[i] && r.tfar[i] < 0;
}

const Mesh& RayScene::meshOf(const Hit& hit) const {
    return hit.thing == kNoHit ? street_.mesh : *things_[hit.thing].mesh;
}

const Triangle& RayScene::triangle(const Hit& hit) const {
    return meshOf(hit).triangles[hit.triangle];
}

SurfacePoint RayScene::surface(const Ray& ray, const Hit& hit, float pixelAngle,
                               Vec3f& normal_world) const {
    const Mesh& mesh = meshOf(hit);
    const Triangle& t = mesh.triangles[hit.triangle];
    const float w = 1.F - hit.u - hit.v;
    const auto blend = [&](const auto& values) {
        return (w * values[t.vertex[0]] + hit.u * values[t.vertex[1]] + hit.v * values[t.vertex[2]])
            .eval();
    };
    SurfacePoint s;
    s.finish = mesh.finishes[t.finish];
    s.uv = blend(mesh.uv);
    s.p_obj = blend(mesh.vertices);
    const Vec3f& a = mesh.vertices[t.vertex[0]];
    Vec3f flat =
        (mesh.vertices[t.vertex[1]] - a).cross(mesh.vertices[t.vertex[2]] - a).normalized();
    const bool placed = hit.thing != kNoHit;
    const Vec3f d =
        placed ? Vec3f(things_[hit.thing].R_world_obj.transpose() * ray.direction) : ray.direction;
    if (flat.dot(d) > 0) flat = -flat;
    Vec3f n = blend(mesh.normals);
    const float length = n.norm();
    if (length < 0.1F) {
        n = flat;
    } else {
        n /= length;
        if (s.finish.material == Material::Leaf) {
            if (n.dot(d) > 0.3F) n = -n;
        } else if (n.dot(flat) < 0) {
            n = -n;
        }
    }
    s.n_obj = n;
    normal_world = placed ? Vec3f(things_[hit.thing].R_world_obj * n) : n;
    if (hit.actor != kNoHit) s.car = &body(hit.actor);
    // A pixel is a disc across the ray; on the surface it grows along the ray's projection.
    s.footprint_m = pixelAngle * hit.distance_m;
    const float cosine = std::max(0.04F, -flat.dot(d));
    const Vec3f along = d + cosine * flat;
    const float size = along.norm();
    if (size > 1e-3F) {
        const float stretch = s.footprint_m / cosine / size;
        s.major_m = stretch * Vec2f(along.dot(t.tangentU), along.dot(t.tangentV));
    } else {
        s.major_m = Vec2f(s.footprint_m, 0);
    }
    return s;
}

}  // namespace djpete::simulator
