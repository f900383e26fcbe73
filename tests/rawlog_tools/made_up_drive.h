/// A tiny drive in KITTI's odometry layout, and a way to run kitti2rawlog in-process.
#pragma once

#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "djpete/obs/errors.h"
#include "djpete/obs/rawlog_source.h"
#include "djpete_test/shared_data.h"
#include "kitti2rawlog_app.h"

namespace made_up {

namespace fs = std::filesystem;

inline void writeText(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
}

inline void writePng(const fs::path& file, int width = 32, int height = 16) {
    fs::create_directories(file.parent_path());
    mrpt::img::CImage image(width, height, mrpt::img::CH_GRAY);
    image.filledRectangle(0, 0, width - 1, height - 1, mrpt::img::TColor(90, 90, 90));
    EXPECT_TRUE(image.saveToFile(file.string()));
}

inline void writeScan(const fs::path& file, std::size_t bytes = 32) {
    std::vector<float> numbers((bytes + 3) / 4, 1.F);
    std::string text(reinterpret_cast<const char*>(numbers.data()), bytes);
    writeText(file, text);
}

inline std::string frameName(int frame) {
    char name[16];
    std::snprintf(name, sizeof name, "%06d", frame);
    return name;
}

/// A forward-looking rig: camera 0 is 0.3 m before the Velodyne, f = 20, baselines of 0.5 m.
constexpr const char* kCalib =
    "P0: 20 0 16 0 0 20 8 0 0 0 1 0\n"
    "P1: 20 0 16 -10 0 20 8 0 0 0 1 0\n"
    "P2: 20 0 16 1 0 20 8 0 0 0 1 0\n"
    "P3: 20 0 16 -9 0 20 8 0 0 0 1 0\n"
    "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 -0.3\n";

/// `count` frames of grey stereo with a scan at every second one; the camera moves 1 m per frame.
inline fs::path drive(const std::string& name, int count = 4) {
    const fs::path dir = djpete_test::scratch(name) / "sequences" / "77";
    writeText(dir / "calib.txt", kCalib);
    std::string times, poses;
    for (int i = 0; i < count; ++i) {
        writePng(dir / "image_0" / (frameName(i) + ".png"));
        writePng(dir / "image_1" / (frameName(i) + ".png"));
        if (i % 2 == 0) writeScan(dir / "velodyne" / (frameName(i) + ".bin"));
        times += std::to_string(0.1 * i) + "\n";
        poses += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(i) + "\n";
    }
    writeText(dir / "times.txt", times);
    writeText(dir / "poses.txt", poses);
    return dir;
}

/// Runs the program with `words` as its command line and returns its report.
inline djpete::kitti2rawlog::ConversionReport run(const std::vector<std::string>& words) {
    std::vector<const char*> argv{"kitti2rawlog"};
    for (const auto& w : words) argv.push_back(w.c_str());
    djpete::kitti2rawlog::Kitti2RawlogApp app;
    EXPECT_TRUE(app.initialize(static_cast<int>(argv.size()), argv.data()));
    std::ostringstream out;
    app.run(out);
    EXPECT_NE(out.str().find(std::to_string(app.report.frames) + " frames"), std::string::npos);
    return app.report;
}

/// The one sentence with which the program refuses.
inline std::string refusal(const std::vector<std::string>& words) {
    try {
        run(words);
    } catch (const djpete::obs::InputError& e) {
        const std::string what = e.what();
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        return what;
    }
    ADD_FAILURE() << "no InputError was thrown";
    return {};
}

inline std::vector<djpete::obs::SensorFrame> framesOf(const fs::path& rawlog) {
    djpete::obs::RawlogSource source(rawlog);
    std::vector<djpete::obs::SensorFrame> out;
    while (auto f = source.next()) out.push_back(std::move(*f));
    return out;
}

}  // namespace made_up
