/// Were places known again, and rightly so?
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "djpete/evaluation/statistics.h"
#include "djpete/evaluation/trajectory.h"

namespace djpete::evaluation {

/// One row of loops.csv.
struct LoopRow {
    std::size_t line = 0;
    std::size_t olderDrive = 0, olderFrame = 0, newerDrive = 0, newerFrame = 0;
    std::size_t features = 0;
    bool near = false, joined = false;
    double correction_m = 0, correction_deg = 0;
    geometry::SE3 T_older_newer;
};

/// Reads what djpete-slam wrote. Throws obs::InputError naming file and line and what was expected.
std::vector<LoopRow> readLoopsCsv(const std::string& path);

/// When the truth says that a frame sees the place of an older one, and when a pair of views is
/// wrong.
struct LoopCriteria {
    double revisit_m = 3;
    double revisit_deg = 20;
    std::size_t minGapFrames = 200;   ///< between both visits
    std::size_t mergeGapFrames = 20;  ///< revisits with shorter breaks are one
    double wrong_m = 1, wrong_deg = 3;
};

struct Revisit {
    std::size_t first = 0, last = 0;  ///< frames of the second visit
    std::size_t pairs = 0;            ///< believed pairs whose newer frame is in it
};

struct LoopErrors {
    std::vector<Revisit> revisits;  ///< by the truth
    std::size_t found = 0;          ///< of these, with a pair or more
    std::size_t pairs = 0, wrong = 0;
    Summary error_m, error_deg;  ///< of all pairs against the truth
};

/// `truth`: T_world_cam per frame; all drives of the map must have been driven along it. Throws
/// obs::InputError naming `origin` and the row if a frame is not in the truth.
LoopErrors evaluateLoops(const std::vector<LoopRow>& rows, const Trajectory& truth,
                         const std::string& origin, const LoopCriteria& criteria = {});

}  // namespace djpete::evaluation
