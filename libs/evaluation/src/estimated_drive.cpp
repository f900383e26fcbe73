#include "djpete/evaluation/estimated_drive.h"

#include <cmath>

#include "djpete/evaluation/trajectory_reader.h"
#include "djpete/obs/errors.h"
#include "text_file.h"

namespace djpete::evaluation {

using geometry::SE3;

namespace {

/// Steele, Lea, Flood: SplitMix64's finaliser.
uint64_t mixed(uint64_t x) {
    x += 0x9E3779B97F4A7C15ULL;
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31U);
}

SE3 offsetOf(const Disturbance& d, int64_t object, std::size_t frame) {
    const uint64_t bits = mixed(mixed(static_cast<uint64_t>(object)) ^ frame);
    const double direction = 2 * M_PI * static_cast<double>(bits >> 11U) / 9007199254740992.0;
    const double turn = ((bits & 1U) != 0 ? 1 : -1) * d.turn_deg * M_PI / 180;
    return {Eigen::AngleAxisd(turn, geometry::Vec3::UnitZ()).toRotationMatrix(),
            d.shift_m * geometry::Vec3(std::cos(direction), std::sin(direction), 0)};
}

SE3 between(const SE3& a, const SE3& b, double share) {
    const geometry::Vec3 t = (1 - share) * a.translation() + share * b.translation();
    const Eigen::Quaterniond qa(a.rotation()), qb(b.rotation());
    return {qa.slerp(share, qb).normalized().toRotationMatrix(), t};
}

std::optional<SE3> undisturbed(const EstimatedObject& object, std::size_t frame) {
    const auto& rows = object.T_world_obj;
    const auto after = rows.lower_bound(frame);
    if (after != rows.end() && after->first == frame) return after->second;
    if (after != rows.end() && after != rows.begin()) {
        const auto before = std::prev(after);
        const double share = static_cast<double>(frame - before->first) /
                             static_cast<double>(after->first - before->first);
        return between(before->second, after->second, share);
    }
    if (object.moving || rows.empty()) return std::nullopt;
    return after == rows.end() ? std::prev(after)->second : after->second;
}

/// Rows node,kind,keyframe_id,object_id,frame.
std::set<std::size_t> readKeyframes(const std::string& path) {
    std::set<std::size_t> out;
    for (const auto& line : readLines(path)) {
        const auto fields = splitAtCommas(line.text);
        if (fields.size() != 5) {
            throw obs::InputError(line.where + ": " + std::to_string(fields.size()) +
                                  " columns, expected 5");
        }
        if (fields[1] == "keyframe") out.insert(parseCount(fields[4], line.where, "frame"));
    }
    return out;
}

}  // namespace

std::optional<SE3> EstimatedDrive::T_world_obj(int64_t object, std::size_t frame) const {
    const auto found = objects.find(object);
    if (found == objects.end()) return std::nullopt;
    auto pose = undisturbed(found->second, frame);
    if (pose && disturbance.any()) pose = *pose * offsetOf(disturbance, object, frame);
    return pose;
}

std::optional<SE3> EstimatedDrive::T_cam_obj(int64_t object, std::size_t frame) const {
    const auto pose = T_world_obj(object, frame);
    if (!pose || !cameras.contains(frame)) return std::nullopt;
    return cameras.at(frame).inverse() * *pose;
}

EstimatedDrive readEstimatedDrive(const std::string& folder) {
    EstimatedDrive out;
    out.folder = folder;
    const ObjectsFile file = readObjectsCsv(folder + "/objects.csv");
    out.cameras =
        estimatedCameras(file, readTrajectory(folder + "/trajectory.kitti.txt"), std::nullopt);
    for (const auto& row : file.rows) {
        EstimatedObject& object = out.objects[row.objectId];
        object.id = row.objectId;
        object.objectClass = row.objectClass;
        object.size_m = row.size_m;
        object.moving = object.moving || row.moving;
        object.T_world_obj[row.frame] = row.T_world_obj;
    }
    out.keyframes = readKeyframes(folder + "/map.graph.nodes.csv");
    return out;
}

}  // namespace djpete::evaluation
