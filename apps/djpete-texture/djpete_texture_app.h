/// The program djpete-texture.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "djpete/texture/editing.h"

namespace djpete::apps {

/// Completes, edits and exports saved object models, one file or all of a result folder. Edits go
/// into the file beside the original, which stays.
class DjpeteTextureApp {
  public:
    /// An edit as the command line tells it.
    struct WantedEdit {
        std::string name;
        std::string parameters;  ///< of replace-from: a file
        std::string region;
    };
    /// What the command line says.
    struct Settings {
        std::filesystem::path input;    ///< file, result folder, or folder of .object files
        std::filesystem::path out;      ///< empty: the input
        std::vector<WantedEdit> edits;  ///< in order
        std::size_t undo = 0;           ///< so many edits are taken back, before the new ones
        bool list = false;
        bool closed = false;                      ///< surfaces have no holes
        bool albedo = false;                      ///< exports and pictures show it
        std::vector<std::string> meshes, points;  ///< files to export to
        std::filesystem::path pictures;           ///< folder; empty: none
    };
    Settings settings;

    /// Parses the command line. False if it only asked for help or the version, which then has been
    /// printed. Throws obs::InputError on a command line that makes no sense.
    bool initialize(int argc, const char* const* argv);
    /// Reads all, edits all, then writes. Throws obs::InputError on bad input, before any file is
    /// written.
    void run(std::ostream& out);

  private:
    struct Item;
    Item read(const std::filesystem::path& file) const;
    void edit(Item& item, const std::vector<texture::Edit>& edits) const;
    void write(const Item& item, bool many, std::ostream& out) const;
};

}  // namespace djpete::apps
