#include "djpete/evaluation/trajectory_reader.h"

#include "djpete/obs/errors.h"
#include "text_file.h"

namespace djpete::evaluation {

using obs::InputError;

namespace {

constexpr std::size_t kKittiColumns = 12, kTumColumns = 8;

void requireColumns(const TextLine& line, std::size_t got, std::size_t expected) {
    if (expected == 0 && got != kKittiColumns && got != kTumColumns) {
        throw InputError(line.where +
                         ": expected 12 numbers (a KITTI 3x4 row) or 8 (TUM: t x y z qx qy qz qw), "
                         "got " +
                         std::to_string(got));
    }
    if (expected != 0 && got != expected) {
        throw InputError(line.where + ": expected " + std::to_string(expected) +
                         " numbers as in the rows before, got " + std::to_string(got));
    }
}

}  // namespace

Trajectory startingAtIdentity(const Trajectory& path) {
    Trajectory out;
    out.reserve(path.size());
    for (const auto& T_world_cam : path) out.push_back(path.front().inverse() * T_world_cam);
    return out;
}

TrajectoryFile readTrajectory(const std::string& path) {
    TrajectoryFile file;
    file.path = path;
    std::size_t columns = 0;
    for (const auto& line : readLines(path)) {
        if (line.text.front() == '#') continue;
        const auto words = splitAtBlanks(line.text);
        requireColumns(line, words.size(), columns);
        columns = words.size();
        if (columns == kKittiColumns) {
            file.poses.push_back(parseMatrixPose(words, 0, line.where));
            continue;
        }
        const double stamp_s = parseNumber(words[0], line.where, "time");
        if (!file.stamps_s.empty() && stamp_s <= file.stamps_s.back()) {
            throw InputError(line.where + ": expected a time after that of the row before, got " +
                             words[0]);
        }
        file.stamps_s.push_back(stamp_s);
        file.poses.push_back(parseQuaternionPose(words, 1, line.where));
    }
    if (file.poses.empty()) throw InputError(path + ": holds no pose, only comments");
    return file;
}

}  // namespace djpete::evaluation
