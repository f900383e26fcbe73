#include "djpete/background/octo_background.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "djpete/obs/errors.h"
#include "djpete_test/shared_data.h"
#include "made_up_street.h"

namespace {

using namespace djpete_test;
using background::OctoBackground;
using background::OctoOptions;

constexpr int kFrames = 10;

OctoBackground drive(bool withBoxes, const OctoOptions& options = OctoOptions()) {
    OctoBackground tree(options);
    for (int f = 0; f < kFrames; ++f) tree.addView(Street::view(f, withBoxes));
    return tree;
}

std::size_t leftOfMover(const OctoBackground& tree) {
    std::size_t count = 0;
    for (int f = 0; f < kFrames; ++f) {
        count += occupiedIn(tree, Street::T_world_mover(f), kCarSize);
    }
    return count;
}

std::size_t leftOfParked(const OctoBackground& tree) {
    return occupiedIn(tree, Street::T_world_parked(), kCarSize);
}

/// Share of the wall's face between x = 5 and 25 m, z = 0.5 and 3 m that is occupied.
double wallShare(const OctoBackground& tree) {
    int there = 0, all = 0;
    for (double x = 5; x < 25; x += 0.2) {
        for (double z = 0.5; z < 1.9; z += 0.2) {
            ++all;
            there += tree.isOccupied({x, 7.101, z}) ? 1 : 0;
        }
    }
    return double(there) / all;
}

double roadShare(const OctoBackground& tree) {
    int there = 0, all = 0;
    for (double x = 6; x < 20; x += 0.2) {
        for (double y = -1.9; y < 1.9; y += 0.2) {
            ++all;
            there += tree.isOccupied({x, y, -0.01}) || tree.isOccupied({x, y, 0.01}) ? 1 : 0;
        }
    }
    return double(there) / all;
}

std::string bytesOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::stringstream out;
    out << in.rdbuf();
    return out.str();
}

TEST(OctoBackground, ObjectsLeaveNoVoxelAndTheStreetStays) {
    OctoBackground tree = drive(true);
    tree.finish(streetMap(kFrames));
    EXPECT_EQ(leftOfMover(tree), 0U);
    EXPECT_EQ(leftOfParked(tree), 0U);
    EXPECT_GT(wallShare(tree), 0.95);
    EXPECT_GT(roadShare(tree), 0.95);
}

TEST(OctoBackground, WithoutBoxesTheObjectsAreThere) {
    // What the other tests would not find if they looked in the wrong place.
    OctoBackground tree = drive(false);
    tree.finish(streetMap(kFrames));
    EXPECT_GT(leftOfParked(tree), 100U);
    OctoBackground once;
    once.addView(Street::view(3, false));
    EXPECT_GT(occupiedIn(once, Street::T_world_mover(3), kCarSize), 30U);
}

TEST(OctoBackground, RaysCarveWhatMovedAwayUnnoticed) {
    // No box says that the car moved, and no map at the end.
    OctoBackground tree;
    for (int f = 0; f < 2; ++f) tree.addView(Street::view(f, false));
    const Vec3 body(kCarSize.x(), kCarSize.y(), kCarSize.z());
    const std::size_t before = occupiedIn(tree, Street::T_world_mover(1), body, 0.4);
    EXPECT_GT(before, 30U);
    for (int f = 2; f < kFrames; ++f) tree.addView(Street::view(f, false, /*withMover*/ false));
    EXPECT_LE(occupiedIn(tree, Street::T_world_mover(1), body, 0.4), before / 50);
    EXPECT_GT(wallShare(tree), 0.95);
    EXPECT_GT(roadShare(tree), 0.95);
}

TEST(OctoBackground, TheMapsFinalBoxesAreCleared) {
    // Nobody knew of the objects while driving; the map does at the end.
    OctoBackground tree = drive(false);
    auto map = streetMap(kFrames);
    addTrack(map, 0, false, [](int) { return Street::T_world_parked(); });
    addTrack(map, 1, true, [](int f) { return Street::T_world_mover(f); });
    tree.finish(map);
    EXPECT_EQ(leftOfMover(tree), 0U);
    EXPECT_EQ(leftOfParked(tree), 0U);
    EXPECT_GT(wallShare(tree), 0.95);
    EXPECT_GT(roadShare(tree), 0.95);
    EXPECT_GT(tree.counters().at("octomap voxels cleared"), 100U);
}

TEST(OctoBackground, IsBuiltAgainWhereTheKeyframesAreInTheEnd) {
    OctoBackground tree = drive(true);
    const SE3 correction = SE3::fromYaw(0, {0, 0, 10});
    tree.finish(streetMap(kFrames, correction));
    EXPECT_EQ(tree.counters().at("octomap rebuilds"), 1U);
    EXPECT_FALSE(tree.isOccupied({10, 7.101, 1.1}));
    EXPECT_TRUE(tree.isOccupied({10, 7.101, 11.1}));
    OctoBackground still = drive(true);
    still.finish(streetMap(kFrames, SE3::fromYaw(0, {0, 0.05, 0})));
    EXPECT_EQ(still.counters().at("octomap rebuilds"), 0U);
}

TEST(OctoBackground, ReloadedTreesHaveTheColours) {
    OctoBackground tree = drive(true);
    tree.finish(streetMap(kFrames));
    const auto folder = djpete_test::scratch("octo_reload");
    tree.writeOt((folder / "a.ot").string());
    tree.writeBt((folder / "a.bt").string());
    const std::unique_ptr<octomap::AbstractOcTree> read(
        octomap::AbstractOcTree::read((folder / "a.ot").string()));
    const auto* colours = dynamic_cast<octomap::ColorOcTree*>(read.get());
    ASSERT_TRUE(colours);
    EXPECT_EQ(colours->size(), tree.nodes());
    std::size_t wall = 0, road = 0, other = 0;
    for (auto leaf = colours->begin_leafs(); leaf != colours->end_leafs(); ++leaf) {
        if (!colours->isNodeOccupied(*leaf) || !leaf->isColorSet()) continue;
        const auto c = leaf->getColor();
        const Rgb rgb{c.r, c.g, c.b};
        (rgb == kWall ? wall : rgb == kRoad ? road : other) += 1;
    }
    EXPECT_GT(wall, 500U);
    EXPECT_GT(road, 500U);
    EXPECT_LT(other, (wall + road) / 20);  // seams
    octomap::OcTree binary(0.1);
    ASSERT_TRUE(binary.readBinary((folder / "a.bt").string()));
    EXPECT_DOUBLE_EQ(binary.getResolution(), 0.2);
    const auto* node = binary.search(10, 7.101, 1.1);
    ASSERT_TRUE(node);
    EXPECT_TRUE(binary.isNodeOccupied(node));
    EXPECT_THROW(tree.writeOt("/nowhere/a.ot"), djpete::obs::InputError);
}

TEST(OctoBackground, WhatNoImageShowedTakesItsNeighboursColour) {
    std::array<std::size_t, 3> coloured{};
    std::size_t occupied = 0;
    for (const unsigned reach : {0U, 1U, 2U}) {
        OctoOptions options;
        options.colour_reach_voxels = reach;
        OctoBackground tree = drive(true, options);
        tree.finish(streetMap(kFrames));
        coloured[reach] = tree.points().size();
        occupied = tree.points(true).size();
        EXPECT_EQ(tree.counters().at("octomap voxels with a neighbour's colour") > 0, reach > 0);
    }
    EXPECT_GT(coloured[1], coloured[0]);
    EXPECT_GT(coloured[2], coloured[1]);
    EXPECT_LT(coloured[2], occupied);  // what is far behind has none
}

TEST(OctoBackground, SameViewsSameBytes) {
    const auto folder = djpete_test::scratch("octo_same");
    for (const char* name : {"a.ot", "b.ot"}) {
        OctoBackground tree = drive(true);
        tree.finish(streetMap(kFrames));
        tree.writeOt((folder / name).string());
    }
    EXPECT_EQ(bytesOf(folder / "a.ot"), bytesOf(folder / "b.ot"));
}

TEST(OctoBackground, KeepsItsLimitsAndSaysSo) {
    OctoOptions options;
    options.max_nodes = 20000;
    options.max_stored_points = 5000;
    OctoBackground tree = drive(true, options);
    EXPECT_LE(tree.nodes(), 20000U);
    EXPECT_LE(tree.storedPoints(), 5000U);
    EXPECT_GT(tree.storedPoints(), 1000U);
    EXPECT_GT(tree.counters().at("rejected: octomap voxels beyond max_nodes"), 0U);
}

TEST(OctoBackground, WorksFromStereoToo) {
    OctoBackground tree;
    for (int f = 0; f < 3; ++f) {
        auto view = Street::view(f, true);
        const BoxWorld world = Street::at(f, true, /*speckle*/ 0.15);
        auto& camera = view.images.camera.model;
        camera = {400, 400, 399.5, 119.5, 0.5, 800, 240};  // finer: stereo needs it
        view.images.left = world.image(camera, view.T_world_cam);
        view.images.right = world.image(
            camera, view.T_world_cam * SE3(djpete::geometry::Mat3::Identity(), Vec3(0.5, 0, 0)));
        view.scan.reset();
        tree.addView(view);
    }
    tree.finish(streetMap(3));
    EXPECT_EQ(leftOfParked(tree), 0U);
    // Of the wall beside the road what stereo can tell: within two voxels of where it is.
    std::size_t there = 0, all = 0;
    for (double x = 8; x < 16; x += 0.2) {
        for (double z = 0.5; z < 1.9; z += 0.2) {
            bool hit = false;
            for (const double off : {-0.4, -0.2, 0.0, 0.2}) {
                hit = hit || tree.isOccupied({x, 7.101 + off, z});
            }
            ++all;
            there += hit ? 1U : 0U;
        }
    }
    EXPECT_GT(there, all / 2) << all;
}

TEST(OctoBackground, FreeSpaceIsKeptOnlyIfWanted) {
    OctoOptions lean;
    lean.store_free_space = false;
    OctoBackground full = drive(true), sparse = drive(true, lean);
    const Vec3 inTheAir(10, 0, 1.1);
    EXPECT_TRUE(full.isFree(inTheAir));
    EXPECT_FALSE(sparse.isFree(inTheAir));
    EXPECT_LT(sparse.nodes(), full.nodes() / 3);
    full.finish(streetMap(kFrames));
    sparse.finish(streetMap(kFrames));
    EXPECT_EQ(leftOfMover(sparse), 0U);
    EXPECT_GT(wallShare(sparse), 0.95);
    EXPECT_GT(roadShare(sparse), 0.95);
}

}  // namespace
