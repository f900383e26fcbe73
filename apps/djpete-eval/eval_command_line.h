/// The command line of djpete-eval.
#pragma once

#include <optional>

#include "eval_settings.h"

namespace djpete::apps {

/// Nothing if it only asked for help or the version, which then has been printed. Throws
/// obs::InputError on a word or value that makes no sense by itself.
std::optional<EvalSettings> parseCommandLine(int argc, const char** argv);

}  // namespace djpete::apps
