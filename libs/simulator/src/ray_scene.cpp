#include "ray_scene.h"

#include <cmath>
#include <stdexcept>

#include "street_builder.h"

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
    : world_(world), street_(buildStreet(world.street(), world.options().seed)) {
    device_ = rtcNewDevice("threads=1");
    if (device_ == nullptr) throw std::runtime_error("Embree cannot be started on this machine");
    scene_ = rtcNewScene(device_);
    addMesh(scene_, street_);  // geometry 0
    bodies_.reserve(world.cars().size());
    for (const auto& car : world.cars()) {
        bodies_.push_back(makeCarBody(car.kind, car.seed));
        RTCScene own = rtcNewScene(device_);
        addMesh(own, bodies_.back().mesh);
        rtcCommitScene(own);
        RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, own);
        rtcAttachGeometryByID(scene_, instance, static_cast<unsigned>(bodies_.size()));
        carScenes_.push_back(own);
        instances_.push_back(instance);
    }
    T_world_obj_.resize(bodies_.size());
    setFrame(0);
}

RayScene::~RayScene() {
    for (auto g : instances_) rtcReleaseGeometry(g);
    rtcReleaseScene(scene_);
    for (auto s : carScenes_) rtcReleaseScene(s);
    rtcReleaseDevice(device_);
}

RTCGeometry RayScene::addMesh(RTCScene scene, const Mesh& mesh) {
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
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);  // the scene keeps it
    return g;
}

void RayScene::setFrame(uint64_t frame) {
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        const auto& car = world_.cars()[i];
        T_world_obj_[i] = world_.T_world_obj(car, frame);
        const Eigen::Matrix4f m = T_world_obj_[i].matrix().cast<float>();
        rtcSetGeometryTransform(instances_[i], 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, m.data());
        rtcCommitGeometry(instances_[i]);
    }
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
        const unsigned instance = rh.hit.instID[0][i];
        hits[i] = {rh.ray.tfar[i], rh.hit.primID[i],
                   instance == RTC_INVALID_GEOMETRY_ID ? kNoHit : instance - 1, rh.hit.u[i],
                   rh.hit.v[i]};
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
    rtcOccluded8(mask, scene_, &context, &r);
    for (std::size_t i = 0; i < 8; ++i) blocked[i] = active[i] && r.tfar[i] < 0;
}

SurfacePoint RayScene::surface(const Ray& ray, const Hit& hit, Vec3f& normal_world) const {
    const bool isCar = hit.car != kNoHit;
    const Mesh& mesh = isCar ? bodies_[hit.car].mesh : street_;
    const Triangle& t = mesh.triangles[hit.triangle];
    const float w = 1.F - hit.u - hit.v;
    const auto blend = [&](const auto& values) {
        return (w * values[t.vertex[0]] + hit.u * values[t.vertex[1]] + hit.v * values[t.vertex[2]])
            .eval();
    };
    SurfacePoint s;
    s.material = t.material;
    s.seed = t.seed;
    s.uv = blend(mesh.uv);
    s.p_obj = blend(mesh.vertices);
    const Vec3f& a = mesh.vertices[t.vertex[0]];
    Vec3f n = (mesh.vertices[t.vertex[1]] - a).cross(mesh.vertices[t.vertex[2]] - a).normalized();
    if (!mesh.normals.empty() && t.material == Material::CarBody) {
        const Vec3f smooth = blend(mesh.normals);
        if (smooth.norm() > 0.1F && std::abs(smooth.normalized().dot(n)) > 0.5F) {
            n = smooth.normalized() * (smooth.dot(n) < 0 ? -1.F : 1.F);
        }
    }
    const Eigen::Matrix3f R = isCar ? T_world_obj_[hit.car].rotation().cast<float>().eval()
                                    : Eigen::Matrix3f::Identity().eval();
    normal_world = R * n;
    if (normal_world.dot(ray.direction) > 0) {
        normal_world = -normal_world;
        n = -n;
    }
    s.n_obj = n;
    if (isCar) {
        s.halfSize = 0.5F * bodies_[hit.car].size_m.cast<float>();
        s.wheelX_m = bodies_[hit.car].wheelX_m;
        s.wheelRadius_m = bodies_[hit.car].wheelRadius_m;
    }
    return s;
}

}  // namespace djpete::simulator
