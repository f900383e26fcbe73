#include "tracking_counts.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "djpete/solver/assignment.h"

namespace djpete::evaluation {

namespace {

/// So much dearer than any sum of overlaps of one frame that a pair more is always better.
constexpr double kAlone = 1e4;

void matchFrame(const TrackingFrame& frame, double limit, TrackingPass& pass) {
    std::vector<Eigen::Index> columns;
    for (std::size_t j = 0; j < frame.results.size(); ++j) {
        if (pass.kept[frame.results[j]]) columns.push_back(static_cast<Eigen::Index>(j));
    }
    if (columns.empty() || frame.labels.empty()) return;
    Eigen::MatrixXd cost(frame.labels.size(), columns.size());
    for (Eigen::Index i = 0; i < cost.rows(); ++i) {
        for (Eigen::Index j = 0; j < cost.cols(); ++j) {
            const double overlap = frame.overlap(i, columns[static_cast<std::size_t>(j)]);
            cost(i, j) = overlap < limit ? std::numeric_limits<double>::infinity() : 1.0 - overlap;
        }
    }
    const auto columnOfRow = solver::assign(cost, kAlone);
    for (std::size_t i = 0; i < columnOfRow.size(); ++i) {
        if (!columnOfRow[i]) continue;
        const Eigen::Index j = columns[*columnOfRow[i]];
        const std::size_t result = frame.results[static_cast<std::size_t>(j)];
        pass.resultOfLabel[frame.labels[i]] = result;
        pass.matched[result] = true;
        pass.counts.overlapSum += frame.overlap(static_cast<Eigen::Index>(i), j);
        ++pass.counts.matches;
    }
}

/// Switches and fragments of one labelled track: `result` is the matched track of each of its rows,
/// -1 where there is none.
void countChanges(const std::vector<int64_t>& result, const std::vector<bool>& ignored,
                  TrackingCounts& counts) {
    const std::size_t n = result.size();
    const auto is = [](int64_t r) { return r != -1; };
    if (std::none_of(result.begin(), result.end(), is)) return;
    if (std::all_of(ignored.begin(), ignored.end(), [](bool i) { return i; })) return;
    int64_t last = result[0];
    for (std::size_t f = 1; f < n; ++f) {
        if (ignored[f]) {
            last = -1;
            continue;
        }
        const bool known = is(last) && is(result[f]);
        if (known && is(result[f - 1]) && last != result[f]) ++counts.switches;
        if (known && f < n - 1 && result[f - 1] != result[f] && is(result[f + 1])) {
            ++counts.fragments;
        }
        if (is(result[f])) last = result[f];
    }
    if (n > 1 && result[n - 2] != result[n - 1] && is(last) && is(result[n - 1]) &&
        !ignored[n - 1]) {
        ++counts.fragments;
    }
}

}  // namespace

TrackingPass passOver(const TrackingDrive& drive, double limit, std::optional<double> minScore) {
    TrackingPass pass;
    for (const auto& result : drive.results) {
        pass.kept.push_back(!minScore || result.score >= *minScore);
    }
    pass.matched.resize(drive.results.size(), false);
    pass.resultOfLabel.resize(drive.labels.size());
    for (const auto& frame : drive.frames) matchFrame(frame, limit, pass);
    for (std::size_t i = 0; i < drive.labels.size(); ++i) {
        if (drive.labels[i].ignored) continue;
        ++pass.counts.labels;
        if (!pass.resultOfLabel[i]) ++pass.counts.misses;
    }
    for (std::size_t j = 0; j < drive.results.size(); ++j) {
        if (pass.kept[j] && !pass.matched[j] && !drive.results[j].ignorable) {
            ++pass.counts.falsePositives;
        }
    }
    for (const auto& rows : drive.labelTracks) {
        std::vector<int64_t> result;
        std::vector<bool> ignored;
        for (const std::size_t i : rows) {
            const auto& match = pass.resultOfLabel[i];
            result.push_back(match ? static_cast<int64_t>(drive.results[*match].track) : -1);
            ignored.push_back(drive.labels[i].ignored);
        }
        countChanges(result, ignored, pass.counts);
    }
    return pass;
}

HotaSums hotaSums(const TrackingDrive& drive, const TrackingPass& pass) {
    std::vector<bool> compared(drive.results.size());
    for (std::size_t j = 0; j < compared.size(); ++j) {
        compared[j] = pass.kept[j] && (pass.matched[j] || !drive.results[j].ignorable);
    }
    for (std::size_t i = 0; i < drive.labels.size(); ++i) {
        if (drive.labels[i].ignored && pass.resultOfLabel[i]) {
            compared[*pass.resultOfLabel[i]] = false;
        }
    }
    std::vector<HotaFrame> frames;
    for (const auto& frame : drive.frames) {
        std::vector<Eigen::Index> rows, columns;
        HotaFrame out;
        for (std::size_t i = 0; i < frame.labels.size(); ++i) {
            if (drive.labels[frame.labels[i]].ignored) continue;
            rows.push_back(static_cast<Eigen::Index>(i));
            out.labelIds.push_back(drive.labels[frame.labels[i]].track);
        }
        for (std::size_t j = 0; j < frame.results.size(); ++j) {
            if (!compared[frame.results[j]]) continue;
            columns.push_back(static_cast<Eigen::Index>(j));
            out.resultIds.push_back(drive.results[frame.results[j]].track);
        }
        out.similarity = frame.overlap(rows, columns);
        frames.push_back(std::move(out));
    }
    return sumHota(frames, drive.labelTracks.size(), drive.resultTracks);
}

}  // namespace djpete::evaluation
