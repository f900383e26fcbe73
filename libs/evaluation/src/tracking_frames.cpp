#include "tracking_frames.h"

#include <algorithm>
#include <cstdint>
#include <map>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/overlap.h"

namespace djpete::evaluation {

namespace {

using BoxPointers = std::vector<const TrackingBox*>;

bool isCounted(const TrackingBox& box) {
    return box.objectClass == obs::ObjectClass::Car || box.objectClass == obs::ObjectClass::Van;
}

bool isIgnored(const TrackingBox& label, const TrackingCriteria& criteria) {
    return label.objectClass == obs::ObjectClass::Van ||
           label.truncation > criteria.maxTruncation || label.occlusion > criteria.maxOcclusion;
}

/// Share of a's area that lies in b.
double shareInside(const ImageArea& a, const ImageArea& b) {
    const ImageArea common{std::max(a.left, b.left), std::max(a.top, b.top),
                           std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
    return a.area() > 0 ? common.area() / a.area() : 0;
}

bool isIgnorable(const TrackingBox& result, const std::vector<const DontCareArea*>& areas,
                 const TrackingCriteria& criteria) {
    if (result.objectClass == obs::ObjectClass::Van) return true;
    if (result.image.height() <= criteria.minHeight_px) return true;
    return std::any_of(areas.begin(), areas.end(), [&](const auto* area) {
        return shareInside(result.image, area->image) > criteria.maxDontCareShare;
    });
}

/// The box in axes of a vehicle at the camera: x forward, y left, z up.
obs::UprightBox standing(const TrackingBox& box) {
    return obs::uprightBox(geometry::opticalToVehicleAxes() * box.T_cam_obj, box.size_m);
}

Eigen::MatrixXd overlaps(const BoxPointers& labels, const BoxPointers& results, OverlapKind kind) {
    std::vector<obs::UprightBox> columns;
    for (const auto* result : results) columns.push_back(standing(*result));
    Eigen::MatrixXd out(labels.size(), results.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const obs::UprightBox row = standing(*labels[i]);
        for (std::size_t j = 0; j < columns.size(); ++j) {
            out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                kind == OverlapKind::Volume ? obs::volumeOverlap(row, columns[j])
                                            : obs::birdsEyeOverlap(row, columns[j]);
        }
    }
    return out;
}

struct FrameBoxes {
    BoxPointers labels, results;
    std::vector<const DontCareArea*> areas;
};

std::map<std::size_t, FrameBoxes> byFrame(const TrackingPair& pair) {
    std::map<std::size_t, FrameBoxes> frames;
    for (const auto& box : pair.labels.boxes) {
        if (isCounted(box)) frames[box.frame].labels.push_back(&box);
    }
    for (const auto& box : pair.results.boxes) {
        if (isCounted(box)) frames[box.frame].results.push_back(&box);
    }
    for (const auto& area : pair.labels.dontCare) {
        const auto frame = frames.find(area.frame);
        if (frame != frames.end()) frame->second.areas.push_back(&area);
    }
    return frames;
}

/// Numbers the tracks from 0 in order of their ids.
std::map<int64_t, std::size_t> trackNumbers(const std::vector<TrackingBox>& boxes) {
    std::map<int64_t, std::size_t> numbers;
    for (const auto& box : boxes) {
        if (isCounted(box)) numbers.emplace(box.trackId, 0);
    }
    std::size_t next = 0;
    for (auto& [id, number] : numbers) number = next++;
    return numbers;
}

/// Mean score of each track, in order of the tracks' numbers.
std::vector<double> meanScores(const std::vector<TrackingBox>& boxes,
                               const std::map<int64_t, std::size_t>& numbers) {
    std::vector<double> sums(numbers.size(), 0), counts(numbers.size(), 0);
    for (const auto& box : boxes) {
        if (!isCounted(box)) continue;
        const std::size_t track = numbers.at(box.trackId);
        sums[track] += box.score.value_or(0);
        counts[track] += 1;
    }
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i];
    return sums;
}

}  // namespace

TrackingDrive prepareDrive(const TrackingPair& pair, const TrackingCriteria& criteria) {
    const auto labelNumbers = trackNumbers(pair.labels.boxes);
    const auto resultNumbers = trackNumbers(pair.results.boxes);
    const auto scores = meanScores(pair.results.boxes, resultNumbers);
    TrackingDrive drive;
    drive.labelTracks.resize(labelNumbers.size());
    drive.resultTracks = resultNumbers.size();
    for (const auto& [number, boxes] : byFrame(pair)) {
        TrackingFrame frame;
        for (const auto* label : boxes.labels) {
            const std::size_t track = labelNumbers.at(label->trackId);
            frame.labels.push_back(drive.labels.size());
            drive.labelTracks[track].push_back(drive.labels.size());
            drive.labels.push_back({track, isIgnored(*label, criteria)});
        }
        for (const auto* result : boxes.results) {
            const std::size_t track = resultNumbers.at(result->trackId);
            frame.results.push_back(drive.results.size());
            drive.results.push_back(
                {track, scores[track], isIgnorable(*result, boxes.areas, criteria)});
        }
        frame.overlap = overlaps(boxes.labels, boxes.results, criteria.overlap);
        drive.frames.push_back(std::move(frame));
    }
    return drive;
}

}  // namespace djpete::evaluation
