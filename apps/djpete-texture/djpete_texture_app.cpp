#include "djpete_texture_app.h"

#include <algorithm>
#include <map>
#include <ostream>

#if __has_include("djpete/io/mesh_writer.h")
#include "djpete/io/mesh_writer.h"
#define MESH
#endif
#include "djpete/io/object_picture.h"
#include "djpete/io/ply_writer.h"
#include "djpete/obs/errors.h"
#include "djpete/texture/editing.h"
#include "djpete/texture/region.h"
#ifdef MESH
#include "djpete/texture/surface.h"
#endif
#include "djpete_app/command_line.h"

namespace djpete::apps {

namespace fs = std::filesystem;
using obs::InputError;

namespace {

using StringArg = TCLAP::ValueArg<std::string>;

struct CommandLine {
    CommandLineOutput output;
    TCLAP::CmdLine cmd{
        "Edits the object models that djpete-slam leaves in RESULT/objects/*.object. Edits are "
        "done "
        "in the order in which they stand here and kept in the file as a list; the original is "
        "never lost",
        ' ', "0.1.0"};
    TCLAP::UnlabeledMultiArg<std::string> input{
        "input", "An .object file, or a result folder: all of its objects", true,
        "FILE.object|RESULT", cmd};
    StringArg recolour{"",    "recolour", "Give the paint another hue; light and shade stay",
                       false, "",         "R,G,B",
                       cmd};
    StringArg brush{"", "brush", "Paint the region in this colour", false, "", "R,G,B", cmd};
    TCLAP::SwitchArg symmetrise{"", "symmetrise",
                                "Complete what was not seen from the other side of the car", cmd};
    TCLAP::SwitchArg fill{"", "fill", "Smooth colours where there is none", cmd};
    StringArg smooth{"",    "smooth", "Smooth colours over neighbours so near; edges stay",
                     false, "",       "METRES",
                     cmd};
    TCLAP::SwitchArg crop{"", "crop", "Remove the region", cmd};
    TCLAP::SwitchArg keep{"", "keep", "Remove all but the region", cmd};
    TCLAP::SwitchArg denoise{"", "denoise",
                             "Remove stray points; stray colours take their neighbours'", cmd};
    StringArg replaceFrom{"",
                          "replace-from",
                          "Take the colours of another object, box on box",
                          false,
                          "",
                          "OTHER.object",
                          cmd};
    StringArg region{
        "",
        "region",
        "Where the edits work (default: everywhere): box x0:x1,y0:y1,z0:z1 | sphere x,y,z,r | "
        "normal dx,dy,dz,degrees | colour r0:r1,g0:g1,b0:b1; several, separated by ';', must all "
        "hold. Metres in the object's frame: x front, y left, z up, 0 the box's centre",
        false,
        "",
        "REGION",
        cmd};
    TCLAP::ValueArg<int> undo{"",  "undo", "Take the last N edits back, before new ones", false, 0,
                              "N", cmd};
    TCLAP::SwitchArg list{"", "list", "Print points, coverage and edits", cmd};
    StringArg out{"",    "out", "Write here instead of into the input (a folder for a folder)",
                  false, "",    "FILE|FOLDER",
                  cmd};
    StringArg mesh{
        "",
        "export",
        "Write the surface as a coloured mesh, by its ending .ply, .obj (with a texture) "
        "or .glb; for a folder just the ending",
        false,
        "",
        "FILE",
        cmd};
    StringArg points{"",
                     "export-points",
                     "Write the coloured points as .ply; for a folder just the ending",
                     false,
                     "",
                     "FILE",
                     cmd};
    StringArg pictures{
        "",    "pictures", "Draw each object from five sides, before (above) and after (below)",
        false, "",         "FOLDER",
        cmd};

    CommandLine() {
        delete cmd.getOutput();  // setOutput() forgets the default one
        cmd.setOutput(&output);
    }
};

/// Where an option stands in the command line.
std::size_t placeOf(const std::string& option, int argc, const char** argv) {
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--" + option || word.rfind("--" + option + "=", 0) == 0) {
            return static_cast<std::size_t>(i);
        }
    }
    return 0;
}

std::vector<texture::Edit> editsOf(CommandLine& line, int argc, const char** argv) {
    std::map<std::size_t, texture::Edit> byPlace;
    const std::string region = line.region.getValue();
    texture::Region::parse(region);
    const auto add = [&](bool set, const std::string& option, texture::Edit edit) {
        if (set) byPlace[placeOf(option, argc, argv)] = std::move(edit);
    };
    const auto simple = [&](TCLAP::SwitchArg& arg, const std::string& name, bool regional) {
        add(arg.getValue(), name, {name, "", regional ? region : "", {}});
    };
    const auto valued = [&](StringArg& arg, const std::string& name) {
        add(arg.isSet(), name, {name, arg.getValue(), region, {}});
    };
    valued(line.recolour, "recolour");
    valued(line.brush, "brush");
    valued(line.smooth, "smooth");
    simple(line.symmetrise, "symmetrise", false);
    simple(line.fill, "fill", false);
    simple(line.crop, "crop", true);
    simple(line.keep, "keep", true);
    simple(line.denoise, "denoise", true);
    if (line.replaceFrom.isSet()) {
        const auto other = texture::loadObject(line.replaceFrom.getValue());
        add(true, "replace-from",
            {"replace", "", region, texture::packObject(texture::replayed(other))});
    }
    std::vector<texture::Edit> out;
    for (auto& [place, edit] : byPlace) out.push_back(std::move(edit));
    // Texts that make no sense are told before any file is touched.
    for (const auto& edit : out) texture::applied(texture::ObjectModel(), edit);
    if (out.empty() && !region.empty()) {
        throw InputError("command line: --region needs an edit that it is for; see --help");
    }
    return out;
}

/// For one of many: the object's file with the ending that was asked for.
fs::path exportPath(const fs::path& asked, const fs::path& file, bool oneOfMany) {
    if (!oneOfMany) return asked;
    const std::string ending =
        asked.extension().empty() ? asked.filename().string() : asked.extension().string();
    return fs::path(file).replace_extension(ending);
}

std::string describe(const texture::ObjectModel& model) {
    std::size_t inferred = 0, edited = 0;
    for (const uint8_t flags : model.flags) {
        inferred += (flags & (texture::flag::kInferredPoint | texture::flag::kInferredColour)) != 0;
        edited += (flags & texture::flag::kEdited) != 0;
    }
    return std::to_string(model.size()) + " points, " +
           std::to_string(static_cast<int>(100 * model.coverage() + 0.5)) + " % coloured, " +
           std::to_string(inferred) + " inferred, " + std::to_string(edited) + " edited, " +
           std::to_string(model.views.size()) + " views";
}

std::vector<fs::path> objectFiles(const fs::path& folder) {
    const fs::path inside = folder / "objects";
    std::vector<fs::path> out;
    for (const auto& entry : fs::directory_iterator(fs::is_directory(inside) ? inside : folder)) {
        if (entry.path().extension() == ".object") out.push_back(entry.path());
    }
    std::sort(out.begin(), out.end());
    if (out.empty()) {
        throw InputError(folder.string() +
                         ": no object file; expected objects/*.object of a result");
    }
    return out;
}

void makeFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder)) {
        throw InputError(folder.string() + ": this folder cannot be made");
    }
}

}  // namespace

bool DjpeteTextureApp::initialize(int argc, const char** argv) {
    CommandLine line;
    if (!line.cmd.parse(argc, argv)) return false;
    for (const auto& word : line.input.getValue()) {
        if (word.rfind("-", 0) == 0) {
            throw InputError("command line: unknown option " + word + "; see --help");
        }
    }
    if (line.input.getValue().size() != 1) {
        throw InputError("command line: expected one FILE.object or one result folder, got " +
                         std::to_string(line.input.getValue().size()) + "; see --help");
    }
    settings = Settings();
    settings.input = line.input.getValue().front();
    if (line.undo.isSet() && line.undo.getValue() < 1) {
        throw InputError("command line: expected --undo above 0, got " +
                         std::to_string(line.undo.getValue()));
    }
    settings.undo = static_cast<std::size_t>(line.undo.getValue());
    settings.list = line.list.getValue();
    settings.out = line.out.getValue();
    settings.mesh = line.mesh.getValue();
    settings.points = line.points.getValue();
    settings.pictureFolder = line.pictures.getValue();
    settings.edits = editsOf(line, argc, argv);
    if (settings.edits.empty() && settings.undo == 0 && !settings.list && settings.mesh.empty() &&
        settings.points.empty() && settings.pictureFolder.empty()) {
        throw InputError("command line: nothing to do; see --help");
    }
    return true;
}

void DjpeteTextureApp::run(std::ostream& out) {
    if (fs::is_directory(settings.input)) {
        if (!settings.out.empty()) makeFolder(settings.out);
        for (const auto& file : objectFiles(settings.input)) processFile(file, true, out);
    } else {
        processFile(settings.input, false, out);
    }
}

void DjpeteTextureApp::processFile(const fs::path& file, bool oneOfMany, std::ostream& out) const {
    texture::SavedObject object = texture::loadObject(file);
    if (settings.undo > object.edits.size()) {
        throw InputError(file.string() + ": it has " + std::to_string(object.edits.size()) +
                         " edits, cannot take " + std::to_string(settings.undo) + " back");
    }
    const texture::ObjectModel before = texture::replayed(object);
    object.edits.resize(object.edits.size() - settings.undo);
    texture::ObjectModel after = settings.undo > 0 ? texture::replayed(object) : before;
    for (const auto& edit : settings.edits) {
        after = texture::applied(after, edit);
        object.edits.push_back(edit);
    }
    out << file.filename().string() << ": " << describe(after) << "\n";
    if (settings.list) {
        out << "  original: " << describe(object.original) << "\n";
        for (const auto& edit : object.edits) {
            out << "  " << edit.name << (edit.parameters.empty() ? "" : " " + edit.parameters)
                << (edit.region.empty() ? "" : "  region " + edit.region) << "\n";
        }
    }
    if (!settings.pictureFolder.empty()) {
        makeFolder(settings.pictureFolder);
        io::writeObjectPicture({before, after},
                               (settings.pictureFolder / file.stem()).string() + ".png");
    }
    if (!settings.points.empty()) {
        const fs::path target = exportPath(settings.points, file, oneOfMany);
        if (target.extension() != ".ply") {
            throw InputError(target.string() + ": points are written as .ply");
        }
        io::writeObjectPly(after, target.string());
    }
#ifdef MESH
    if (!settings.mesh.empty()) {
        io::writeMesh(texture::makeMesh(after),
                      exportPath(settings.mesh, file, oneOfMany).string());
    }
#endif
    const bool changed = settings.undo > 0 || !settings.edits.empty();
    if (!changed && settings.out.empty()) return;
    fs::path target = settings.out.empty() ? file : settings.out;
    if (oneOfMany && !settings.out.empty()) target = settings.out / file.filename();
    texture::saveObject(object, target);
}

}  // namespace djpete::apps
