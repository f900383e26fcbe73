/// Recorded detections of KITTI's tracking benchmark through the whole line, judged as the
/// benchmark does: the figures below are what a change of the object code may not undercut.
#include <gtest/gtest.h>

#include <iostream>
#include <sstream>

#include "djpete/evaluation/tracking_errors.h"
#include "djpete/io/tracking_writer.h"
#include "djpete/observers/recorded_observer.h"
#include "djpete/pipeline/object_slam.h"
#include "djpete_test/shared_data.h"
#include "kitti2rawlog_app.h"

namespace djpete::pipeline {
namespace {

namespace fs = std::filesystem;

/// The drive as poses and detections; returns its rawlog.
fs::path convert(const fs::path& tracking, const fs::path& trajectories, const std::string& name,
                 const fs::path& folder) {
    const std::string input = (tracking / "training").string(),
                      detections =
                          (tracking / "detections/pointrcnn_car" / (name + ".txt")).string(),
                      poses = (trajectories / ("kitti_tracking_" + name + "_orbslam3_stereo.txt"))
                                  .string(),
                      out = (folder / (name + ".rawlog")).string();
    const std::vector<const char*> argv{
        "kitti2rawlog",     "--input", input.c_str(), "--sequence", name.c_str(), "--detections",
        detections.c_str(), "--poses", poses.c_str(), "--labels",   "none",       "--out",
        out.c_str()};
    kitti2rawlog::Kitti2RawlogApp app;
    std::ostringstream said;
    EXPECT_TRUE(app.initialize(int(argv.size()), argv.data()));
    app.run(said);
    return out;
}

/// Runs the drive and writes tracking.txt.
evaluation::TrackingSequence track(const fs::path& rawlog, const fs::path& tracking) {
    const auto options = ObjectSlamOptions::fromFile(std::string(DJPETE_SOURCE_DIR) +
                                                     "/datasets_cfg/kitti_tracking.ini");
    const auto companion = rawlog.parent_path() / (rawlog.stem().string() + "_objects.rawlog");
    ObjectSlam slam(options, fs::exists(companion)
                                 ? std::make_unique<observers::RecordedObserver>(companion)
                                 : std::make_unique<observers::RecordedObserver>());
    obs::RawlogSource source(rawlog);
    slam.setRig(source.info().mainCamera(source.path()));
    FramePrefetcher frames(source);
    while (const auto frame = frames.next()) slam.process(*frame);
    slam.finish();
    slam.map().check();
    io::writeTracking(slam.map(), tracking.string());
    return evaluation::readTrackingSequence(tracking.string());
}

TEST(RealTracking, threeDrivesWithDetectionsOfPointRcnn) {
    DJPETE_SHARED_OR_SKIP(tracking, "data/kitti/tracking");
    DJPETE_SHARED_OR_SKIP(trajectories, "data/trajectories");
    const auto folder = djpete_test::scratch("real_tracking");
    std::vector<evaluation::TrackingPair> drives;
    for (const std::string name : {"0000", "0006", "0010"}) {
        const auto results =
            track(convert(tracking, trajectories, name, folder), folder / (name + ".txt"));
        EXPECT_FALSE(results.boxes.empty()) << name;
        drives.push_back({evaluation::readTrackingSequence(
                              (tracking / "training/label_02" / (name + ".txt")).string()),
                          results});
    }
    const auto errors = evaluation::evaluateTracking(drives, {});
    const auto& quarter = errors.limits.at(0).counts;
    const auto& half = errors.limits.at(1).counts;
    std::cout << "MOTA " << *quarter.mota() << " at 0.25, " << *half.mota() << " at 0.5; HOTA "
              << errors.hota.hota << ", MOTP " << *quarter.motp() << ", switches "
              << quarter.switches << " and " << half.switches << "\n";
    EXPECT_GE(*quarter.mota(), 0.92);
    EXPECT_GE(*half.mota(), 0.905);
    EXPECT_GE(errors.hota.hota, 0.78);
    EXPECT_GE(*quarter.motp(), 0.82);
    EXPECT_EQ(quarter.switches, 0U);
    EXPECT_EQ(half.switches, 0U);
}

}  // namespace
}  // namespace djpete::pipeline
