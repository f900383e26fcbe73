/// The program djpete-texture.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "djpete/texture/object_file.h"

namespace djpete::apps {

/// Edits saved object models, exports them and draws them before and after.
class DjpeteTextureApp {
  public:
    /// What the command line says.
    struct Settings {
        std::filesystem::path input;          ///< an .object file or a result folder
        std::vector<texture::Edit> edits;     ///< in the order of the command line
        std::size_t undo = 0;                 ///< edits to take back first
        bool list = false;                    ///< print what is in the file
        std::filesystem::path out;            ///< empty: the input itself
        std::filesystem::path mesh;           ///< .ply, .obj or .glb; empty: none
        std::filesystem::path points;         ///< .ply; empty: none
        std::filesystem::path pictureFolder;  ///< empty: none
    };
    Settings settings;

    /// Parses the command line. False if it only asked for help or the version, which then has been
    /// printed. Throws obs::InputError on a command line that makes no sense.
    bool initialize(int argc, const char** argv);
    /// Does it; what it did goes to `out`. Throws obs::InputError on bad input; files already done
    /// stay done, and no file is left half written.
    void run(std::ostream& out);

  private:
    void processFile(const std::filesystem::path& file, bool oneOfMany, std::ostream& out) const;
};

}  // namespace djpete::apps
