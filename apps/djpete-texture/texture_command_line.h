/// The command line of djpete-texture.
#pragma once

#include <optional>

#include "djpete_texture_app.h"

namespace djpete::apps {

/// Nothing if it only asked for help or the version, which then has been printed. Throws
/// obs::InputError on a command line that makes no sense.
std::optional<DjpeteTextureApp::Settings> parseTextureCommandLine(int argc,
                                                                  const char* const* argv);

}  // namespace djpete::apps
