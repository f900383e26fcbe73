#include "djpete/evaluation/tracking_errors.h"

#include <algorithm>
#include <functional>

#include "djpete/obs/errors.h"
#include "tracking_counts.h"

namespace djpete::evaluation {

namespace {

using Drives = std::vector<const TrackingDrive*>;

/// A score threshold and the recall it was sampled for.
struct Threshold {
    double score = 0, recall = 0;
};

TrackingCounts countsOf(const Drives& drives, double limit, std::optional<double> minScore) {
    TrackingCounts counts;
    for (const auto* drive : drives) counts += passOver(*drive, limit, minScore).counts;
    return counts;
}

/// Scores at which the recall comes nearest to 1/steps, 2/steps, ..., highest score first.
std::vector<Threshold> sampleThresholds(const Drives& drives, double limit, std::size_t steps) {
    std::vector<double> scores;
    TrackingCounts counts;
    for (const auto* drive : drives) {
        const TrackingPass pass = passOver(*drive, limit, std::nullopt);
        counts += pass.counts;
        for (const auto& match : pass.resultOfLabel) {
            if (match) scores.push_back(drive->results[*match].score);
        }
    }
    std::sort(scores.begin(), scores.end(), std::greater<>());
    const auto all = static_cast<double>(counts.matches + counts.misses);
    std::vector<Threshold> out;
    double recall = 0;
    for (std::size_t i = 0; i < scores.size(); ++i) {
        const bool last = i + 1 == scores.size();
        const double left = static_cast<double>(i + 1) / all;
        const double right = last ? left : static_cast<double>(i + 2) / all;
        if (!last && right - recall < recall - left) continue;
        out.push_back({scores[i], recall});
        recall += 1.0 / static_cast<double>(steps);
    }
    if (!out.empty()) out.erase(out.begin());  // recall 0
    return out;
}

/// MOTA where the misses that the recall makes unavoidable are forgiven, 0..1.
double scaledMota(const TrackingCounts& c, double recall) {
    const auto labels = static_cast<double>(c.labels);
    const auto errors = static_cast<double>(c.falsePositives + c.misses + c.switches);
    if (c.labels == 0) return 0;
    return std::clamp(1 - (errors - (1 - recall) * labels) / (recall * labels), 0.0, 1.0);
}

LimitFigures evaluateLimit(const Drives& drives, double limit, std::size_t steps, bool scored) {
    LimitFigures out;
    out.limit = limit;
    double sum = 0, best = 0;
    for (const auto& t : sampleThresholds(drives, limit, steps)) {
        const TrackingCounts counts = countsOf(drives, limit, t.score);
        sum += scaledMota(counts, t.recall);
        const double mota = counts.mota().value_or(0);
        if (out.score && mota <= best) continue;
        out.score = t.score;
        out.counts = counts;
        best = mota;
    }
    if (!out.score) out.counts = countsOf(drives, limit, std::nullopt);
    if (scored) out.sAmota = sum / static_cast<double>(steps);
    return out;
}

std::optional<double> ratio(double a, std::size_t b) {
    if (b == 0) return std::nullopt;
    return a / static_cast<double>(b);
}

bool hasScores(const TrackingPair& pair) {
    return !pair.results.boxes.empty() && pair.results.boxes.front().score.has_value();
}

void requireSense(const std::vector<TrackingPair>& pairs) {
    if (pairs.empty()) throw obs::InputError("tracking: expected at least one drive");
    for (const auto& pair : pairs) {
        if (!pair.labels.boxes.empty() && pair.labels.boxes.front().score) {
            throw obs::InputError("tracking: the labels of drive " + pair.labels.name +
                                  " have scores; expected labels, not results");
        }
    }
}

}  // namespace

TrackingCounts& TrackingCounts::operator+=(const TrackingCounts& other) {
    labels += other.labels;
    matches += other.matches;
    falsePositives += other.falsePositives;
    misses += other.misses;
    switches += other.switches;
    fragments += other.fragments;
    overlapSum += other.overlapSum;
    return *this;
}

std::optional<double> TrackingCounts::mota() const {
    const auto share = ratio(static_cast<double>(falsePositives + misses + switches), labels);
    if (!share) return std::nullopt;
    return 1 - *share;
}

std::optional<double> TrackingCounts::motp() const { return ratio(overlapSum, matches); }

std::optional<double> TrackingCounts::recall() const {
    return ratio(static_cast<double>(matches), matches + misses);
}

std::optional<double> TrackingCounts::precision() const {
    return ratio(static_cast<double>(matches), matches + falsePositives);
}

TrackingErrors evaluateTracking(const std::vector<TrackingPair>& pairs,
                                const TrackingCriteria& criteria) {
    requireSense(pairs);
    std::vector<TrackingDrive> drives;
    for (const auto& pair : pairs) drives.push_back(prepareDrive(pair, criteria));
    Drives all;
    for (const auto& drive : drives) all.push_back(&drive);
    const bool scored = std::any_of(pairs.begin(), pairs.end(), hasScores);

    TrackingErrors out;
    for (const double limit : criteria.limits) {
        out.limits.push_back(evaluateLimit(all, limit, criteria.recallSteps, scored));
    }
    HotaSums sums;
    for (std::size_t d = 0; d < drives.size(); ++d) {
        SequenceFigures figures;
        figures.name = pairs[d].labels.name;
        for (const auto& joint : out.limits) {
            const TrackingPass pass = passOver(drives[d], joint.limit, joint.score);
            figures.joint.push_back(pass.counts);
            figures.own.push_back(evaluateLimit({&drives[d]}, joint.limit, criteria.recallSteps,
                                                hasScores(pairs[d])));
            if (figures.joint.size() > 1) continue;
            const HotaSums own = hotaSums(drives[d], pass);
            figures.hota = hotaOf(own);
            sums += own;
        }
        out.sequences.push_back(std::move(figures));
    }
    out.hota = hotaOf(sums);
    return out;
}

}  // namespace djpete::evaluation
