/// Maps that are saved, gone on from, and localised in.
#include <gmock/gmock.h>

#include <fstream>

#include "djpete/evaluation/trajectory_reader.h"
#include "djpete/map/map_file.h"
#include "djpete_test/shared_data.h"
#include "drive.h"

namespace djpete_test {
namespace {

std::size_t standing(const djpete::map::SlamMap& map) {
    std::size_t n = 0;
    for (const auto& [id, object] : map.objects()) n += object.moving ? 0U : 1U;
    return n;
}

class Maps : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = scratch("e2e_maps");
        ASSERT_EQ(convert({"--input", smallDrive().string(), "--out",
                           (folder_ / "drive.rawlog").string(), "--labels", "none", "--detections",
                           (smallDrive() / "detections.txt").string()})
                      .code,
                  0);
        const auto outcome = run(first_, "first", {"--save-map", map().string()});
        ASSERT_EQ(outcome.code, 0) << outcome.sentence;
    }
    static Outcome run(djpete::apps::DjpeteSlamApp& app, const std::string& name,
                       std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(),
                         {(folder_ / "drive.rawlog").string(), "--out", (folder_ / name).string()});
        return slam(app, arguments);
    }
    static fs::path map() { return folder_ / "street.djmap"; }

    static fs::path folder_;
    static djpete::apps::DjpeteSlamApp first_;
};
fs::path Maps::folder_;
djpete::apps::DjpeteSlamApp Maps::first_;

TEST_F(Maps, ASavedMapIsTheMap) {
    const auto loaded = djpete::map::loadMap(map());
    const auto& made = first_.slam->map();
    EXPECT_EQ(loaded.map.keyframes().size(), made.keyframes().size());
    EXPECT_EQ(loaded.map.landmarks().size(), made.landmarks().size());
    EXPECT_EQ(loaded.map.objects().size(), made.objects().size());
    EXPECT_EQ(loaded.map.cameraAt({5})->matrix(), made.cameraAt({5})->matrix());
    EXPECT_EQ(loaded.info.sessions.size(), 1U);
    EXPECT_GT(loaded.info.textures.size(), 0U);
    for (const auto& [id, file] : loaded.info.textures) {
        EXPECT_TRUE(fs::exists(folder_ / file)) << file;
    }
}

TEST_F(Maps, ASecondDriveIsLocatedInTheFirstAndItsCarsAreTheSame) {
    djpete::apps::DjpeteSlamApp app;
    const auto both = folder_ / "both.djmap";
    const auto outcome = run(app, "second", {"--map", map().string(), "--save-map", both.string()});
    ASSERT_EQ(outcome.code, 0) << outcome.sentence;
    const auto& made = app.slam->map();
    EXPECT_EQ(app.summary.counters.at("worlds joined"), 1U);
    EXPECT_EQ(app.summary.frames, 12U);
    ASSERT_TRUE(app.summary.localisedAfter);
    EXPECT_LE(*app.summary.localisedAfter, 10U);
    // A car that moves is another one a drive later.
    EXPECT_EQ(standing(made), standing(first_.slam->map()));
    for (const uint64_t frame : {0U, 6U, 11U}) {
        const auto T =
            made.cameraAt({frame})->inverse() * *made.cameraAt(app.slam->frameInMap({frame}));
        EXPECT_LT(T.translation().norm(), 0.03) << frame;
        EXPECT_LT(T.angle_rad(), 0.002) << frame;
    }
    const auto loaded = djpete::map::loadMap(both);
    EXPECT_EQ(loaded.info.sessions.size(), 2U);
    EXPECT_EQ(loaded.map.frames().size(), 24U);
    // The second drive's own trajectory has a row for each of its frames.
    const auto rows =
        djpete::evaluation::readTrajectory((folder_ / "second" / "trajectory.kitti.txt").string());
    EXPECT_EQ(rows.poses.size(), 12U);
    EXPECT_THAT(textOf(folder_ / "second" / "loops.csv"), testing::HasSubstr("\n0,0,1,"));
}

TEST_F(Maps, LocalisingChangesNothing) {
    const auto before = textOf(map());
    djpete::apps::DjpeteSlamApp app;
    const auto outcome = run(app, "localised", {"--map", map().string(), "--localise"});
    ASSERT_EQ(outcome.code, 0) << outcome.sentence;
    EXPECT_EQ(app.summary.counters.at("worlds joined"), 1U);
    EXPECT_EQ(textOf(map()), before);
    for (const auto& [id, kf] : first_.slam->map().keyframes()) {
        EXPECT_EQ(app.slam->map().keyframes().at(id).T_world_cam.matrix(), kf.T_world_cam.matrix());
    }
}

TEST_F(Maps, WhatCannotWorkIsToldInOneSentence) {
    const auto broken = folder_ / "broken.djmap";
    auto bytes = textOf(map());
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x10);
    std::ofstream(broken, std::ios::binary) << bytes;
    djpete::apps::DjpeteSlamApp app;
    const auto damaged = run(app, "x", {"--map", broken.string()});
    EXPECT_EQ(damaged.code, 1);
    EXPECT_THAT(damaged.sentence, testing::HasSubstr("broken.djmap"));
    djpete::apps::DjpeteSlamApp other;
    EXPECT_THAT(run(other, "x", {"--map", (folder_ / "none.djmap").string()}).sentence,
                testing::HasSubstr("none.djmap"));
    djpete::apps::DjpeteSlamApp third;
    EXPECT_THAT(run(third, "x", {"--localise"}).sentence, testing::HasSubstr("needs --map"));
}

}  // namespace
}  // namespace djpete_test
