/// What the project's own front end makes of a drive.
#include "djpete/frontend/visual_odometry.h"
#include "realism_statistics.h"

namespace djpete_bench {

Statistics odometryStatistics(const RealismDrive& drive) {
    djpete::frontend::VisualOdometry odometry;
    std::vector<double> inliers, followed, stereo, features, added, rms, metres, degrees;
    std::optional<SE3> T_odom_before;
    for (std::size_t frame : drive.frames) {
        djpete::obs::LidarScan unused;
        auto input = drive.folder.load(frame, unused);
        input.scan = nullptr;  // real drives have scans for some frames only
        const SE3 T_odom_cam = odometry.process(input)->T_odom_cam;
        const auto& s = odometry.last();
        stereo.push_back(s.stereoMatched);
        features.push_back(s.features);
        if (T_odom_before) {
            inliers.push_back(s.inliers);
            followed.push_back(s.followed);
            added.push_back(s.added);
            rms.push_back(s.rms_px);
            if (frame < drive.T_first_cam.size()) {
                const SE3 truth = drive.T_first_cam[frame - 1].inverse() * drive.T_first_cam[frame];
                const auto e = (truth.inverse() * T_odom_before->inverse() * T_odom_cam).log();
                metres.push_back(e.head<3>().norm());
                degrees.push_back(e.tail<3>().norm() * 180 / M_PI);
            }
        }
        T_odom_before = T_odom_cam;
    }
    return {
        {"odometry: features per frame", mean(features), false},
        {"odometry: followed per frame", mean(followed), false},
        {"odometry: inliers per frame", mean(inliers), false},
        {"odometry: stereo matches per frame", mean(stereo), false},
        {"odometry: new corners per frame", mean(added), false},
        {"odometry: reprojection rms, px", mean(rms), false},
        {"odometry: motion error per frame p50, mm",
         metres.empty() ? std::nullopt : std::optional<double>(1000 * *percentile(metres, 0.5)),
         true},
        {"odometry: rotation error per frame p50, mdeg",
         degrees.empty() ? std::nullopt : std::optional<double>(1000 * *percentile(degrees, 0.5)),
         true}};
}

}  // namespace djpete_bench
