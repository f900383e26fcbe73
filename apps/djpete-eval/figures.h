/// djpete-eval --figures: pictures like the paper's. Kept apart from the rest of the program.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "djpete/figures/figures.h"

namespace djpete::apps {

/// What --figures, --result, --drive and --truth say. Nothing without --figures. Throws
/// obs::InputError if they do not go together.
std::optional<figures::FigureRequest> figureRequest(const std::optional<std::string>& figures,
                                                    const std::optional<std::string>& result,
                                                    const std::optional<std::string>& drive,
                                                    const std::optional<std::string>& truth);

/// Draws and prints what was drawn and what was not.
void runFigures(const figures::FigureRequest& request, std::ostream& out);

}  // namespace djpete::apps
