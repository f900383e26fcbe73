/// Small observations, files and rawlogs for the tests of this room.
#pragma once

#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/CObservationDetectedObjects.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"
#include "djpete/obs/rawlog_source.h"
#include "djpete_test/shared_data.h"

namespace obs_samples {

namespace fs = std::filesystem;
using djpete::geometry::SE3;
using djpete::geometry::Vec3;
using djpete::geometry::Vec6;
using mrpt::serialization::CSerializable;

inline mrpt::Clock::time_point stampOf(int frame) {
    return mrpt::Clock::fromDouble(1.3e9 + 0.1 * frame);
}

inline SE3 somePose() { return SE3::exp((Vec6() << 1.5, -2, 0.25, 0.3, -0.7, 1.1).finished()); }

/// Every optional is set.
inline djpete::obs::ObjectDetection fullDetection() {
    djpete::obs::ObjectDetection d;
    d.objectClass = djpete::obs::ObjectClass::Van;
    d.score = 0.75F;
    d.size_m = {4.5, 1.9, 2.1};
    d.T_sensor_obj = somePose();
    d.information = djpete::obs::diagonalInformation({0.1, 0.2, 0.3}, {0.01, 0.02, 0.03});
    d.information(0, 5) = d.information(5, 0) = 1.25;
    d.box = djpete::obs::ImageBox{10.5F, 20, 110, 70.25F};
    d.mask = djpete::obs::RleMask{4, 3, {2, 3, 7}};
    d.source = "test";
    d.sourceTrackId = -7;
    djpete::obs::ObjectPoints points;
    points.body = {{1, 2, 3}, {4, 5, 6.5F}};
    points.ground = {{7, 8, 9}};
    points.origin = {-1, 0, 2};
    d.points = std::make_shared<djpete::obs::ObjectPoints>(points);
    return d;
}

inline djpete::obs::CObservationDetectedObjects::Ptr detectedObjects(int frame) {
    auto o = djpete::obs::CObservationDetectedObjects::Create();
    o->sensorLabel = djpete::obs::label::kDetections;
    o->timestamp = stampOf(frame);
    o->sensorPose = djpete::geometry::toCPose3D(somePose());
    o->detections = {fullDetection(), djpete::obs::ObjectDetection{}};
    return o;
}

inline mrpt::obs::CObservationRobotPose::Ptr truth(int frame) {
    auto o = mrpt::obs::CObservationRobotPose::Create();
    o->sensorLabel = djpete::obs::label::kGroundTruth;
    o->timestamp = stampOf(frame);
    o->pose.mean = mrpt::poses::CPose3D(0.5 * frame, 0, 0);
    return o;
}

inline mrpt::obs::CObservationComment::Ptr head(const djpete::obs::DriveInfo& info) {
    auto o = mrpt::obs::CObservationComment::Create();
    o->timestamp = stampOf(0);
    o->text = djpete::obs::toIniText(info);
    return o;
}

/// A grey picture with a value that differs from pixel to pixel.
inline fs::path writeImage(const fs::path& file, int width = 64, int height = 48,
                           bool color = false) {
    mrpt::img::CImage image(width, height, color ? mrpt::img::CH_RGB : mrpt::img::CH_GRAY);
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u)
            *image.ptr<uint8_t>(static_cast<unsigned>(u), static_cast<unsigned>(v)) =
                static_cast<uint8_t>((7 * u + 13 * v) % 251);
    }
    EXPECT_TRUE(image.saveToFile(file.string()));
    return file;
}

inline fs::path writeScan(const fs::path& file, const std::vector<float>& numbers) {
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(numbers.data()),
              static_cast<std::streamsize>(numbers.size() * sizeof(float)));
    return file;
}

inline void writeRawlog(const fs::path& file, const std::vector<CSerializable::Ptr>& entries) {
    mrpt::io::CFileGZOutputStream stream(file.string());
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (const auto& e : entries) archive << *e;
}

/// A copy of `file` with only its first `bytes` bytes.
inline fs::path cut(const fs::path& file, std::size_t bytes) {
    std::ifstream in(file, std::ios::binary);
    std::string all((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    EXPECT_LT(bytes, all.size());
    const fs::path out = file.parent_path() / ("cut_" + file.filename().string());
    std::ofstream(out, std::ios::binary) << all.substr(0, bytes);
    return out;
}

/// The sentence of the InputError that `f` throws; it must be one line.
template <class F>
std::string inputError(F&& f) {
    try {
        f();
    } catch (const djpete::obs::InputError& e) {
        const std::string what = e.what();
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        return what;
    }
    ADD_FAILURE() << "no InputError was thrown";
    return {};
}

}  // namespace obs_samples
