/// djpete-eval --textures: how good the object textures of a result are.
#pragma once

#include <optional>
#include <string>

#include "djpete/evaluation/texture_evaluation.h"

namespace djpete::apps {

/// What the command line says of textures.
struct TextureSettings {
    std::string resultFolder;           ///< of djpete-slam; empty: no textures are evaluated
    std::string driveFolder;            ///< of simulate-drive, with meshes
    std::optional<std::string> rawlog;  ///< DRIVE.rawlog if not given
    bool rebuild = false;     ///< make the models again even if the result has .object files
    std::string stripFolder;  ///< gets a picture of each object
    std::string curveFile;    ///< CSV of errors from view to view; its plot beside it as .png
    evaluation::Disturbance disturbance;
};

/// Evaluates and returns what is to be printed.
std::string textureReport(const TextureSettings& settings, bool json);

/// "M,DEG". Throws obs::InputError.
evaluation::Disturbance parseDisturbance(const std::string& text);

}  // namespace djpete::apps
