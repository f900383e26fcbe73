/// Which result belongs to which labels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "djpete/evaluation/frame_range.h"
#include "djpete/evaluation/tracking_errors.h"

namespace djpete::apps {

/// Reads results and labels of several drives. Each path is a file or a folder; of a folder all
/// *.txt files count, in order of their names. Equally many files given by name on both sides are
/// paired in order; else files are paired by name, and labels without a result are left out if they
/// come from a folder. With a range only its frames count. Throws obs::InputError if a
/// result has no labels, labels given by name have no result, or a name is there twice.
std::vector<evaluation::TrackingPair> readTrackingPairs(
    const std::vector<std::string>& results, const std::vector<std::string>& labels,
    const std::optional<evaluation::FrameRange>& range);

}  // namespace djpete::apps
