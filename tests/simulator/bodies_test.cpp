// Shapes of vehicles and people.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "materials.h"
#include "some_actor.h"

namespace {

using namespace djpete::simulator;

/// Lowest and highest corner of the triangles that are drawn.
std::pair<Vec3f, Vec3f> boxOf(const Mesh& mesh) {
    Vec3f low = Vec3f::Constant(1e9F), high = -low;
    for (const auto& t : mesh.triangles) {
        for (uint32_t i : t.vertex) {
            low = low.cwiseMin(mesh.vertices.at(i));
            high = high.cwiseMax(mesh.vertices.at(i));
        }
    }
    return {low, high};
}

/// Positive if the triangles of a closed surface are counter-clockwise from outside.
double volumeOf(const Mesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles)
        sum += static_cast<double>(mesh.vertices[t.vertex[0]].dot(
                   mesh.vertices[t.vertex[1]].cross(mesh.vertices[t.vertex[2]]))) /
               6.0;
    return sum;
}

TEST(Bodies, VehiclesHaveTheSizeOfTheirKindAndAreCentredInTheirBox) {
    for (const auto& body : kVehicleBodies) {
        for (uint32_t seed = 1; seed <= 12; ++seed) {
            SCOPED_TRACE(std::string(nameOf(body.type)) + " " + std::to_string(body.kind) +
                         " seed " + std::to_string(seed));
            const Actor actor = actorOf(body.type, body.kind, seed);
            const CarBody b = makeBody(actor, 0);
            EXPECT_LT(b.mesh.triangles.size(), 6000U);
            EXPECT_EQ(b.mesh.normals.size(), b.mesh.vertices.size());
            EXPECT_EQ(bodySize(actor), b.size_m);
            const auto [low, high] = boxOf(b.mesh);
            EXPECT_LT((high - 0.5F * b.size_m.cast<float>()).cwiseAbs().maxCoeff(), 1e-5F);
            EXPECT_LT((low + 0.5F * b.size_m.cast<float>()).cwiseAbs().maxCoeff(), 1e-5F);
            EXPECT_GT(volumeOf(b.mesh), 0.4 * b.size_m.prod());
            const auto between = [](double x, double from, double to) {
                return x > from && x < to;
            };
            const bool truck = body.type == ActorType::Truck, van = body.type == ActorType::Van;
            EXPECT_TRUE(between(b.size_m.x(), truck ? 6.5 : 3.0, truck ? 8.5 : 6.3)) << b.size_m;
            EXPECT_TRUE(between(b.size_m.y(), truck ? 2.2 : 1.5, truck ? 2.6 : (van ? 2.3 : 2.1)))
                << b.size_m;
            EXPECT_TRUE(between(b.size_m.z(), truck ? 2.9 : 1.3, truck ? 3.4 : (van ? 2.8 : 2.2)))
                << b.size_m;
        }
    }
}

TEST(Bodies, WheelsStandFreeInTheirArches) {
    for (const auto& body : kVehicleBodies) {
        const CarBody b = makeBody(actorOf(body.type, body.kind, 4), 0);
        const CarOutline& o = b.outline;
        std::size_t arch = 0;
        for (const auto& t : b.mesh.triangles) {
            if (b.mesh.finishes[t.finish].material != Material::CarBody) continue;
            for (uint32_t i : t.vertex) {
                const Vec3f p = b.mesh.vertices[i] - o.origin_obj;
                if (std::abs(p.y()) < 0.5F * o.halfWidthAt(p.x() / o.length_m)) continue;  // floor
                const float r =
                    std::hypot(p.x() - o.wheelFront * o.length_m, p.z() - o.wheelRadius_m);
                EXPECT_GT(r, o.wheelRadius_m + 0.02F) << nameOf(body.type) << " " << body.kind;
                arch += r < o.archRadius_m() + 0.01F ? 1U : 0U;
            }
        }
        EXPECT_GT(arch, 20U);
    }
}

TEST(Bodies, AreDrawnAsOftenAsOnStreets) {
    constexpr uint32_t kDraws = 20000;
    uint32_t vans = 0, trucks = 0, plain = 0;
    std::set<std::pair<ActorType, uint32_t>> kinds;
    for (uint32_t seed = 0; seed < kDraws; ++seed) {
        const BodyKind body = drawVehicle(seed);
        kinds.insert({body.type, body.kind});
        vans += body.type == ActorType::Van ? 1U : 0U;
        trucks += body.type == ActorType::Truck ? 1U : 0U;
        // White, grey, black and silver have no colour.
        const Vec3f paint = carPaint(seed);
        plain += paint.maxCoeff() - paint.minCoeff() < 0.25F * paint.maxCoeff() ? 1U : 0U;
    }
    EXPECT_EQ(kinds.size(), kVehicleBodies.size());
    EXPECT_NEAR(vans / double(kDraws), 0.10, 0.02);
    EXPECT_LT(trucks / double(kDraws), 0.04);
    EXPECT_GT(trucks / double(kDraws), 0.02);
    EXPECT_NEAR(plain / double(kDraws), 0.72, 0.05);
}

TEST(Bodies, TwoCarsOfAKindDiffer) {
    // Colours at the same places of two hatchbacks.
    const CarBody a = makeBody(actorOf(ActorType::Car, 0, 21), 0);
    std::size_t same = 0, all = 0;
    for (uint32_t seed = 22; seed < 52; ++seed) {
        const CarBody b = makeBody(actorOf(ActorType::Car, 0, seed), 0);
        all += 1;
        same += (a.look.paint - b.look.paint).norm() < 0.01F && a.look.hub == b.look.hub &&
                        a.look.lamp == b.look.lamp && a.look.marking == b.look.marking
                    ? 1U
                    : 0U;
        EXPECT_GT((a.size_m - b.size_m).norm(), 1e-4);
    }
    EXPECT_LT(same, all / 10);
}

TEST(Bodies, PeopleGoThroughEightShapesInOneBoxWithAFootOnTheGround) {
    for (ActorType type : {ActorType::Pedestrian, ActorType::Cyclist}) {
        ASSERT_EQ(phasesOf(type), 8U);
        for (uint32_t seed = 1; seed <= 10; ++seed) {
            SCOPED_TRACE(std::string(nameOf(type)) + " seed " + std::to_string(seed));
            const Actor actor = actorOf(type, 0, seed);
            const auto shapes = makeShapes(actor);
            ASSERT_EQ(shapes.size(), 8U);
            const djpete::geometry::Vec3 size = bodySize(actor);
            const bool walks = type == ActorType::Pedestrian;
            EXPECT_GT(size.z(), 1.45);
            EXPECT_LT(size.z(), 2.1);
            EXPECT_GT(size.x(), walks ? 0.7 : 1.6);
            EXPECT_LT(size.x(), walks ? 1.4 : 2.0);
            EXPECT_GT(size.y(), 0.4);
            EXPECT_LT(size.y(), 0.95);
            Vec3f low = Vec3f::Constant(1e9F), high = -low;
            for (uint32_t k = 0; k < 8; ++k) {
                EXPECT_EQ(shapes[k].size_m, size);
                EXPECT_LT(shapes[k].mesh.triangles.size(), 3000U);
                const auto [from, to] = boxOf(shapes[k].mesh);
                EXPECT_NEAR(from.z(), -0.5 * size.z(), 1e-5) << "shape " << k;
                low = low.cwiseMin(from);
                high = high.cwiseMax(to);
                EXPECT_GT(volumeOf(shapes[k].mesh), 0.03);
                EXPECT_EQ(makeBody(actor, k).mesh.vertices, shapes[k].mesh.vertices);
                EXPECT_NE(shapes[(k + 1) % 8].mesh.vertices, shapes[k].mesh.vertices);
            }
            EXPECT_LT((high - 0.5F * size.cast<float>()).cwiseAbs().maxCoeff(), 1e-5F);
            EXPECT_LT((low + 0.5F * size.cast<float>()).cwiseAbs().maxCoeff(), 1e-5F);
        }
    }
}

}  // namespace
