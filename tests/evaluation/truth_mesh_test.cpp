/// Reading and seeing true shapes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "djpete/evaluation/truth_mesh.h"
#include "djpete/obs/errors.h"
#include "made_board.h"

namespace djpete::evaluation {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const char* const kHead =
    "ply\nformat binary_little_endian 1.0\ncomment anything\nelement vertex 3\n"
    "property float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

std::string triangle(int lastCorner) {
    std::string out = kHead;
    const auto put = [&out](const void* data, std::size_t n) {
        out.append(static_cast<const char*>(data), n);
    };
    for (float x : {0.F, 1.F, 2.F}) {
        const float v[6] = {x, x * x, 0, 0, 0, 1};
        const uint8_t colour[3] = {10, 20, static_cast<uint8_t>(30 + x)};
        put(v, sizeof v);
        put(colour, sizeof colour);
    }
    const uint8_t three = 3;
    const int32_t corners[3] = {0, 1, lastCorner};
    put(&three, 1);
    put(corners, sizeof corners);
    return out;
}

std::string fileWith(const std::string& content) {
    const auto path = std::filesystem::path(testing::TempDir()) / "djpete_truth_mesh.ply";
    std::ofstream(path, std::ios::binary) << content;
    return path.string();
}

TEST(TruthMesh, readsWhatTheSimulatorWrites) {
    const TruthMesh mesh = readTruthMesh(fileWith(triangle(2)));
    ASSERT_EQ(mesh.size(), 3U);
    EXPECT_EQ(mesh.points[2], (std::array<float, 3>{2, 4, 0}));
    EXPECT_EQ(mesh.normals[1], (std::array<float, 3>{0, 0, 1}));
    EXPECT_EQ(mesh.srgb[2], (std::array<uint8_t, 3>{10, 20, 32}));
    ASSERT_EQ(mesh.triangles.size(), 1U);
    EXPECT_EQ(mesh.triangles[0], (std::array<uint32_t, 3>{0, 1, 2}));
    EXPECT_NEAR(mesh.area_m2[0], 1.0 / 3, 1e-6);  // corners (0,0), (1,1), (2,4): area 1
}

TEST(TruthMesh, brokenFilesAreNamed) {
    const auto reading = [](const std::string& content) {
        return [file = fileWith(content)] { readTruthMesh(file); };
    };
    const std::string good = triangle(2);
    EXPECT_THAT(reading(good.substr(0, good.size() - 1)),
                ThrowsMessage<obs::InputError>(HasSubstr("ends early")));
    EXPECT_THAT(reading(triangle(3)), ThrowsMessage<obs::InputError>(HasSubstr("corner 3")));
    EXPECT_THAT(reading("ply\nformat ascii 1.0\n"),
                ThrowsMessage<obs::InputError>(HasSubstr("djpete_truth_mesh.ply: PLY header")));
    EXPECT_THAT([] { readTruthMesh("/no/such.ply"); },
                ThrowsMessage<obs::InputError>(HasSubstr("/no/such.ply: cannot be opened")));
}

TEST(TruthMesh, aBoardFillsItsRectangleWithItsDepth) {
    const MadeBoard board;
    const auto view = viewOfMesh(board.mesh, board.camera, board.T_cam_obj);
    // 2 m x 1 m at 6 m with 300 px: 100 x 50 px around (160, 80).
    for (int v = 80 - 24; v <= 80 + 24; ++v) {
        for (int u = 160 - 49; u <= 160 + 49; ++u) {
            const auto at = view.at(u, v);
            ASSERT_TRUE(at);
            ASSERT_NEAR(view.depth_m[*at], MadeBoard::kDistance_m, 1e-4) << u << ' ' << v;
            ASSERT_NE(view.vertex[*at], MeshView::kNothing);
        }
    }
    EXPECT_EQ(view.at(160 - 60, 80), std::nullopt);
}

TEST(TruthMesh, theNearerOfTwoSurfacesIsSeen) {
    const MadeBoard board;
    TruthMesh two = board.mesh;
    const auto offset = static_cast<uint32_t>(two.size());
    for (std::size_t i = 0; i < offset; ++i) {
        two.points.push_back({two.points[i][0] + 0.5F, two.points[i][1], two.points[i][2]});
        two.normals.push_back(two.normals[i]);
        two.srgb.push_back(two.srgb[i]);
        two.area_m2.push_back(two.area_m2[i]);
    }
    const auto triangles = two.triangles;
    for (const auto& t : triangles) {
        two.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    }
    const auto view = viewOfMesh(two, board.camera, board.T_cam_obj);
    EXPECT_GE(view.vertex[*view.at(160, 80)], offset);
    const auto seen = verticesSeen(two, view, board.camera, board.T_cam_obj, 0.2, 25);
    EXPECT_FALSE(seen[offset / 2]);
    EXPECT_TRUE(seen[offset + offset / 2]);
}

}  // namespace
}  // namespace djpete::evaluation
