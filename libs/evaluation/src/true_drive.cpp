#include "djpete/evaluation/true_drive.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "djpete/obs/errors.h"
#include "text_file.h"

namespace djpete::evaluation {

namespace {

using geometry::SE3;
using obs::InputError;

std::string numbered(const std::string& folder, int digits, std::size_t number,
                     const std::string& end) {
    char text[32];
    std::snprintf(text, sizeof(text), "%0*zu", digits, number);
    return folder + "/" + text + end;
}

/// Words after `name:` in calib.txt.
std::pair<std::vector<std::string>, std::string> calibRow(const std::vector<TextLine>& lines,
                                                          const std::string& path,
                                                          const std::string& name) {
    for (const auto& line : lines) {
        auto words = splitAtBlanks(line.text);
        if (words.empty() || words.front() != name + ":") continue;
        words.erase(words.begin());
        if (words.size() != 12) {
            throw InputError(line.where + ": '" + name + "' has " + std::to_string(words.size()) +
                             " numbers, expected 12");
        }
        return {words, line.where};
    }
    throw InputError(path + ": expected a line '" + name + ": ...'");
}

void readCalib(const std::string& path, TrueDrive& drive) {
    const auto lines = readLines(path);
    std::array<double, 12> left{}, right{};
    for (const auto& [name, target] : {std::pair{"P2", &left}, std::pair{"P3", &right}}) {
        const auto [words, where] = calibRow(lines, path, name);
        for (std::size_t i = 0; i < 12; ++i) (*target)[i] = parseNumber(words[i], where, name);
    }
    if (!(left[0] > 0 && left[5] > 0)) throw InputError(path + ": expected focal lengths above 0");
    if (std::abs(left[3]) > 1e-6 * left[0]) {
        throw InputError(path +
                         ": P2 is beside P0; expected the colour camera of a simulated "
                         "drive, which is where the poses are");
    }
    drive.camera = {left[0], left[5], left[2], left[6], -right[3] / right[0], 0, 0};
    const auto [words, where] = calibRow(lines, path, "Tr");
    drive.T_cam_vehicle = parseMatrixPose(words, 0, where);
}

void readActors(const std::string& path, TrueDrive& drive) {
    for (const auto& line : readLines(path)) {
        const auto words = splitAtBlanks(line.text);
        if (words.front().rfind('#', 0) == 0) continue;
        if (words.size() != 20) {
            throw InputError(line.where + ": " + std::to_string(words.size()) +
                             " columns, expected 20");
        }
        const std::size_t frame = parseCount(words[0], line.where, "frame");
        const int64_t id = parseInteger(words[1], line.where, "id");
        TrueActor& actor = drive.actors[id];
        actor.id = id;
        if (!actor.T_world_obj.emplace(frame, parseMatrixPose(words, 4, line.where)).second) {
            throw InputError(line.where + ": object " + words[1] + " is twice in frame " +
                             words[0]);
        }
    }
}

/// Rows `name value`. The sun is that of the simulator's street, whose axes are those of the
/// vehicle at frame 0 within a few degrees.
void readSun(const std::string& path, TrueDrive& drive) {
    if (!std::filesystem::exists(path)) return;
    for (const auto& line : readLines(path)) {
        const auto words = splitAtBlanks(line.text);
        if (words.size() != 2 || words[0] != "sun-turn-rad") continue;
        const double turn = parseNumber(words[1], line.where, words[0]);
        const geometry::Vec3 usual(-0.42, -0.62, 0.74);
        drive.sun_world = Eigen::AngleAxisd(turn, geometry::Vec3::UnitZ()) * usual.normalized();
    }
}

}  // namespace

std::optional<SE3> TrueDrive::T_cam_obj(int64_t actor, std::size_t frame) const {
    const auto found = actors.find(actor);
    if (found == actors.end() || frame >= cameras.poses.size()) return std::nullopt;
    const auto pose = found->second.T_world_obj.find(frame);
    if (pose == found->second.T_world_obj.end()) return std::nullopt;
    return cameras.poses[frame].inverse() * T_cam_vehicle * pose->second;
}

std::string TrueDrive::imageFile(std::size_t frame) const {
    return numbered(folder + "/image_2", 6, frame, ".png");
}

std::string TrueDrive::instanceFile(std::size_t frame) const {
    return numbered(folder + "/instances", 6, frame, ".png");
}

std::string TrueDrive::meshFile(int64_t actor) const {
    return numbered(folder + "/objects", 3, static_cast<std::size_t>(actor), ".ply");
}

TrueDrive readTrueDrive(const std::string& folder) {
    TrueDrive drive;
    drive.folder = folder;
    readCalib(folder + "/calib.txt", drive);
    drive.cameras = readTrajectory(folder + "/poses.txt");
    readActors(folder + "/objects.txt", drive);
    readSun(folder + "/drive_options.txt", drive);
    const RgbImage first = readRgb(drive.imageFile(0));
    drive.camera.width_px = first.width_px;
    drive.camera.height_px = first.height_px;
    return drive;
}

}  // namespace djpete::evaluation
