#include "djpete/simulator/drive_writer.h"

#include <array>
#include <cstdio>
#include <fstream>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "parallel.h"

namespace djpete::simulator {

namespace fs = std::filesystem;
using geometry::SE3;

namespace {

std::ofstream open(const fs::path& file) {
    std::ofstream out(file, std::ios::binary);
    if (!out) throw std::runtime_error(file.string() + ": cannot be written");
    return out;
}

/// Reports a full disk.
void finish(std::ofstream& out, const fs::path& file) {
    out.flush();
    if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

std::string frameFile(uint64_t frame, const char* extension) {
    char name[32];
    std::snprintf(name, sizeof name, "%06llu%s", static_cast<unsigned long long>(frame), extension);
    return name;
}

std::string poseRow(const SE3& T) {
    std::string row;
    char number[40];
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            std::snprintf(number, sizeof number, "%.12e",
                          c < 3 ? T.rotation()(r, c) : T.translation()[r]);
            row += (row.empty() ? "" : " ") + std::string(number);
        }
    }
    return row;
}

void writeCalibration(const geometry::StereoCamera& camera, const SE3& T_vehicle_cam,
                      const fs::path& file) {
    auto out = open(file);
    for (int i = 0; i < 4; ++i) {
        const double offset = i % 2 == 1 ? -camera.fx * camera.baseline_m : 0.0;
        const std::array<double, 12> p{camera.fx, 0, camera.cx, offset, 0, camera.fy,
                                       camera.cy, 0, 0,         0,      1, 0};
        out << "P" << i << ":";
        char number[40];
        for (double x : p) {
            std::snprintf(number, sizeof number, " %.12e", x);
            out << number;
        }
        out << "\n";
    }
    out << "Tr: " << poseRow(T_vehicle_cam.inverse()) << "\n";
    finish(out, file);
}

void writePng(const cv::Mat& image, const fs::path& file) {
    if (!cv::imwrite(file.string(), image,
                     {cv::IMWRITE_PNG_COMPRESSION, 1, cv::IMWRITE_PNG_STRATEGY,
                      cv::IMWRITE_PNG_STRATEGY_RLE})) {
        throw std::runtime_error(file.string() + ": cannot be written");
    }
}

cv::Mat colourOf(const RenderedImage& image) {
    cv::Mat out(image.height_px, image.width_px, CV_8UC3);
    for (int v = 0; v < image.height_px; ++v) {
        for (int u = 0; u < image.width_px; ++u) {
            const auto& p = image.rgb[static_cast<std::size_t>(v * image.width_px + u)];
            out.at<cv::Vec3b>(v, u) = cv::Vec3b(p[2], p[1], p[0]);
        }
    }
    return out;
}

cv::Mat instancesOf(const RenderedImage& image, const std::vector<Label>& labels) {
    constexpr uint16_t kIgnore = 10000;
    std::map<uint32_t, uint16_t> codes{{0U, uint16_t{0}}};
    for (const auto& l : labels) codes[l.trackId] = static_cast<uint16_t>(1000 + l.trackId);
    cv::Mat out(image.height_px, image.width_px, CV_16UC1);
    for (int v = 0; v < image.height_px; ++v) {
        for (int u = 0; u < image.width_px; ++u) {
            const auto code =
                codes.find(image.actorId[static_cast<std::size_t>(v * image.width_px + u)]);
            out.at<uint16_t>(v, u) = code == codes.end() ? kIgnore : code->second;
        }
    }
    return out;
}

void writeImages(const RenderedImage& left, const RenderedImage& right,
                 const std::vector<Label>& labels, uint64_t frame, const fs::path& folder,
                 const DriveOptions& options) {
    const std::array<cv::Mat, 2> colour{colourOf(left), colourOf(right)};
    const auto name = frameFile(frame, ".png");
    parallelFor(5, options.threads, [&](int i) {
        if (i == 4) {
            writePng(instancesOf(left, labels), folder / "instances" / name);
            return;
        }
        if (i >= 2 && !options.colour) return;
        cv::Mat image = colour[static_cast<std::size_t>(i % 2)];
        if (i < 2) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
        writePng(image, folder / ("image_" + std::to_string(i)) / name);
    });
}

void writeScan(const std::vector<LidarPoint>& points, const fs::path& file) {
    auto out = open(file);
    for (const auto& p : points) {
        const std::array<float, 4> row{p.x, p.y, p.z, p.reflectance};
        out.write(reinterpret_cast<const char*>(row.data()), sizeof row);
    }
    finish(out, file);
}

void writeTimesAndPoses(const World& world, uint64_t end, const SE3& T_vehicle_cam,
                        const fs::path& folder) {
    auto times = open(folder / "times.txt");
    auto poses = open(folder / "poses.txt");
    const SE3 T_first_world = (world.T_world_vehicle(0) * T_vehicle_cam).inverse();
    for (uint64_t f = 0; f < end; ++f) {
        char number[40];
        std::snprintf(number, sizeof number, "%.6e",
                      static_cast<double>(f) * world.options().period_s);
        times << number << "\n";
        poses << poseRow(T_first_world * world.T_world_vehicle(f) * T_vehicle_cam) << "\n";
    }
    finish(times, folder / "times.txt");
    finish(poses, folder / "poses.txt");
}

void makeFolders(const fs::path& folder, const DriveOptions& options) {
    std::vector<std::string> names{"image_0", "image_1", "instances"};
    if (options.colour) names.insert(names.end(), {"image_2", "image_3"});
    if (options.scans) names.emplace_back("velodyne");
    for (const auto& name : names) {
        std::error_code failed;
        fs::create_directories(folder / name, failed);
        if (failed || !fs::is_directory(folder / name))
            throw std::runtime_error((folder / name).string() + ": the folder cannot be made");
    }
}

}  // namespace

void writeDrive(const DriveOptions& options, const fs::path& folder, const Progress& progress) {
    makeFolders(folder, options);
    WorldOptions worldOptions = options.world;
    worldOptions.frames = std::max(worldOptions.frames, options.end);
    const World world(worldOptions);
    Renderer renderer(world, options.threads);
    const auto camera = rigCamera(options.width_px, options.height_px);
    const SE3 T_vehicle_left = T_vehicle_camera();
    const SE3 T_vehicle_right =
        T_vehicle_left * SE3(geometry::Mat3::Identity(), geometry::Vec3(camera.baseline_m, 0, 0));
    writeCalibration(camera, T_vehicle_left, folder / "calib.txt");
    writeTimesAndPoses(world, options.end, T_vehicle_left, folder);
    auto labelFile = open(folder / "label_02.txt");
    auto detectionFile = open(folder / "detections.txt");
    for (uint64_t f = options.begin; f < options.end; ++f) {
        const auto left = renderer.renderCamera(f, camera, T_vehicle_left, 0);
        const auto right = renderer.renderCamera(f, camera, T_vehicle_right, 1);
        const auto labels =
            makeLabels(renderer, world, f, camera, T_vehicle_left, left, options.labels);
        writeImages(left, right, labels, f, folder, options);
        if (options.scans)
            writeScan(renderer.scan(f, options.lidar), folder / "velodyne" / frameFile(f, ".bin"));
        for (const auto& l : labels) labelFile << toKittiRow(l) << "\n";
        for (const auto& d : makeDetections(labels, options.detector, worldOptions.seed)) {
            detectionFile << toPointRcnnRow(d) << "\n";
        }
        finish(labelFile, folder / "label_02.txt");
        finish(detectionFile, folder / "detections.txt");
        if (progress) progress(f + 1 - options.begin, options.end - options.begin);
    }
}

}  // namespace djpete::simulator
