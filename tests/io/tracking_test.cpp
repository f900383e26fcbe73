/// tracking.txt as KITTI's tracking benchmark wants it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "djpete/evaluation/tracking_reader.h"
#include "djpete/io/tracking_writer.h"
#include "djpete/obs/errors.h"
#include "small_map.h"

namespace {

using namespace djpete_test;
using evaluation::TrackingBox;
using evaluation::TrackingSequence;

io::TrackingOptions none() {
    io::TrackingOptions o;
    o.before = o.after = 0;
    return o;
}

/// What is read back of what was written.
TrackingSequence readBack(const map::SlamMap& map, const io::TrackingOptions& options,
                          uint64_t first = 3) {
    const TestFolder folder;
    io::writeTracking(map, folder / "tracking.txt", {first}, options);
    return evaluation::readTrackingSequence(folder / "tracking.txt");
}

const TrackingBox* find(const TrackingSequence& sequence, int64_t track, std::size_t frame) {
    for (const auto& box : sequence.boxes) {
        if (box.trackId == track && box.frame == frame) return &box;
    }
    return nullptr;
}

std::vector<std::size_t> framesOf(const TrackingSequence& sequence, int64_t track) {
    std::vector<std::size_t> out;
    for (const auto& box : sequence.boxes) {
        if (box.trackId == track) out.push_back(box.frame);
    }
    return out;
}

/// Cameras that stay level, one metre apart, so that upright boxes of KITTI can say all of a pose;
/// object 0 parked at `p_world`, seen in `frames`; frames 0..9, the even ones keyframes.
struct LevelDrive {
    map::SlamMap map;
    static SE3 camera(uint64_t frame) {
        return SE3::fromYaw(0.03 * static_cast<double>(frame), {double(frame), 0, 1.65}) *
               geometry::opticalToVehicleAxes();
    }
    LevelDrive() {
        for (uint64_t f = 0; f < 10; ++f) {
            const auto stamp = mrpt::Clock::fromDouble(kStart_s + 0.1 * static_cast<double>(f));
            if (f % 2 == 0) {
                map::Keyframe kf;
                kf.frame = {f};
                kf.stamp = stamp;
                kf.camera = {718.856, 718.856, 607.2, 185.2, 0.537, 1241, 376};
                kf.T_odom_cam = kf.T_world_cam = camera(f);
                map.addKeyframe(kf, true);
            } else {
                map.addFrame({{f},
                              stamp,
                              map.lastKeyframe()->id,
                              camera(f - 1).inverse() * camera(f),
                              true});
            }
        }
    }
    map::ObjectId add(const std::vector<uint64_t>& frames, const SE3& T_world_start,
                      const Vec6& twist = Vec6::Zero()) {
        map::ObjectTrack track;
        track.size_m = Vec3(4.1, 1.75, 1.52);
        track.moving = !twist.isZero();
        for (const uint64_t f : frames) {
            const SE3 T_world_obj = T_world_start * SE3::exp(0.1 * static_cast<double>(f) * twist);
            map::ObjectState state;
            state.frame = {f};
            state.anchor = map.frames().at({f}).reference;
            state.T_anchor_obj =
                map.keyframes().at(state.anchor).T_world_cam.inverse() * T_world_obj;
            state.twist = twist;
            track.states[{f}] = state;
            auto o = detection(f, camera(f).inverse() * T_world_obj);
            o.score = static_cast<float>(f);
            track.observations[{f}] = o;
        }
        return map.addObject(track);
    }
};

const SE3 kParked = SE3::fromYaw(0.4, {25, -4, 0.76});

TEST(TrackingWriter, whatIsReadBackIsWhereTheMapSays) {
    LevelDrive d;
    Vec6 twist = Vec6::Zero();
    twist[0] = 10;
    twist[5] = 0.3;
    d.add({2, 3, 4}, kParked);
    d.add({2, 3, 4}, SE3::fromYaw(2.5, {30, 3, 0.8}), twist);
    const auto sequence = readBack(d.map, none(), 0);
    ASSERT_EQ(sequence.boxes.size(), 6U);
    for (const auto& box : sequence.boxes) {
        const map::FrameId frame{box.frame};
        const SE3 T_world_obj = *d.map.objectPoseAt({static_cast<uint64_t>(box.trackId)}, frame);
        const SE3 T_cam_obj = d.map.cameraAt(frame)->inverse() * T_world_obj;
        EXPECT_LT((T_cam_obj.inverse() * box.T_cam_obj).log().norm(), 1e-3)
            << "object " << box.trackId << " in frame " << box.frame;
        EXPECT_LT((box.size_m - Vec3(4.1, 1.75, 1.52)).norm(), 1e-3);
        EXPECT_EQ(box.objectClass, obs::ObjectClass::Car);
    }
}

TEST(TrackingWriter, columnsAreThoseOfKitti) {
    // 10 m ahead of the camera and 2 m to its right, heading along its x axis; 1.65 m high eye.
    LevelDrive d;
    const SE3 T_cam_obj(geometry::opticalToVehicleAxes().rotation().transpose() *
                            geometry::so3Exp({0, 0, -M_PI / 2}),
                        {2, 0.89, 10});
    const SE3 T_world_obj = LevelDrive::camera(4) * T_cam_obj;
    d.add({4}, T_world_obj);
    const TestFolder folder;
    io::writeTracking(d.map, folder / "t.txt", {1}, none());
    const auto lines = linesOf(folder / "t.txt");
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_THAT(lines[0], testing::StartsWith("3 0 Car 0 -1 "));  // frames count from frame 1
    const auto v = numbersOf(lines[0].substr(8));                 // from `truncated`
    ASSERT_EQ(v.size(), 15U);
    EXPECT_NEAR(v[2], -std::atan2(2, 10), 1e-6);  // alpha = rotation_y - atan2(x, z)
    EXPECT_NEAR(v[7], 1.52, 1e-6);
    EXPECT_NEAR(v[8], 1.75, 1e-6);
    EXPECT_NEAR(v[9], 4.1, 1e-6);
    EXPECT_NEAR(v[10], 2, 1e-6);
    EXPECT_NEAR(v[11], 0.89 + 0.76, 1e-6);  // the bottom: y points down
    EXPECT_NEAR(v[12], 10, 1e-6);
    EXPECT_NEAR(v[13], 0, 1e-6);  // rotation_y: 0 along x
    EXPECT_NEAR(v[14], 4, 1e-6);  // the score
}

TEST(TrackingWriter, rotationIsAboutTheAxisThatPointsDown) {
    // A car that goes where the camera looks has -pi/2: from x by the right hand rule about y.
    LevelDrive d;
    d.add({0}, SE3::fromYaw(0, {20, 0, 0.76}));
    d.add({0}, SE3::fromYaw(M_PI, {20, 5, 0.76}));
    const TestFolder folder;
    io::writeTracking(d.map, folder / "t.txt", {0}, none());
    const auto lines = linesOf(folder / "t.txt");
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_NEAR(numbersOf(lines[0].substr(8))[13], -M_PI / 2, 1e-6);
    EXPECT_NEAR(numbersOf(lines[1].substr(8))[13], M_PI / 2, 1e-6);
}

TEST(TrackingWriter, gapsAreFilled) {
    LevelDrive d;
    Vec6 twist = Vec6::Zero();
    twist[0] = 8;
    d.add({2, 3, 6}, kParked);
    d.add({2, 3, 6}, SE3::fromYaw(0.1, {20, 3, 0.8}), twist);
    const auto sequence = readBack(d.map, none(), 0);
    for (const int64_t track : {0, 1}) {
        EXPECT_THAT(framesOf(sequence, track), testing::ElementsAre(2, 3, 4, 5, 6));
    }
    const SE3 T_world_obj = SE3::fromYaw(0.1, {20, 3, 0.8}) * SE3::exp(0.5 * twist);
    const auto* box = find(sequence, 1, 5);
    ASSERT_TRUE(box);
    const SE3 T_cam_obj = LevelDrive::camera(5).inverse() * T_world_obj;
    EXPECT_LT((box->T_cam_obj.translation() - T_cam_obj.translation()).norm(), 1e-3);
}

TEST(TrackingWriter, objectsGoOnBeforeAndAfterWithTheirTwist) {
    LevelDrive d;
    Vec6 twist = Vec6::Zero();
    twist[0] = 8;
    twist[5] = 0.2;
    const SE3 T_world_start = SE3::fromYaw(0.1, {20, 3, 0.8});
    d.add({3, 4, 5}, kParked);
    d.add({3, 4, 5}, T_world_start, twist);
    io::TrackingOptions o;
    o.before = 2;
    o.after = 1;
    const auto sequence = readBack(d.map, o, 0);
    for (const int64_t track : {0, 1}) {
        EXPECT_THAT(framesOf(sequence, track), testing::ElementsAre(1, 2, 3, 4, 5, 6));
    }
    for (const std::size_t frame : {1U, 2U, 6U}) {
        const SE3 T_world_obj = T_world_start * SE3::exp(0.1 * double(frame) * twist);
        const SE3 T_cam_obj = LevelDrive::camera(frame).inverse() * T_world_obj;
        EXPECT_LT((find(sequence, 1, frame)->T_cam_obj.inverse() * T_cam_obj).log().norm(), 1e-3);
    }
    // No frame before the drive's first nor after its last.
    o.before = o.after = 100;
    EXPECT_THAT(framesOf(readBack(d.map, o, 0), 1),
                testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
    EXPECT_THAT(framesOf(readBack(d.map, o, 4), 1), testing::ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(TrackingWriter, theImageBoxIsTheDetectionsElseTheProjection) {
    LevelDrive d;
    const auto id = d.add({4, 6}, kParked);
    auto track = d.map.objects().at(id);
    track.observations.at({4}).box = obs::ImageBox{10, 20, 110, 95};
    d.map.setObject(track);
    const auto sequence = readBack(d.map, none(), 0);
    const auto& seen = find(sequence, 0, 4)->image;
    EXPECT_EQ(seen.left, 10);
    EXPECT_EQ(seen.bottom, 95);
    // The projection holds the centre's and is about as high as the car: f h / z.
    const auto* projected = find(sequence, 0, 6);
    const Vec3 p_cam = projected->T_cam_obj.translation();
    const double u = 718.856 * p_cam.x() / p_cam.z() + 607.2;
    EXPECT_LT(projected->image.left, u);
    EXPECT_GT(projected->image.right, u);
    EXPECT_NEAR(projected->image.height(), 718.856 * 1.52 / p_cam.z(), 0.3 * 718.856 / p_cam.z());
    EXPECT_EQ(projected->truncation, 0);
}

TEST(TrackingWriter, boxesAreCutToTheImage) {
    // Close by at the left: the image ends in the middle of it.
    LevelDrive d;
    d.add({0}, SE3::fromYaw(0, {7, 5.9, 0.76}));
    const auto sequence = readBack(d.map, none(), 0);
    ASSERT_EQ(sequence.boxes.size(), 1U);
    const auto& box = sequence.boxes[0];
    EXPECT_EQ(box.image.left, 0);
    EXPECT_GT(box.image.right, 0);
    EXPECT_LE(box.image.bottom, 375);
    EXPECT_GT(box.truncation, 0.1);
    EXPECT_LT(box.truncation, 1);
}

TEST(TrackingWriter, whatIsBehindOrBesideTheImageHasNoRow) {
    LevelDrive d;
    d.add({0}, SE3::fromYaw(0, {-10, 0, 0.76}));  // behind
    d.add({0}, SE3::fromYaw(0, {10, 40, 0.76}));  // far to the side
    EXPECT_TRUE(readBack(d.map, none(), 0).boxes.empty());
    // It is passed by on the way: rows end when it is beside the camera.
    d.add({0, 9}, SE3::fromYaw(0, {6, -2, 0.76}));
    const auto frames = framesOf(readBack(d.map, none(), 0), 2);
    ASSERT_FALSE(frames.empty());
    EXPECT_LE(frames.back(), 5U);
}

TEST(TrackingWriter, aStandingObjectsViewsAreWhatIsWritten) {
    LevelDrive d;
    const auto id = d.add({2, 6}, kParked);
    const auto states = d.map.objects().at(id).states;
    // One view says 0.2 m to the left, the other 0.4 m: in between what lies between.
    const SE3 left = SE3::fromYaw(0, {0, 0.2, 0});
    d.map.setObjectEstimate(id, false, {4.1, 1.75, 1.52}, states,
                            {{{2}, LevelDrive::camera(2).inverse() * left * kParked},
                             {{6}, LevelDrive::camera(6).inverse() * left * left * kParked}});
    const auto sequence = readBack(d.map, none(), 0);
    for (std::size_t f = 2; f <= 6; ++f) {
        const SE3 T_world_obj = LevelDrive::camera(f) * find(sequence, 0, f)->T_cam_obj;
        EXPECT_NEAR(T_world_obj.translation().y() - kParked.translation().y(),
                    0.2 + 0.05 * static_cast<double>(f - 2), 1e-3);
    }
}

TEST(TrackingWriter, allRowsOfAnObjectHaveItsScore) {
    LevelDrive d;
    d.add({2, 3, 7}, kParked);
    const auto sequence = readBack(d.map, none(), 0);
    ASSERT_EQ(sequence.boxes.size(), 6U);
    for (const auto& box : sequence.boxes) EXPECT_NEAR(*box.score, 4, 1e-6);
}

TEST(TrackingWriter, anEmptyMapMakesAnEmptyFileAndABadPathIsSaid) {
    EXPECT_TRUE(readBack(map::SlamMap(), none(), 0).boxes.empty());
    try {
        io::writeTracking(smallMap(), "/nowhere/at/all/tracking.txt");
        ADD_FAILURE() << "no error";
    } catch (const obs::InputError& e) {
        EXPECT_THAT(e.what(), testing::StartsWith("/nowhere/at/all/tracking.txt: cannot be"));
    }
}

}  // namespace
