/// Hand-made paths, files and objects for the tests of this room.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "djpete/evaluation/objects_csv.h"
#include "djpete/evaluation/trajectory.h"
#include "djpete/obs/errors.h"
#include "djpete_test/shared_data.h"

namespace evaluation_test {

using djpete::evaluation::Trajectory;
using djpete::geometry::Mat3;
using djpete::geometry::SE3;
using djpete::geometry::Vec3;
using djpete::geometry::Vec6;

/// A drive with bends in all directions, about 1 m a frame, starting at identity.
inline Trajectory windingPath(std::size_t frames) {
    Trajectory path;
    for (std::size_t i = 0; i < frames; ++i) {
        const double s = static_cast<double>(i);
        const SE3 T = SE3::exp(
            (Vec6() << 0, 0, 0, 0.02 * std::sin(0.1 * s), 0.01 * s, 0.03 * std::sin(0.05 * s))
                .finished());
        path.push_back({T.rotation(), Vec3(30 * std::sin(0.02 * s), 3 * std::sin(0.03 * s), s)});
    }
    return path;
}

inline Trajectory movedBy(const SE3& T, const Trajectory& path) {
    Trajectory out;
    for (const auto& pose : path) out.push_back(T * pose);
    return out;
}

inline std::filesystem::path writeText(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

inline std::string kittiRow(const SE3& T) {
    std::ostringstream out;
    out << std::setprecision(17);
    for (int i = 0; i < 12; ++i) out << (i ? " " : "") << T.matrix()(i / 4, i % 4);
    return out.str();
}

inline std::string kittiText(const Trajectory& path) {
    std::string text;
    for (const auto& T : path) text += kittiRow(T) + "\n";
    return text;
}

/// A row of objects.csv: observations 3, sigmas 0.1, size 4 x 1.8 x 1.5.
inline std::string csvRow(int id, const std::string& objectClass, std::size_t frame, const SE3& T,
                          const Vec3& velocity = Vec3::Zero(), bool moving = false) {
    const Eigen::Quaterniond q(T.rotation());
    const Vec3& t = T.translation();
    std::ostringstream out;
    out << std::setprecision(17) << id << "," << objectClass << "," << frame << ","
        << 0.1 * static_cast<double>(frame) << "," << t.x() << "," << t.y() << "," << t.z() << ","
        << q.x() << "," << q.y() << "," << q.z() << "," << q.w() << ",4,1.8,1.5," << velocity.x()
        << "," << velocity.y() << "," << velocity.z() << ",0.1,0.1,0.1,0.1,3," << moving << "\n";
    return out.str();
}

inline std::string csvPreamble(std::size_t firstFrame, const SE3& T_world_firstcam) {
    return "# first_frame " + std::to_string(firstFrame) + "\n# T_world_firstcam " +
           kittiRow(T_world_firstcam) + "\n" + djpete::evaluation::kObjectsCsvHeader + "\n";
}

}  // namespace evaluation_test

/// The statement throws InputError with one sentence that holds all of the given pieces.
#define EXPECT_INPUT_ERROR(statement, ...)                                       \
    try {                                                                        \
        statement;                                                               \
        ADD_FAILURE() << "no error from " #statement;                            \
    } catch (const djpete::obs::InputError& inputError) {                        \
        const std::string sentence = inputError.what();                          \
        for (const std::string& piece : std::vector<std::string>{__VA_ARGS__}) { \
            EXPECT_THAT(sentence, ::testing::HasSubstr(piece));                  \
        }                                                                        \
        EXPECT_THAT(sentence, ::testing::Not(::testing::HasSubstr("\n")));       \
    }
