#include "djpete/evaluation/tracking_reader.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "djpete/obs/errors.h"
#include "text_file.h"

namespace djpete::evaluation {

using obs::InputError;

namespace {

using Words = std::vector<std::string>;

bool isDontCare(const std::string& type) {
    static const std::string kLower = "dontcare";
    return std::equal(type.begin(), type.end(), kLower.begin(), kLower.end(), [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b;
    });
}

ImageArea parseImageArea(const TextLine& line, const Words& words) {
    static const char* const kNames[] = {"left", "top", "right", "bottom"};
    double v[4];
    for (std::size_t i = 0; i < 4; ++i) v[i] = parseNumber(words[6 + i], line.where, kNames[i]);
    return {v[0], v[1], v[2], v[3]};
}

TrackingBox parseBox(const TextLine& line, const Words& words) {
    static const char* const kNames[] = {"height", "width", "length", "x", "y", "z", "rotation_y"};
    double v[7];
    for (std::size_t i = 0; i < 7; ++i) v[i] = parseNumber(words[10 + i], line.where, kNames[i]);
    if (!(v[0] > 0 && v[1] > 0 && v[2] > 0)) {
        throw InputError(line.where + ": expected a height, width and length above 0, got " +
                         words[10] + " " + words[11] + " " + words[12]);
    }
    TrackingBox box;
    box.frame = parseCount(words[0], line.where, "frame");
    box.trackId = parseInteger(words[1], line.where, "track id");
    box.objectClass = obs::objectClassFromString(words[2]);
    box.size_m = {v[2], v[1], v[0]};
    box.T_cam_obj = labelPose({v[3], v[4], v[5]}, v[0], v[6]);
    box.truncation = parseNumber(words[3], line.where, "truncation");
    box.occlusion = parseNumber(words[4], line.where, "occlusion");
    box.image = parseImageArea(line, words);
    if (words.size() == 18) box.score = parseNumber(words[17], line.where, "score");
    return box;
}

}  // namespace

TrackingSequence readTrackingSequence(const std::string& path) {
    TrackingSequence sequence;
    sequence.name = std::filesystem::path(path).stem().string();
    if (std::filesystem::is_regular_file(path) && std::filesystem::file_size(path) == 0) {
        return sequence;
    }
    std::set<std::pair<std::size_t, int64_t>> seen;
    for (const auto& line : readLines(path)) {
        const auto words = splitAtBlanks(line.text);
        if (words.size() != 17 && words.size() != 18) {
            throw InputError(line.where +
                             ": expected the 17 columns of a KITTI tracking label (or 18 with a "
                             "score), got " +
                             std::to_string(words.size()));
        }
        if (isDontCare(words[2])) {
            sequence.dontCare.push_back(
                {parseCount(words[0], line.where, "frame"), parseImageArea(line, words)});
            continue;
        }
        sequence.boxes.push_back(parseBox(line, words));
        const TrackingBox& box = sequence.boxes.back();
        if (box.score.has_value() != sequence.boxes.front().score.has_value()) {
            throw InputError(line.where + ": expected a score in every row or in none, got " +
                             std::to_string(words.size()) + " columns unlike the rows before");
        }
        if (!seen.insert({box.frame, box.trackId}).second) {
            throw InputError(line.where + ": track " + words[1] + " has two boxes in frame " +
                             words[0] + "; expected one");
        }
    }
    return sequence;
}

}  // namespace djpete::evaluation
