#include "djpete/evaluation/frame_range.h"

#include <cmath>

#include "djpete/obs/errors.h"
#include "text_file.h"

namespace djpete::evaluation {

using obs::InputError;

namespace {

constexpr double kSameTime_s = 0.01;

std::string describe(const FrameRange& range) {
    return std::to_string(range.begin) + ":" + std::to_string(range.end);
}

void requireSameTimes(const TrajectoryFile& estimate, std::size_t estimateRow,
                      const TrajectoryFile& truth, std::size_t truthRow, std::size_t count) {
    if (estimate.stamps_s.empty() || truth.stamps_s.empty()) return;
    for (std::size_t i = 0; i < count; ++i) {
        const double a = estimate.stamps_s[estimateRow + i], b = truth.stamps_s[truthRow + i];
        if (std::abs(a - b) <= kSameTime_s) continue;
        throw InputError(estimate.path + ": pose " + std::to_string(estimateRow + i) +
                         " is of time " + std::to_string(a) + " s, but pose " +
                         std::to_string(truthRow + i) + " of " + truth.path + " is of " +
                         std::to_string(b) + " s; expected the same frames in both");
    }
}

Trajectory rows(const Trajectory& path, std::size_t first, std::size_t count) {
    const auto begin = path.begin() + static_cast<std::ptrdiff_t>(first);
    return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

FrameRange parseFrameRange(const std::string& text) {
    const auto colon = text.find(':');
    if (colon != std::string::npos) {
        try {
            const FrameRange range{parseCount(text.substr(0, colon), "", ""),
                                   parseCount(text.substr(colon + 1), "", "")};
            if (range.begin < range.end) return range;
        } catch (const InputError&) {
        }
    }
    throw InputError("range '" + text + "': expected A:B with whole numbers 0 <= A < B");
}

std::size_t firstEstimateRow(const TrajectoryFile& estimate, const FrameRange& range) {
    if (estimate.poses.size() == range.size()) return 0;
    if (estimate.poses.size() < range.end) {
        throw InputError(estimate.path + ": has " + std::to_string(estimate.poses.size()) +
                         " poses; range " + describe(range) + " needs exactly " +
                         std::to_string(range.size()) + ", or at least " +
                         std::to_string(range.end));
    }
    return range.begin;
}

TrajectoryPair pairTrajectories(const TrajectoryFile& estimate, const TrajectoryFile& truth,
                                const std::optional<FrameRange>& range) {
    if (!range) {
        if (estimate.poses.size() != truth.poses.size()) {
            throw InputError(estimate.path + ": has " + std::to_string(estimate.poses.size()) +
                             " poses but " + truth.path + " has " +
                             std::to_string(truth.poses.size()) +
                             "; expected equally many, or a range A:B of frames");
        }
        requireSameTimes(estimate, 0, truth, 0, truth.poses.size());
        return {estimate.poses, truth.poses};
    }
    if (truth.poses.size() < range->end) {
        throw InputError(truth.path + ": has " + std::to_string(truth.poses.size()) +
                         " poses; range " + describe(*range) + " needs at least " +
                         std::to_string(range->end));
    }
    const std::size_t first = firstEstimateRow(estimate, *range);
    requireSameTimes(estimate, first, truth, range->begin, range->size());
    TrajectoryPair pair{rows(estimate.poses, first, range->size()),
                        rows(truth.poses, range->begin, range->size())};
    if (range->begin == 0) return pair;
    return {startingAtIdentity(pair.estimate), startingAtIdentity(pair.truth)};
}

}  // namespace djpete::evaluation
