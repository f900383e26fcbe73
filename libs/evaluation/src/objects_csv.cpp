#include "djpete/evaluation/objects_csv.h"

#include <set>
#include <utility>

#include "djpete/obs/errors.h"
#include "text_file.h"

namespace djpete::evaluation {

using geometry::Vec3;
using obs::InputError;

namespace {

constexpr std::size_t kColumns = 23;

Vec3 parseVector(const std::vector<std::string>& fields, std::size_t first,
                 const std::string& where, const char* what) {
    Vec3 v;
    for (std::size_t i = 0; i < 3; ++i) {
        v[static_cast<Eigen::Index>(i)] = parseNumber(fields.at(first + i), where, what);
    }
    return v;
}

ObjectRow parseRow(const TextLine& line) {
    const auto fields = splitAtCommas(line.text);
    const std::string& where = line.where;
    if (fields.size() != kColumns) {
        throw InputError(where + ": expected 23 columns separated by commas, got " +
                         std::to_string(fields.size()));
    }
    ObjectRow row;
    row.line = line.number;
    row.objectId = static_cast<int64_t>(parseCount(fields[0], where, "object_id"));
    row.objectClass = obs::objectClassFromString(fields[1]);
    row.frame = parseCount(fields[2], where, "frame");
    if (!fields[3].empty()) row.time_s = parseNumber(fields[3], where, "time_s");
    row.T_world_obj = parseQuaternionPose(fields, 4, where);
    row.size_m = parseVector(fields, 11, where, "a size");
    row.velocity_world = parseVector(fields, 14, where, "a velocity");
    row.sigma_m = parseVector(fields, 17, where, "a sigma");
    row.sigmaYaw_rad = parseNumber(fields[20], where, "sigma_yaw");
    row.observations = parseCount(fields[21], where, "observations");
    row.moving = fields[22] == "1";
    if (row.size_m.minCoeff() <= 0) {
        throw InputError(where + ": expected a length, width and height above 0");
    }
    if (row.sigma_m.minCoeff() < 0 || row.sigmaYaw_rad < 0) {
        throw InputError(where + ": expected sigmas of at least 0");
    }
    if (row.observations == 0) {
        throw InputError(where + ": expected at least 1 as observations, got 0");
    }
    if (!row.moving && fields[22] != "0") {
        throw InputError(where + ": expected 0 or 1 as moving, got '" + fields[22] + "'");
    }
    return row;
}

/// What stands before the header line.
struct Preamble {
    bool hasFirstFrame = false, hasTransform = false;

    void parse(const TextLine& line, ObjectsFile& file) {
        const auto words = splitAtBlanks(line.text.substr(1));
        if (words.empty()) return;
        if (words[0] == "first_frame") {
            if (words.size() != 2) {
                throw InputError(line.where + ": expected one number after first_frame");
            }
            file.firstFrame = parseCount(words[1], line.where, "first_frame");
            hasFirstFrame = true;
        } else if (words[0] == "T_world_firstcam") {
            if (words.size() != 13) {
                throw InputError(line.where + ": expected 12 numbers after T_world_firstcam, got " +
                                 std::to_string(words.size() - 1));
            }
            file.T_world_firstcam = parseMatrixPose(words, 1, line.where);
            hasTransform = true;
        }
    }
};

}  // namespace

ObjectsFile readObjectsCsv(const std::string& path) {
    ObjectsFile file;
    file.path = path;
    Preamble preamble;
    bool hasHeader = false;
    std::set<std::pair<int64_t, std::size_t>> seen;
    for (const auto& line : readLines(path)) {
        if (line.text.front() == '#') {
            if (!hasHeader) preamble.parse(line, file);
            continue;
        }
        if (!hasHeader) {
            if (line.text != kObjectsCsvHeader) {
                throw InputError(line.where + ": expected the header line '" + kObjectsCsvHeader +
                                 "'");
            }
            hasHeader = true;
            continue;
        }
        file.rows.push_back(parseRow(line));
        const auto& row = file.rows.back();
        if (!seen.insert({row.objectId, row.frame}).second) {
            throw InputError(line.where + ": object " + std::to_string(row.objectId) +
                             " has two rows for frame " + std::to_string(row.frame) +
                             "; expected one");
        }
    }
    if (!hasHeader) throw InputError(path + ": has no header line 'object_id,class,frame,...'");
    if (!preamble.hasFirstFrame || !preamble.hasTransform) {
        throw InputError(
            path + ": expected a line '# " +
            (preamble.hasFirstFrame ? "T_world_firstcam r00 r01 r02 tx ..." : "first_frame N") +
            "' before the header");
    }
    return file;
}

}  // namespace djpete::evaluation
