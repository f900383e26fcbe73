/// How well tracked 3D boxes of cars agree with labelled ones: CLEAR-MOT, sAMOTA and HOTA.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "djpete/evaluation/hota.h"
#include "djpete/evaluation/tracking_reader.h"

namespace djpete::evaluation {

enum class OverlapKind { Volume, BirdsEye };

/// What counts as what. The defaults are KITTI's for cars.
struct TrackingCriteria {
    OverlapKind overlap = OverlapKind::Volume;
    /// A pair of boxes with a smaller overlap is no match. Figures are given for each limit; HOTA's
    /// score threshold and preprocessing are those of the first.
    std::vector<double> limits{0.25, 0.5};
    double minHeight_px = 25;       ///< an unmatched result not higher than this is ignored
    double maxDontCareShare = 0.5;  ///< an unmatched result with more of its area there is ignored
    double maxTruncation = 0;       ///< a label more truncated is ignored
    double maxOcclusion = 2;        ///< a label more occluded is ignored
    std::size_t recallSteps = 40;   ///< number of score thresholds
};

/// Counts over all boxes at one limit and score threshold.
struct TrackingCounts {
    std::size_t labels = 0;          ///< that are not ignored
    std::size_t matches = 0;         ///< those with ignored labels too
    std::size_t falsePositives = 0;  ///< FP: results neither matched nor ignored
    std::size_t misses = 0;          ///< FN: labels neither matched nor ignored
    std::size_t switches = 0;        ///< IDS: a label's result changes from one row to the next
    std::size_t fragments = 0;       ///< FRAG: a label's track is lost or changed, and found again
    double overlapSum = 0;           ///< of all matches

    TrackingCounts& operator+=(const TrackingCounts& other);
    std::optional<double> mota() const;       ///< 1 - (FP + FN + IDS) / labels
    std::optional<double> motp() const;       ///< mean overlap of the matches
    std::optional<double> recall() const;     ///< matches / (matches + FN)
    std::optional<double> precision() const;  ///< matches / (matches + FP)
};

/// Figures of one limit.
struct LimitFigures {
    double limit = 0;
    /// Score threshold of the best MOTA, the highest one if several are best. Nothing if there are
    /// fewer than two matches, hence no thresholds: all results then count.
    std::optional<double> score;
    TrackingCounts counts;  ///< at that threshold
    /// Mean over the recall steps of MOTA scaled to the best that is possible at each recall.
    /// Nothing if the results have no scores.
    std::optional<double> sAmota;
};

struct SequenceFigures {
    std::string name;
    std::vector<TrackingCounts> joint;  ///< per limit, at the threshold that is best for all drives
    std::vector<LimitFigures> own;      ///< per limit, at the threshold that is best for this drive
    Hota hota;                          ///< at the joint threshold of the first limit
};

struct TrackingErrors {
    std::vector<LimitFigures> limits;
    Hota hota;
    std::vector<SequenceFigures> sequences;
};

/// Labels and results of one drive.
struct TrackingPair {
    TrackingSequence labels, results;
};

/// The protocol of KITTI's tracking benchmark lifted to 3D as AB3DMOT does (Weng et al. 2020), for
/// cars, in its deterministic form: every pass starts from the scores as read.
/// - Cars and vans are loaded, nothing else. Vans, truncated and heavily occluded labels are
///   ignored: neither a match nor a miss of them counts for MOTA.
/// - The score of a track is the mean over all its boxes of the drive; a threshold drops whole
///   tracks. Results without scores have score 0.
/// - In each frame labels and results are paired such that as many pairs as possible reach the
/// limit
///   and, among those, the sum of overlaps is largest. Identities play no part.
/// - Unmatched results are ignored if they are vans, low in the image, or in DontCare areas.
/// - A switch is a change of identity between consecutive rows of a label. Across a missed row a
///   change is none.
/// - Thresholds are sampled at recalls 1/40, 2/40, ...; the figures are those of the best MOTA.
/// Throws obs::InputError if a drive has a label with a score or there is no drive.
TrackingErrors evaluateTracking(const std::vector<TrackingPair>& drives,
                                const TrackingCriteria& criteria);

}  // namespace djpete::evaluation
