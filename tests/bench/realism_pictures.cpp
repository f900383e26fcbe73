#include "realism_pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace djpete_bench {
namespace {

namespace fs = std::filesystem;

/// PNG of at most 600 kB: made smaller until it fits.
void writePng(cv::Mat image, const fs::path& file) {
    constexpr std::size_t kMost = 600'000;
    std::vector<uchar> bytes;
    for (;; cv::resize(image, image, {}, 0.9, 0.9, cv::INTER_AREA)) {
        cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9});
        if (bytes.size() <= kMost) break;
    }
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    out.flush();
    if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

/// Blue (dark) over green to yellow (bright) for a reflectance of 0..1.
cv::Scalar colourOf(float reflectance) {
    static const cv::Mat map = [] {
        cv::Mat ramp(1, 256, CV_8U), out;
        for (int i = 0; i < 256; ++i) ramp.at<uchar>(0, i) = static_cast<uchar>(i);
        cv::applyColorMap(ramp, out, cv::COLORMAP_VIRIDIS);
        return out;
    }();
    const float shown = std::sqrt(std::clamp(reflectance, 0.F, 1.F));
    const auto c = map.at<cv::Vec3b>(0, static_cast<int>(255.F * shown));
    return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

cv::Mat inColour(const cv::Mat& grey) {
    cv::Mat out;
    cv::cvtColor(grey, out, cv::COLOR_GRAY2BGR);
    return out;
}

/// The scan over a darkened image.
cv::Mat scanInImage(const RealismDrive& drive, const djpete::obs::LidarScan& scan,
                    const cv::Mat& grey) {
    cv::Mat out = inColour(grey) * 0.45;
    const auto& camera = drive.folder.camera.model;
    const SE3 T_cam_velo = drive.folder.camera.T_vehicle_cam.inverse();
    for (const auto& p : scan.points) {
        const djpete::geometry::Vec3 p_cam = T_cam_velo * p.position();
        if (p_cam.z() < 1) continue;
        const djpete::geometry::Vec2 px(camera.fx * p_cam.x() / p_cam.z() + camera.cx,
                                        camera.fy * p_cam.y() / p_cam.z() + camera.cy);
        if (px.x() < 0 || px.y() < 0 || px.x() > out.cols || px.y() > out.rows) continue;
        cv::circle(out, cv::Point(static_cast<int>(px.x()), static_cast<int>(px.y())), 1,
                   colourOf(p.intensity), cv::FILLED);
    }
    return out;
}

/// The scan from above: x ahead to the right of the picture, 40 m each way, boxes of the labels.
cv::Mat scanFromAbove(const RealismDrive& drive, const djpete::obs::LidarScan& scan,
                      std::size_t frame, int width_px) {
    constexpr double kReach_m = 40, kAside_m = 20;
    const double scale = width_px / (2 * kReach_m);
    cv::Mat out(static_cast<int>(2 * kAside_m * scale), width_px, CV_8UC3, cv::Scalar::all(18));
    const auto at = [&](double x, double y) {
        return cv::Point(static_cast<int>((x + kReach_m) * scale),
                         static_cast<int>((kAside_m - y) * scale));
    };
    for (const auto& p : scan.points)
        cv::circle(out, at(static_cast<double>(p.x), static_cast<double>(p.y)), 0,
                   colourOf(p.intensity), cv::FILLED);
    for (const auto& box : drive.boxes) {
        if (box.frame != frame) continue;
        const SE3 T_velo_obj = drive.folder.camera.T_vehicle_cam * box.T_cam_obj;
        std::vector<cv::Point> corners;
        for (const auto& [sx, sy] : {std::pair{1, 1}, {1, -1}, {-1, -1}, {-1, 1}}) {
            const djpete::geometry::Vec3 c =
                T_velo_obj *
                djpete::geometry::Vec3(0.5 * sx * box.size_m.x(), 0.5 * sy * box.size_m.y(), 0);
            corners.push_back(at(c.x(), c.y()));
        }
        cv::polylines(out, corners, true, cv::Scalar(80, 120, 255), 1, cv::LINE_AA);
    }
    return out;
}

/// KITTI's instance images hold 1000 * class + id; one hue per id.
cv::Mat masksOver(const cv::Mat& instances, const cv::Mat& grey) {
    cv::Mat out = inColour(grey);
    for (int v = 0; v < grey.rows; ++v) {
        for (int u = 0; u < grey.cols; ++u) {
            const auto code = instances.at<uint16_t>(v, u);
            if (code == 0) continue;
            const double hue = std::fmod(0.618034 * code, 1.0) * 2 * M_PI;
            for (int c = 0; c < 3; ++c) {
                const double tint = 127 + 127 * std::cos(hue + 2.1 * c);
                auto& value = out.at<cv::Vec3b>(v, u)[c];
                value = cv::saturate_cast<uchar>(0.45 * value + 0.55 * tint);
            }
        }
    }
    return out;
}

}  // namespace

void writePictures(const RealismDrive& drive, std::size_t frame, const fs::path& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    const cv::Mat left = drive.left(frame);
    cv::Mat stereo;
    cv::vconcat(left, drive.right(frame), stereo);
    writePng(stereo, folder / "stereo.png");
    if (const auto scan = drive.scan(frame)) {
        cv::Mat both;
        cv::vconcat(scanInImage(drive, *scan, left), scanFromAbove(drive, *scan, frame, left.cols),
                    both);
        writePng(both, folder / "scan.png");
    }
    const auto masks = drive.folder.left.parent_path() / "instances" /
                       djpete_test::KittiFolder::numbered(frame, drive.folder.digits, ".png");
    const cv::Mat instances = cv::imread(masks.string(), cv::IMREAD_UNCHANGED);
    if (instances.type() == CV_16U && instances.size() == left.size())
        writePng(masksOver(instances, left), folder / "masks.png");
}

}  // namespace djpete_bench
