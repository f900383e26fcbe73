/// djpete-eval --silhouettes: do the models fit what images of a drive show?
#pragma once

#include <optional>
#include <string>

#include "djpete/evaluation/drive_silhouettes.h"

namespace djpete::apps {

/// What the command line says of silhouettes.
struct SilhouetteSettings {
    std::string resultFolder;  ///< of djpete-slam; empty: no silhouettes are compared
    std::string detections;    ///< rawlog with masks or boxes
    /// Of the drive. If not given: `detections` without its _masks or _objects.
    std::optional<std::string> rawlog;
    std::string stripFolder;  ///< gets a picture of each object
    evaluation::Disturbance disturbance;
};

/// Compares and returns what is to be printed. Throws obs::InputError.
std::string silhouetteReport(const SilhouetteSettings& settings, bool json);

}  // namespace djpete::apps
