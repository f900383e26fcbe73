/// Real KITTI labels as detections: one labelled car, one object.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>

#include "djpete/backend/map_keeper.h"
#include "djpete/geometry/mrpt_bridge.h"
#include "djpete_test/shared_data.h"

namespace djpete::backend {
namespace {

using geometry::Mat3;
using geometry::SE3;
using geometry::Vec3;

struct Label {
    int track = 0;
    obs::ObjectDetection detection;  ///< in cam
};

std::map<uint64_t, std::vector<Label>> readLabels(const std::filesystem::path& path) {
    std::map<uint64_t, std::vector<Label>> out;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream in(line);
        uint64_t frame = 0;
        std::string type;
        double truncated = 0, occluded = 0, alpha = 0, l = 0, t = 0, r = 0, b = 0;
        double height = 0, width = 0, length = 0, x = 0, y = 0, z = 0, ry = 0;
        Label label;
        in >> frame >> label.track >> type >> truncated >> occluded >> alpha >> l >> t >> r >> b >>
            height >> width >> length >> x >> y >> z >> ry;
        if (type != "Car" && type != "Van") continue;
        Mat3 R;  // obj: x along the length, z up, which is -y of cam
        R << std::cos(ry), std::sin(ry), 0, 0, 0, -1, -std::sin(ry), std::cos(ry), 0;
        label.detection.objectClass = obs::objectClassFromString(type);
        label.detection.size_m = {length, width, height};
        label.detection.T_sensor_obj = SE3(R, {x, y - height / 2, z});
        label.detection.information =
            obs::diagonalInformation(Vec3::Constant(0.1), Vec3::Constant(0.03));
        label.detection.source = "label_02";
        label.detection.sourceTrackId = label.track;
        out[frame].push_back(label);
    }
    return out;
}

std::vector<SE3> readPoses(const std::filesystem::path& path) {
    std::vector<SE3> out;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream in(line);
        Eigen::Matrix<double, 3, 4> m;
        for (int i = 0; i < 12; ++i) in >> m(i / 4, i % 4);
        out.push_back(SE3(m.leftCols<3>(), m.col(3)).normalised());
    }
    return out;
}

struct Outcome {
    std::map<int, std::set<map::ObjectId>> objectsOf;  ///< of each labelled track, >= 5 frames
    std::map<map::ObjectId, std::set<int>> tracksOf;
    std::vector<double> distance_m;
    std::size_t objects = 0;
};

/// Runs the drive and compares each object state with the labels of its frame.
Outcome run(const std::map<uint64_t, std::vector<Label>>& labels, const std::vector<SE3>& poses,
            uint64_t frames) {
    MapKeeper keeper({}, Mode::Lockstep);
    const SE3 T_vehicle_cam(geometry::opticalToVehicleAxes().rotation(), Vec3(0.27, 0, -0.08));
    std::map<int, unsigned> views;
    for (uint64_t i = 0; i < frames; ++i) {
        auto kf = obs::CObservationVisualKeyframe::Create();
        kf->frame = {i};
        kf->timestamp = mrpt::Clock::fromDouble(1.3e9 + 0.1 * static_cast<double>(i));
        kf->isKeyframe = i % 3 == 0;
        kf->camera = {721.5377, 721.5377, 609.5593, 172.854, 0, 1242, 375};
        kf->sensorPose = geometry::toCPose3D(T_vehicle_cam);
        kf->T_odom_cam = T_vehicle_cam * poses[i];
        auto detections = obs::CObservationDetectedObjects::Create();
        detections->sensorPose = kf->sensorPose;
        if (labels.count(i) != 0) {
            for (const auto& l : labels.at(i)) {
                detections->detections.push_back(l.detection);
                ++views[l.track];
            }
        }
        keeper.addFrame(kf, detections);
    }
    keeper.finish();
    const auto& map = keeper.map();
    map.check();

    Outcome out;
    out.objects = map.objects().size();
    for (const auto& [track, n] : views) {
        if (n >= 5) out.objectsOf[track];
    }
    for (const auto& [id, object] : map.objects()) {
        for (const auto& [frame, state] : object.states) {
            const SE3 T_cam_obj = map.cameraAt(frame)->inverse() * map.T_world_obj(state);
            double nearest = 1.5;
            int track = -1;
            for (const auto& l : labels.at(frame.value)) {
                const double d =
                    (l.detection.T_sensor_obj.translation() - T_cam_obj.translation()).norm();
                if (d < nearest) {
                    nearest = d;
                    track = l.track;
                }
            }
            if (track < 0) {
                ADD_FAILURE() << "object " << id.value << " is nobody in frame " << frame.value;
                continue;
            }
            out.tracksOf[id].insert(track);
            out.distance_m.push_back(nearest);
            if (out.objectsOf.count(track) != 0) out.objectsOf[track].insert(id);
        }
    }
    std::sort(out.distance_m.begin(), out.distance_m.end());
    return out;
}

void expectOneObjectEach(const std::string& sequence, uint64_t maxFrames) {
    const auto root = djpete_test::shared("data");
    if (!root) GTEST_SKIP() << "skipped: needs shared data";
    const auto labels =
        readLabels(*root / "kitti/tracking/training/label_02" / (sequence + ".txt"));
    const auto poses =
        readPoses(*root / "trajectories" / ("kitti_tracking_" + sequence + "_orbslam3_stereo.txt"));
    ASSERT_FALSE(labels.empty());
    const auto outcome = run(labels, poses, std::min<uint64_t>(maxFrames, poses.size()));
    ASSERT_FALSE(outcome.distance_m.empty());
    const double median_m = outcome.distance_m[outcome.distance_m.size() / 2];
    unsigned alone = 0;
    for (const auto& [track, objects] : outcome.objectsOf) {
        alone += objects.size() == 1 ? 1U : 0U;
        EXPECT_EQ(objects.size(), 1U) << "labelled track " << track;
    }
    for (const auto& [id, tracks] : outcome.tracksOf) {
        EXPECT_EQ(tracks.size(), 1U) << "object " << id.value << " mixes labelled tracks";
    }
    std::cout << "tracking " << sequence << ": " << alone << " of " << outcome.objectsOf.size()
              << " labelled cars are one object each; " << outcome.objects
              << " objects; median distance to the label " << median_m << " m\n";
    EXPECT_LE(median_m, 0.20);
}

TEST(RealTracking, drive0005Frames0To24) { expectOneObjectEach("0000", 25); }
TEST(RealTracking, wholeOfDrive0000) { expectOneObjectEach("0000", 10000); }

}  // namespace
}  // namespace djpete::backend
