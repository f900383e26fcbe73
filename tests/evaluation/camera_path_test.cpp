#include "djpete/evaluation/camera_path.h"

#include "djpete/geometry/mrpt_bridge.h"
#include "evaluation_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

/// A run of frames 5..14 out of a drive of 40 true poses.
struct PartOfDrive {
    ObjectsFile objects;
    TrajectoryFile estimate, truth;
    PartOfDrive() {
        const auto drive = windingPath(40);
        truth.path = "truth.txt";
        truth.poses = movedBy(SE3::fromYaw(0.7, {1, 2, 3}), drive);
        estimate.path = "est.txt";
        estimate.poses = startingAtIdentity({drive.begin() + 5, drive.begin() + 15});
        objects.path = "o.csv";
        objects.firstFrame = 5;
        objects.T_world_firstcam = djpete::geometry::opticalToVehicleAxes();
        ObjectRow row;
        row.line = 4;
        row.frame = 14;
        objects.rows.push_back(row);
    }
};

void expectSame(const CameraPath& a, const CameraPath& b) {
    EXPECT_EQ(a.firstFrame, b.firstFrame);
    ASSERT_EQ(a.T_world_cam.size(), b.T_world_cam.size());
    for (std::size_t i = 0; i < a.T_world_cam.size(); ++i) {
        EXPECT_LT((a.T_world_cam[i].matrix() - b.T_world_cam[i].matrix()).norm(), 1e-9);
    }
}

}  // namespace

TEST(CameraPath, RowsAreFramesFromTheFirst) {
    const PartOfDrive run;
    const auto cameras = estimatedCameras(run.objects, run.estimate, std::nullopt);
    EXPECT_EQ(cameras.firstFrame, 5U);
    EXPECT_TRUE(cameras.contains(14));
    EXPECT_FALSE(cameras.contains(15));
    EXPECT_FALSE(cameras.contains(4));
    const SE3 expected = run.objects.T_world_firstcam * run.estimate.poses[3];
    EXPECT_LT((cameras.at(8).matrix() - expected.matrix()).norm(), 1e-12);
}

TEST(CameraPath, TrueCamerasMeetTheRunsFirstCamera) {
    const PartOfDrive run;
    const FrameRange range{5, 15};
    const auto estimated = estimatedCameras(run.objects, run.estimate, range);
    expectSame(trueCameras(run.objects, run.truth, estimated, range), estimated);
    // Without a range, row 0 of the truth is the run's first frame.
    TrajectoryFile part = run.truth;
    part.poses = {run.truth.poses.begin() + 5, run.truth.poses.begin() + 15};
    expectSame(trueCameras(run.objects, part, estimated, std::nullopt), estimated);
}

TEST(CameraPath, ARangeInsideARunFromZero) {
    PartOfDrive run;
    run.objects.firstFrame = 0;
    run.estimate.poses = windingPath(30);
    const FrameRange range{10, 20};
    const auto estimated = estimatedCameras(run.objects, run.estimate, range);
    EXPECT_EQ(estimated.firstFrame, 10U);
    EXPECT_EQ(estimated.T_world_cam.size(), 10U);
    expectSame(trueCameras(run.objects, run.truth, estimated, range), estimated);
}

TEST(CameraPath, ContradictionsAreRefused) {
    PartOfDrive run;
    EXPECT_INPUT_ERROR(estimatedCameras(run.objects, run.estimate, FrameRange{6, 16}), "o.csv",
                       "frame 5", "frame 6");
    const auto estimated = estimatedCameras(run.objects, run.estimate, std::nullopt);
    TrajectoryFile brief = run.truth;
    brief.poses.resize(14);
    EXPECT_INPUT_ERROR(trueCameras(run.objects, brief, estimated, FrameRange{5, 15}), "truth.txt",
                       "14", "15");
    run.objects.rows[0].frame = 15;
    EXPECT_INPUT_ERROR(estimatedCameras(run.objects, run.estimate, std::nullopt), "o.csv:4",
                       "frame 15", "5 to 14");
    run.objects.rows[0].frame = 4;
    EXPECT_INPUT_ERROR(estimatedCameras(run.objects, run.estimate, std::nullopt), "o.csv:4",
                       "frame 4");
}
