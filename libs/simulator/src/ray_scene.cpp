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
    empty_ = rtcNewScene(device_);
    rtcCommitScene(empty_);
    streetShape_ = newShape(street_.mesh);
    addInstance(&streetShape_);  // geometry 0
    things_.clear();
    const std::size_t actors = world.actors().size();
    for (const auto& actor : world.actors()) {
        actorShapes_.emplace_back(phasesOf(actor.type));
        addInstance(nullptr);
        rtcDisableGeometry(instances_.back());
    }
    phase_.assign(actors, 0);
    shown_.assign(actors, false);
    T_world_obj_.resize(actors);
    addPlants();
    setFrame(0);
}

RayScene::~RayScene() {
    for (auto g : instances_) rtcReleaseGeometry(g);
    rtcReleaseScene(scene_);
    rtcReleaseScene(empty_);
    rtcReleaseScene(streetShape_.scene);
    for (auto* shapes : {&plantShapes_, &coarsePlantShapes_})
        for (auto& s : *shapes) rtcReleaseScene(s.scene);
    for (auto& actor : actorShapes_)
        for (auto& s : actor)
            if (s.shape.scene != nullptr) rtcReleaseScene(s.shape.scene);
    rtcReleaseDevice(device_);
}

RayScene::Shape RayScene::newShape(const Mesh& mesh) {
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
    return {scene, facetsOf(mesh), &mesh};
}

void RayScene::addInstance(const Shape* shape) {
    RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, shape == nullptr ? empty_ : shape->scene);
    const Eigen::Matrix4f here = Eigen::Matrix4f::Identity();
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, here.data());
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(scene_, instance, static_cast<unsigned>(instances_.size()));
    instances_.push_back(instance);
    things_.emplace_back();
    things_.back().shape = shape;
}

void RayScene::addPlants() {
    for (const auto& mesh : street_.prototypes) plantShapes_.push_back(newShape(mesh));
    for (const auto& mesh : street_.coarse) coarsePlantShapes_.push_back(newShape(mesh));
    for (const auto& plant : street_.plants) {
        addInstance(&plantShapes_[plant.prototype]);
        const geometry::SE3 turn =
            geometry::SE3::fromYaw(static_cast<double>(plant.yaw_rad), plant.foot.cast<double>());
        things_.back().R_world_obj = turn.rotation().cast<float>();
        Eigen::Matrix4f m = turn.matrix().cast<float>();
        m.topLeftCorner<3, 3>() *= plant.scale;
        rtcSetGeometryTransform(instances_.back(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, m.data());
        rtcCommitGeometry(instances_.back());
    }
}

RayScene::ActorShape& RayScene::shapeOf(std::size_t actor) {
    ActorShape& s = actorShapes_[actor][phase_[actor]];
    if (!s.body) {
        s.body = makeBody(world_.actors()[actor], phase_[actor]);
        s.shape = newShape(s.body->mesh);
    }
    return s;
}

const CarBody& RayScene::body(std::size_t actor) { return *shapeOf(actor).body; }

void RayScene::placeCars(uint64_t frame) {
    const Vec3f own = world_.T_world_vehicle(frame).translation().cast<float>();
    gridCorner_ = own - Vec3f::Constant(0.5F * kCells * kCell_m);
    carsNear_.assign(kCells * kCells, {});
    for (uint32_t i = 0; i < shown_.size(); ++i) {
        if (!shown_[i]) continue;
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
        if (p.z() > 0.3F - half.z()) continue;  // above the ground it stands on
        const float dx = std::abs(p.x()) - half.x(), dy = std::abs(p.y()) - half.y();
        const float outside =
            std::hypot(std::max(dx, 0.F), std::max(dy, 0.F)) + std::min(std::max(dx, dy), 0.F);
        const float t = std::clamp((outside + 0.35F) / 0.85F, 0.F, 1.F);
        open *= 0.12F + 0.88F * t * t * (3.F - 2.F * t);
    }
    return open;
}

void RayScene::placePlants(uint64_t frame) {
    constexpr float kFine_m = 38.F;
    const Vec3f own = world_.T_world_vehicle(frame).translation().cast<float>();
    for (std::size_t i = 0; i < street_.plants.size(); ++i) {
        const Plant& plant = street_.plants[i];
        const bool fine = (plant.foot - own).head<2>().norm() < kFine_m;
        const Shape& wanted = (fine ? plantShapes_ : coarsePlantShapes_)[plant.prototype];
        Thing& thing = things_[shown_.size() + i];
        if (thing.shape == &wanted) continue;
        thing.shape = &wanted;
        RTCGeometry instance = instances_[shown_.size() + i + 1];
        rtcSetGeometryInstancedScene(instance, wanted.scene);
        rtcCommitGeometry(instance);
    }
}

void RayScene::placeActor(std::size_t actor, uint64_t frame) {
    RTCGeometry instance = instances_[actor + 1];
    const Actor& who = world_.actors()[actor];
    bool show = world_.present(who, frame);
    geometry::SE3 T_world_obj;
    if (show) {
        T_world_obj = world_.T_world_obj(who, frame);
        const geometry::Vec3 own = world_.T_world_vehicle(frame).translation();
        show = (T_world_obj.translation() - own).norm() < kReach_m;
    }
    if (!show) {
        if (shown_[actor]) rtcDisableGeometry(instance);
        shown_[actor] = false;
        return;
    }
    phase_[actor] = world_.phase(who, frame);
    const ActorShape& s = shapeOf(actor);
    Thing& thing = things_[actor];
    const bool moved = T_world_obj.matrix() != T_world_obj_[actor].matrix();
    if (shown_[actor] && !moved && thing.shape == &s.shape) return;
    if (!shown_[actor]) rtcEnableGeometry(instance);
    if (thing.shape != &s.shape) rtcSetGeometryInstancedScene(instance, s.shape.scene);
    shown_[actor] = true;
    T_world_obj_[actor] = T_world_obj;
    thing = {&s.shape, &*s.body, T_world_obj.rotation().cast<float>()};
    const Eigen::Matrix4f m = T_world_obj.matrix().cast<float>();
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, m.data());
    rtcCommitGeometry(instance);
}

void RayScene::setFrame(uint64_t frame) {
    for (std::size_t i = 0; i < shown_.size(); ++i) placeActor(i, frame);
    placePlants(frame);
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
        hits[i] = {rh.ray.tfar[i], rh.hit.primID[i], thing, thing < shown_.size() ? thing : kNoHit,
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
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;  // the faster for shadows
    rtcOccluded8(mask, scene_, &context, &r);
    for (std::size_t i = 0; i < 8; ++i) blocked[i] = active[i] && r.tfar[i] < 0;
}

SurfacePoint RayScene::surface(const Ray& ray, const Hit& hit, float pixelAngle,
                               Vec3f& normal_world) const {
    const Shape& shapeHit = shape(hit);
    const Facet& f = shapeHit.facets[hit.triangle];
    const bool placed = hit.thing != kNoHit;
    SurfacePoint s;
    s.finish = f.finish;
    s.uv = f.uv + hit.u * f.uvAlongB + hit.v * f.uvAlongC;
    Vec3f d = ray.direction;
    if (placed) d = things_[hit.thing].R_world_obj.transpose() * ray.direction;
    if (!placed) {
        s.p_obj = ray.origin + hit.distance_m * ray.direction;
    } else if (s.finish.material != Material::Leaf) {  // leaves have no use for it
        const auto& corner = shapeHit.mesh->triangles[hit.triangle].vertex;
        const auto& p = shapeHit.mesh->vertices;
        s.p_obj =
            (1.F - hit.u - hit.v) * p[corner[0]] + hit.u * p[corner[1]] + hit.v * p[corner[2]];
    }
    float facing = -f.normal.dot(d);  // cosine between ray and plane
    const float sign = facing < 0 ? -1.F : 1.F;
    facing *= sign;
    const Vec3f flat = sign * f.normal;
    Vec3f n = f.normalA + hit.u * f.normalAlongB + hit.v * f.normalAlongC;
    const float length2 = n.squaredNorm();
    if (length2 < 0.01F) {
        n = flat;
    } else {
        n *= 1.F / std::sqrt(length2);
        const bool away = s.finish.material == Material::Leaf ? n.dot(d) > 0.3F : n.dot(flat) < 0;
        if (away) n = -n;
    }
    s.n_obj = n;
    normal_world = n;
    if (placed) normal_world = things_[hit.thing].R_world_obj * n;
    if (hit.actor != kNoHit) s.car = things_[hit.actor].body;
    // A pixel is a disc across the ray; on the surface it grows along the ray's projection.
    s.footprint_m = pixelAngle * hit.distance_m;
    if (s.finish.material == Material::Leaf) return s;  // untextured
    const float cosine = std::max(0.04F, facing);
    const Vec3f along = d + cosine * flat;
    const float size2 = along.squaredNorm();
    if (size2 > 1e-6F) {
        const float stretch = s.footprint_m / (cosine * std::sqrt(size2));
        s.major_m = stretch * Vec2f(along.dot(f.tangentU), along.dot(f.tangentV));
    } else {
        s.major_m = Vec2f(s.footprint_m, 0);
    }
    return s;
}

}  // namespace djpete::simulator
