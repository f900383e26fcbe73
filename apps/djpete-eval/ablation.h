/// What objects do to odometry: the same drive run with objects off, beside it and within it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "djpete/evaluation/frame_range.h"
#include "djpete/evaluation/object_errors.h"
#include "djpete/evaluation/trajectory_errors.h"

namespace djpete::apps {

/// One run of a drive.
struct AblationRun {
    std::string mode;  ///< off, worker or joint
    evaluation::TrajectoryErrors trajectory;
    bool samePathAsOff = false;  ///< trajectory.kitti.txt has the same bytes
    std::optional<evaluation::ObjectErrors> objects;
};

struct AblationDrive {
    std::string name;  ///< of the folder
    std::vector<AblationRun> runs;
};

/// How to compare; see DjpeteEvalApp.
struct AblationOptions {
    std::optional<evaluation::FrameRange> range;
    evaluation::ObjectCriteria criteria;
    bool worldFromTruth = false;
};

/// Reads off/, worker/ and joint/ of the folder, each with trajectory.kitti.txt and objects.csv as
/// djpete-slam writes them; truth.txt with the true poses; and labels.txt, KITTI tracking labels.
/// Without labels.txt objects are not compared; off/ may lack objects.csv. Throws obs::InputError
/// if anything else is missing or malformed.
AblationDrive readAblation(const std::string& folder, const AblationOptions& options);

/// One table per drive.
std::string ablationTable(const std::vector<AblationDrive>& drives);
/// One JSON array with an object per drive: name and runs, each with mode, same_path_as_off and the
/// keys of jsonReport(). Runs whose objects are not compared have no keys of objects.
std::string ablationJson(const std::vector<AblationDrive>& drives);

}  // namespace djpete::apps
