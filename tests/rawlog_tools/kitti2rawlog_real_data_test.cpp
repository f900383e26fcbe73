/// kitti2rawlog on real KITTI data (from ../shared) in every layout.
#include <gmock/gmock.h>
#include <mrpt/obs/gnss_messages.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "djpete/geometry/cuboid.h"
#include "djpete/geometry/mrpt_bridge.h"
#include "made_up_drive.h"

namespace fs = std::filesystem;
using djpete::geometry::SE3;
using djpete::geometry::Vec3;
using made_up::framesOf;
using testing::ElementsAre;

namespace {

const std::string kKitti = "data/kitti";
const std::string kDrive = "2011_09_26/2011_09_26_drive_0005_sync";

fs::path outIn(const std::string& name) { return djpete_test::scratch(name) / "d.rawlog"; }

/// Points of `scan` inside `d`, whose sensor is at `T_vehicle_sensor`.
int pointsInside(const djpete::obs::LidarScan& scan, const djpete::obs::ObjectDetection& d,
                 const SE3& T_vehicle_sensor) {
    const SE3 T_obj_velo = (T_vehicle_sensor * d.T_sensor_obj).inverse() * scan.T_vehicle_velo;
    int n = 0;
    for (const auto& p : scan.points)
        n += djpete::geometry::Cuboid{d.size_m}.contains(T_obj_velo * p.position()) ? 1 : 0;
    return n;
}

}  // namespace

TEST(Kitti2RawlogRealData, Odometry00HasStereoPosesAndSomeScans) {
    DJPETE_SHARED_OR_SKIP(kitti, kKitti);
    const auto out = outIn("k2r_00");
    const auto report = made_up::run(
        {"--input", (kitti / "odometry/sequences/00").string(), "--out", out.string()});
    EXPECT_EQ(report.frames, 100U);
    EXPECT_EQ(report.stereoPairs, 100U);
    EXPECT_EQ(report.scans, 18U);
    EXPECT_EQ(report.truthPoses, 100U) << "found in ../../poses";
    const auto frames = framesOf(out);
    ASSERT_EQ(frames.size(), 100U);
    EXPECT_TRUE(frames[94].hasScan() && frames[15].hasScan());
    EXPECT_FALSE(frames[93].hasScan() || frames[16].hasScan());
    EXPECT_NEAR(mrpt::Clock::toDouble(frames[1].stamp) - mrpt::Clock::toDouble(frames[0].stamp),
                0.1037359, 1e-6);
    const auto images = frames[0].loadMainImages();
    ASSERT_TRUE(images && images->right);
    EXPECT_EQ(images->left.getWidth(), 1241U);
    EXPECT_NEAR(images->camera.model.baseline_m, 386.1448 / 718.856, 1e-12);
    // Row 1 of the poses goes 0.859 m along the camera's z: forward on the vehicle.
    const Vec3 step = frames[1].T_world_vehicle_truth->translation();
    EXPECT_NEAR(step.x(), 0.8588, 1e-3);
    EXPECT_LT(step.tail<2>().norm(), 0.06);
    EXPECT_LT(frames[0].T_world_vehicle_truth->log().norm(), 1e-9);
}

TEST(Kitti2RawlogRealData, Odometry00ScansMeetTheImages) {
    DJPETE_SHARED_OR_SKIP(kitti, kKitti);
    const auto out = outIn("k2r_00_project");
    made_up::run({"--input", (kitti / "odometry/sequences/00").string(), "--out", out.string(),
                  "--range", "0:1"});
    const auto frame = framesOf(out).at(0);
    const auto scan = frame.loadScan();
    const auto images = frame.loadMainImages();
    ASSERT_TRUE(scan && images);
    // Where the scanner finds a depth, left and right image agree best at just its disparity.
    const SE3 T_cam_velo = images->camera.T_vehicle_cam.inverse() * scan->T_vehicle_velo;
    const auto& model = images->camera.model;
    const auto gray = [](const mrpt::img::CImage& i, double u, double v) {
        return static_cast<double>(*i.ptr<uint8_t>(static_cast<unsigned>(std::lround(u)),
                                                   static_cast<unsigned>(std::lround(v))));
    };
    std::map<int, double> difference;  // by pixels off the scanner's disparity
    int n = 0;
    for (const auto& p : scan->points) {
        const Vec3 p_cam = T_cam_velo * p.position();
        if (p_cam.z() < 4 || p_cam.z() > 30) continue;
        const Vec3 uvr = model.projectStereo(p_cam);
        if (!model.contains({uvr.x(), uvr.y()}, 2) || !model.contains({uvr.z(), uvr.y()}, 8))
            continue;
        ++n;
        for (int off = -6; off <= 6; ++off)
            difference[off] += std::abs(gray(images->left, uvr.x(), uvr.y()) -
                                        gray(*images->right, uvr.z() + off, uvr.y()));
    }
    EXPECT_GT(n, 10000);
    const auto best = std::min_element(difference.begin(), difference.end(),
                                       [](auto& a, auto& b) { return a.second < b.second; });
    EXPECT_EQ(best->first, 0);
}

TEST(Kitti2RawlogRealData, Odometry02IsColourStereo) {
    DJPETE_SHARED_OR_SKIP(kitti, kKitti);
    const auto out = outIn("k2r_02");
    const auto report = made_up::run(
        {"--input", (kitti / "odometry/sequences/02").string(), "--out", out.string()});
    EXPECT_EQ(report.stereoPairs, 20U);
    EXPECT_FALSE(report.info.gray);
    ASSERT_TRUE(report.info.color);
    EXPECT_NEAR(report.info.color->model.baseline_m, (337.2877 + 45.38225) / 718.856, 1e-9);
    const auto images = framesOf(out).at(19).loadMainImages();
    ASSERT_TRUE(images && images->right);
    EXPECT_TRUE(images->isColor());
}

TEST(Kitti2RawlogRealData, RawDrive0005LabelsSitOnTheirPoints) {
    DJPETE_SHARED_OR_SKIP(kitti, kKitti);
    const auto out = outIn("k2r_0005");
    const auto report = made_up::run(
        {"--input", (kitti / "raw" / kDrive).string(), "--out", out.string(), "--labels",
         (kitti / "tracking/training/label_02/0000.txt").string(), "--poses",
         (kitti / "../trajectories/kitti_tracking_0000_orbslam3_stereo.txt").string()});
    EXPECT_EQ(report.singleImages, 25U);
    EXPECT_EQ(report.scans, 25U);
    EXPECT_EQ(report.truthPoses, 25U);
    EXPECT_EQ(report.info.gray->model.baseline_m, 0) << "there is no right camera";
    EXPECT_EQ(report.info.gray->model.width_px, 1242);
    const auto frames = framesOf(out);
    const auto objects = djpete::obs::readDetections(out.parent_path() / "d_objects.rawlog");
    ASSERT_EQ(frames.size(), 25U);
    ASSERT_EQ(objects.size(), 25U);
    EXPECT_NEAR(mrpt::Clock::toDouble(frames[0].stamp), 1317042272.351950336, 1e-5);
    int near = 0, centred = 0;
    for (std::size_t i = 0; i < frames.size(); i += 6) {
        EXPECT_EQ(frames[i].stamp, objects[i]->timestamp);
        const auto scan = frames[i].loadScan();
        ASSERT_TRUE(scan);
        const SE3 T_vehicle_cam = djpete::geometry::fromCPose3D(objects[i]->sensorPose);
        for (const auto& d : objects[i]->detections) {
            if (d.T_sensor_obj.translation().z() > 25) continue;
            ++near;
            EXPECT_GT(pointsInside(*scan, d, T_vehicle_cam), 50)
                << "frame " << i << " " << djpete::obs::toString(d.objectClass) << " track "
                << *d.sourceTrackId;
            // The box's image is centred where the label has it: for camera 2, shifted to camera 0.
            const auto& model = report.info.gray->model;
            double left = 1e9, right = -1e9;
            for (const Vec3& c : djpete::geometry::Cuboid{d.size_m}.corners()) {
                const double u = model.project(d.T_sensor_obj * c).x();
                left = std::min(left, u);
                right = std::max(right, u);
            }
            ASSERT_TRUE(d.box);
            if (d.box->left < 1 || d.box->right > 1240) continue;
            EXPECT_NEAR(0.5 * (left + right), 0.5 * (d.box->left + d.box->right), 2.0)
                << "frame " << i << " track " << *d.sourceTrackId;
            ++centred;
        }
    }
    EXPECT_GE(near, 10);
    EXPECT_GE(centred, 8);
}

TEST(Kitti2RawlogRealData, RawFrameWithAllSensors) {
    DJPETE_SHARED_OR_SKIP(kitti, kKitti);
    const auto out = outIn("k2r_one");
    const auto report = made_up::run(
        {"--input", (kitti / "raw_one_frame" / kDrive).string() + "/", "--out", out.string()});
    EXPECT_EQ(report.stereoPairs, 2U);
    EXPECT_EQ(report.scans, 1U);
    EXPECT_EQ(report.oxtsPackets, 1U);
    const auto f = framesOf(out).at(0);
    EXPECT_TRUE(f.stereoGray && f.stereoColor && f.scan && f.gps && f.imu);
    const auto& gga = f.gps->getMsgByClass<mrpt::obs::gnss::Message_NMEA_GGA>().fields;
    EXPECT_NEAR(gga.latitude_degrees, 49.011212804408, 1e-12);
    EXPECT_NEAR(gga.longitude_degrees, 8.4228850417969, 1e-12);
    EXPECT_EQ(gga.satellitesUsed, 10U);
    EXPECT_EQ(f.gps->originalReceivedTimestamp, f.stamp);
    EXPECT_TRUE(f.gps->has_satellite_timestamp);
    EXPECT_NEAR(f.imu->get(mrpt::obs::IMU_Z_ACC), 9.9957015129717, 1e-9);
    EXPECT_NEAR(f.imu->get(mrpt::obs::IMU_YAW), -1.2219096732051, 1e-12);
    EXPECT_NEAR(f.imu->sensorPose.x(), -0.8086759, 1e-6);
    EXPECT_TRUE(f.loadTextureImages()->isColor());
    EXPECT_FALSE(f.loadMainImages()->isColor());
}

TEST(Kitti2RawlogRealData, TrackingWithoutImages) {
    DJPETE_SHARED_OR_SKIP(kitti, kKitti);
    const std::map<std::string, std::size_t> counts{{"0000", 154}, {"0006", 270}, {"0010", 294}};
    for (const auto& [sequence, frames] : counts) {
        const auto out = outIn("k2r_" + sequence);
        const auto report = made_up::run(
            {"--input", (kitti / "tracking/training").string(), "--sequence", sequence, "--out",
             out.string(), "--detections",
             (kitti / "tracking/detections/pointrcnn_car" / (sequence + ".txt")).string(),
             "--poses",
             (kitti / "../trajectories" / ("kitti_tracking_" + sequence + "_orbslam3_stereo.txt"))
                 .string()});
        EXPECT_EQ(report.frames, frames);
        EXPECT_EQ(report.truthPoses, frames);
        EXPECT_EQ(framesOf(out).size(), frames);
        const auto objects = djpete::obs::readDetections(out.parent_path() / "d_objects.rawlog");
        const auto labels = djpete::obs::readDetections(out.parent_path() / "d_labels.rawlog");
        ASSERT_EQ(objects.size(), frames);
        ASSERT_EQ(labels.size(), frames);
        // Detections and labels are of the same cars: most labels of near cars have one within 1 m.
        int cars = 0, found = 0;
        for (std::size_t i = 0; i < frames; ++i) {
            for (const auto& l : labels[i]->detections) {
                if (!djpete::obs::isVehicle(l.objectClass)) continue;
                if (l.T_sensor_obj.translation().norm() > 25) continue;
                ++cars;
                for (const auto& d : objects[i]->detections) {
                    if ((l.T_sensor_obj.translation() - d.T_sensor_obj.translation()).norm() < 1) {
                        ++found;
                        break;
                    }
                }
            }
        }
        EXPECT_GT(cars, 100) << sequence;
        EXPECT_GT(found, 0.7 * cars) << sequence;
    }
    // The other way to name a sequence.
    const auto report = made_up::run(
        {"--input", (kitti / "tracking/training/label_02/0006.txt").string(), "--out",
         outIn("k2r_0006_b").string(), "--poses",
         (kitti / "../trajectories/kitti_tracking_0006_orbslam3_stereo.txt").string()});
    EXPECT_EQ(report.info.name, "kitti tracking 0006");
    EXPECT_EQ(report.frames, 270U);
}

TEST(Kitti2RawlogRealData, ObjectFramesHaveOneRigEach) {
    DJPETE_SHARED_OR_SKIP(kitti, kKitti);
    const std::string input = (kitti / "object/training").string();
    const auto out = outIn("k2r_object");
    EXPECT_THAT(made_up::refusal({"--input", input, "--out", out.string()}),
                testing::HasSubstr("another calibration"));
    const auto report = made_up::run({"--input", input, "--out", out.string(), "--range", "2:3"});
    EXPECT_EQ(report.labels, 2U) << "Misc and Car";
    const auto frame = framesOf(out).at(0);
    EXPECT_EQ(frame.id.value, 2U);
    const auto objects = djpete::obs::readDetections(out.parent_path() / "d_objects.rawlog");
    const auto scan = frame.loadScan();
    ASSERT_TRUE(scan);
    for (const auto& d : objects.at(0)->detections)
        EXPECT_GT(pointsInside(*scan, d, djpete::geometry::fromCPose3D(objects[0]->sensorPose)),
                  10);
}
