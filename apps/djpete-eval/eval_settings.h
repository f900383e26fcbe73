/// What djpete-eval is asked to do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "djpete/evaluation/tracking_errors.h"
#include "figures.h"
#include "report.h"
#include "silhouette_report.h"
#include "texture_report.h"

namespace djpete::apps {

/// What the command line says.
struct EvalSettings {
    std::string trajectoryFile;
    std::optional<std::string> truthFile, objectsFile, loopsFile;
    std::vector<std::string> labelsFiles;      ///< with trackingFiles also folders
    std::vector<std::string> ablationFolders;  ///< then no other files
    std::vector<std::string> trackingFiles;    ///< files or folders; then no trajectory
    std::optional<evaluation::FrameRange> range;
    evaluation::ObjectCriteria criteria;
    evaluation::TrackingCriteria trackingCriteria;
    TextureSettings textures;        ///< with a resultFolder no other files
    SilhouetteSettings silhouettes;  ///< likewise
    bool worldFromTruth = false;
    std::optional<figures::FigureRequest> figures;  ///< then nothing is compared
    bool json = false;
};

/// Throws obs::InputError on what makes no sense together.
void requireConsistent(const EvalSettings& settings);

}  // namespace djpete::apps
