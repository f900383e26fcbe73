#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "djpete/io/graph_writer.h"
#include "djpete/obs/errors.h"
#include "small_map.h"

namespace {

using namespace djpete_test;

TEST(PoseGraph, ReadBackByMrptItIsTheSameToFifteenDigits) {
    const TestFolder folder;
    const auto map = smallMap();
    io::writePoseGraph(map, folder / "map.graph");
    const auto graph = io::makePoseGraph(map).graph;
    mrpt::graphs::CNetworkOfPoses3DInf read;
    read.loadFromTextFile(folder / "map.graph", false);
    // 3 keyframes, the parked car, the driving one at 3 keyframes.
    ASSERT_EQ(read.nodes.size(), 7U);
    EXPECT_EQ(read.root, graph.root);
    for (const auto& [id, pose] : graph.nodes) {
        for (int i = 0; i < 6; ++i) {
            EXPECT_NEAR(read.nodes.at(id)[static_cast<std::size_t>(i)],
                        pose[static_cast<std::size_t>(i)],
                        1e-14 * std::max(1.0, std::abs(pose[static_cast<std::size_t>(i)])));
        }
    }
    // 2 odometry, 4 detections of the parked car, 3 of the driving one.
    ASSERT_EQ(read.edges.size(), 9U);
    ASSERT_EQ(graph.edges.size(), 9U);
    auto mine = graph.edges.begin();
    for (const auto& [nodes, edge] : read.edges) {
        EXPECT_EQ(nodes, mine->first);
        const double scale = mine->second.cov_inv.asEigen().cwiseAbs().maxCoeff();
        EXPECT_LT((edge.cov_inv.asEigen() - mine->second.cov_inv.asEigen()).cwiseAbs().maxCoeff(),
                  1e-14 * scale);
        ++mine;
    }
}

TEST(PoseGraph, EdgesAgreeWithNodesWhereTheMapIsExact) {
    const auto graph = io::makePoseGraph(smallMap()).graph;
    for (const auto& [nodes, edge] : graph.edges) {
        // The parked car's detection of frame 4 hangs on keyframe 0 as well.
        const auto relative = graph.nodes.at(nodes.second) - graph.nodes.at(nodes.first);
        const SE3 apart =
            geometry::fromCPose3D(relative).inverse() * geometry::fromCPose3D(edge.mean);
        EXPECT_LT(apart.log().norm(), 1e-9) << nodes.first << " -> " << nodes.second;
    }
}

TEST(PoseGraph, InformationIsThatOfTheYawPitchRollParameters) {
    const auto map = smallMap();
    const auto graph = io::makePoseGraph(map).graph;
    const auto& edge = graph.edges.find({0, 3})->second;
    const geometry::Mat6 information =
        map.objects().begin()->second.observations.begin()->second.information;
    // Move the edge's six parameters a little: the cost must be what the twist says.
    Vec6 step;
    step << 1e-4, -2e-4, 1.5e-4, 1e-4, -0.5e-4, 0.7e-4;
    auto moved = edge.mean;
    moved.setFromValues(moved.x() + step[0], moved.y() + step[1], moved.z() + step[2],
                        moved.yaw() + step[3], moved.pitch() + step[4], moved.roll() + step[5]);
    const Vec6 twist =
        (geometry::fromCPose3D(edge.mean).inverse() * geometry::fromCPose3D(moved)).log();
    const double expected = twist.dot(information * twist);
    EXPECT_NEAR(step.dot(edge.cov_inv.asEigen() * step), expected, 1e-3 * expected);
}

TEST(PoseGraph, KeyframesThatShareLandmarksAreConnected) {
    auto map = smallMap();
    for (uint64_t k = 0; k < 3; ++k) {
        map::Keyframe kf = map.keyframes().at(map::KeyframeId{0});
        kf.frame = map::FrameId{100 + k};
        kf.features.resize(40);
        kf.landmarks.clear();
        map.addKeyframe(kf, true);
    }
    for (uint32_t i = 0; i < 40; ++i) {
        const auto landmark = map.addLandmark(Vec3(1, i, 0), {1, 2, 3});
        map.observe(landmark, map::KeyframeId{3}, i);
        map.observe(landmark, map::KeyframeId{5}, i);
    }
    const auto graph = io::makePoseGraph(map).graph;
    EXPECT_TRUE(graph.edgeExists(3, 5));
    EXPECT_FALSE(graph.edgeExists(0, 2));
}

TEST(PoseGraph, TheTableNamesEveryNode) {
    const TestFolder folder;
    io::writePoseGraph(smallMap(), folder / "map.graph");
    EXPECT_THAT(linesOf(folder / "map.graph.nodes.csv"),
                testing::ElementsAre("node,kind,keyframe_id,object_id,frame", "0,keyframe,0,,3",
                                     "1,keyframe,1,,5", "2,keyframe,2,,7", "3,static_object,,0,7",
                                     "4,moving_object,0,1,3", "5,moving_object,1,1,5",
                                     "6,moving_object,2,1,7"));
}

TEST(PoseGraph, AnEmptyMapIsNoCrash) {
    const TestFolder folder;
    io::writePoseGraph(map::SlamMap(), folder / "map.graph");
    EXPECT_EQ(linesOf(folder / "map.graph.nodes.csv").size(), 1U);
    EXPECT_THROW(io::writePoseGraph(map::SlamMap(), "/nowhere/map.graph"), obs::InputError);
}

}  // namespace
