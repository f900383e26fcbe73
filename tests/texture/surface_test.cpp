#include "djpete/texture/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "box_world.h"
#include "made_car.h"

namespace {

using namespace djpete::texture;
using djpete_test::MadeCar;
using djpete_test::Vec3;

/// Points of a closed box, every face in its own colour.
ObjectModel boxModel(const Vec3& size, double step = 0.04) {
    ObjectModel model;
    model.size_m = size;
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {-1, 1}) {
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            for (double u = -size[a] / 2 + step / 2; u < size[a] / 2; u += step) {
                for (double v = -size[b] / 2 + step / 2; v < size[b] / 2; v += step) {
                    Vec3 p, n = Vec3::Zero();
                    p[axis] = side * size[axis] / 2;
                    p[a] = u;
                    p[b] = v;
                    n[axis] = side;
                    model.addPoint({static_cast<float>(p.x()), static_cast<float>(p.y()),
                                    static_cast<float>(p.z())},
                                   {static_cast<float>(n.x()), static_cast<float>(n.y()),
                                    static_cast<float>(n.z())},
                                   static_cast<float>(step));
                    const auto level = static_cast<float>(100 + 50 * side);
                    std::array<float, 3> rgb{20, 20, 20};
                    rgb[static_cast<unsigned>(axis)] = level;
                    model.colours.back().add(rgb, 1);
                }
            }
        }
    }
    return model;
}

Vec3 positionOf(const ColouredMesh::Vertex& v) {
    return {v.position[0], v.position[1], v.position[2]};
}

double volumeOf(const ColouredMesh& mesh) {
    double volume = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3 a = positionOf(mesh.vertices[t[0]]), b = positionOf(mesh.vertices[t[1]]),
                   c = positionOf(mesh.vertices[t[2]]);
        volume += a.dot(b.cross(c)) / 6;
    }
    return volume;
}

/// How often each undirected edge occurs.
std::map<std::pair<uint32_t, uint32_t>, int> edgesOf(const ColouredMesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (const auto& t : mesh.triangles) {
        for (unsigned k = 0; k < 3; ++k) {
            const uint32_t a = t[k], b = t[(k + 1) % 3];
            ++edges[{std::min(a, b), std::max(a, b)}];
        }
    }
    return edges;
}

TEST(Surface, OfABoxIsClosedAndClose) {
    const Vec3 size(2, 1.2, 0.8);
    const ColouredMesh mesh = makeMesh(boxModel(size));
    ASSERT_GT(mesh.triangles.size(), 2000U);
    for (const auto& [edge, count] : edgesOf(mesh)) ASSERT_EQ(count, 2);
    double furthest = 0;
    for (const auto& v : mesh.vertices) {
        const Vec3 p = positionOf(v);
        const Vec3 beyond = p.cwiseAbs() - 0.5 * size;
        const double outside = beyond.cwiseMax(0).norm();
        furthest = std::max(furthest, outside > 0 ? outside : -beyond.maxCoeff());
    }
    EXPECT_LT(furthest, 0.03);
    EXPECT_NEAR(volumeOf(mesh), size.prod(),
                0.05 * size.prod());  // positive: triangles face outwards
}

TEST(Surface, TakesTheColoursOfItsPoints) {
    const Vec3 size(2, 1.2, 0.8);
    const ObjectModel model = boxModel(size);
    const ColouredMesh mesh = makeMesh(model);
    std::size_t checked = 0;
    for (const auto& v : mesh.vertices) {
        const auto on = djpete_test::nearestFace(positionOf(v), size);
        if (on.toEdge_m < 0.1) continue;
        ++checked;
        std::array<uint8_t, 3> want{20, 20, 20};
        want[static_cast<unsigned>(on.face / 2)] = on.face % 2 == 0 ? 150 : 50;
        ASSERT_EQ(v.rgb, want) << positionOf(v).transpose();
        EXPECT_GT(std::abs(v.normal[static_cast<unsigned>(on.face / 2)]), 0.95F);
    }
    EXPECT_GT(checked, 1000U);
}

TEST(Surface, TheAtlasHasASquareForEveryFacet) {
    MeshOptions options;
    options.block_px = 5;
    const ColouredMesh mesh = makeMesh(boxModel({1, 1, 1}), options);
    const MeshAtlas& atlas = mesh.atlas;
    ASSERT_EQ(atlas.corners.size(), mesh.triangles.size());
    ASSERT_EQ(atlas.rgb.size(), std::size_t{atlas.width_px} * atlas.height_px);
    EXPECT_GE(atlas.rgb.size(), 25 * mesh.triangles.size() / 2);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (unsigned k = 0; k < 3; ++k) {
            const auto& uv = atlas.corners[t][k];
            const auto x = static_cast<std::size_t>(uv[0] * static_cast<float>(atlas.width_px));
            const auto y = static_cast<std::size_t>(uv[1] * static_cast<float>(atlas.height_px));
            ASSERT_LT(x, atlas.width_px);
            ASSERT_LT(y, atlas.height_px);
            const auto& texel = atlas.rgb[y * atlas.width_px + x];
            const auto& vertex = mesh.vertices[mesh.triangles[t][k]].rgb;
            for (unsigned c = 0; c < 3; ++c) EXPECT_NEAR(texel[c], vertex[c], 1) << t;
        }
    }
}

TEST(Surface, OfACarHasNothingFarFromItsPoints) {
    const MadeCar car;
    const ColouredMesh mesh = makeMesh(car.model());
    EXPECT_GT(mesh.triangles.size(), 10000U);
    for (const auto& v : mesh.vertices) {
        const Vec3 p = positionOf(v);
        EXPECT_LT(std::abs(p.x()), 2.1 + 0.08);
        EXPECT_LT(std::abs(p.y()), 0.9 + 0.08);
        EXPECT_GT(p.z(), -0.75 - 0.08);  // open below
    }
}

/// Points of two sides and half a roof of a box are enough for a closed body of about the box.
TEST(Surface, ClosesWhatNobodySaw) {
    const Vec3 size(3, 1.6, 1.2);
    const ObjectModel whole = boxModel(size);
    std::vector<bool> seen;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        seen.push_back(std::abs(whole.normals[i][1]) > 0.5F ||
                       (whole.normals[i][2] > 0.5F && whole.point(i)[0] > 0));
    }
    const ObjectModel model = whole.subset(seen);
    EXPECT_LT(volumeOf(makeMesh(model)), 0.9 * size.prod());
    MeshOptions options;
    options.close = true;
    const ColouredMesh mesh = makeMesh(model, options);
    for (const auto& [edge, count] : edgesOf(mesh)) ASSERT_EQ(count % 2, 0);
    EXPECT_NEAR(volumeOf(mesh), size.prod(), 0.06 * size.prod());
    for (const auto& v : mesh.vertices) {
        const Vec3 p = positionOf(v), beyond = p.cwiseAbs() - 0.5 * size;
        const double outside = beyond.cwiseMax(0).norm();
        EXPECT_LT(outside > 0 ? outside : -beyond.maxCoeff(), 0.12) << p.transpose();
        EXPECT_NE(v.rgb, (std::array<uint8_t, 3>{128, 128, 128}));
    }
}

TEST(Surface, GoesNotWhereRaysPassed) {
    const Vec3 size(3, 1.6, 1.2);
    const ObjectModel whole = boxModel(size);
    std::vector<bool> seen;
    for (const auto& n : whole.normals) seen.push_back(n[0] < 0.5F);
    ObjectModel model = whole.subset(seen);
    // The box reaches 0.8 m farther ahead than the thing; rays passed there.
    model.size_m.x() += 1.6;
    MeshOptions options;
    options.close = true;
    const auto front = [&] {
        float x = -9;
        for (const auto& v : makeMesh(model, options).vertices) x = std::max(x, v.position[0]);
        return x;
    };
    EXPECT_GT(front(), 2.0F);
    model.freeSpace.reset(model.size_m);
    for (double x = 1.55; x < 2.6; x += 0.05) {
        for (double z = -0.8; z < 0.8; z += 0.05) model.freeSpace.addRay({x, 5, z}, {x, -5, z});
    }
    EXPECT_LT(front(), 1.7F);
}

/// Colours reach as far as discs do, and a few stray points are no surface.
TEST(Surface, OfLargeDiscsHasNoGreyRims) {
    ObjectModel model = boxModel({3, 1.6, 1.2}, 0.2);
    std::size_t colours = 0;
    for (const auto& v : makeMesh(model).vertices) {
        colours += v.rgb == std::array<uint8_t, 3>{128, 128, 128} ? 0U : 1U;
    }
    EXPECT_EQ(colours, makeMesh(model).vertices.size());
    const std::size_t triangles = makeMesh(model).triangles.size();
    for (float x = 0; x < 0.5F; x += 0.1F) model.addPoint({x, 0, 2.0F}, {0, 0, 1}, 0.15F);
    EXPECT_EQ(makeMesh(model).triangles.size(), triangles);
}

TEST(Surface, LoosePointsAndEmptyModelsAreNoSurface) {
    EXPECT_TRUE(makeMesh(ObjectModel()).triangles.empty());
    ObjectModel lonely;
    lonely.addPoint({0, 0, 0}, {0, 0, 1}, 0.04F);
    EXPECT_TRUE(makeMesh(lonely).triangles.empty());
    ObjectModel far = boxModel({1, 1, 1});
    far.addPoint({80, 0, 0}, {0, 0, 1}, 0.04F);  // a wild point must not take all memory
    EXPECT_FALSE(makeMesh(far).triangles.empty());
}

}  // namespace
