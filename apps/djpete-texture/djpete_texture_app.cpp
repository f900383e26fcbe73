#include "djpete_texture_app.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "djpete/io/mesh_writer.h"
#include "djpete/io/ply_writer.h"
#include "djpete/obs/errors.h"
#include "djpete/texture/surface.h"
#include "edit_pictures.h"
#include "texture_command_line.h"

namespace djpete::apps {

namespace fs = std::filesystem;
using obs::InputError;
using texture::ObjectModel;

/// One object on its way through the program.
struct DjpeteTextureApp::Item {
    fs::path file;
    texture::SavedObject saved;
    std::vector<ObjectModel> states;  ///< the original, and after each edit
    std::vector<std::string> news;    ///< of new edits
};

namespace {

bool isObjectFile(const fs::path& file) { return file.extension() == ".object"; }

std::vector<fs::path> objectFiles(const fs::path& input) {
    std::error_code error;
    if (!fs::exists(input, error)) throw InputError(input.string() + ": no such file or folder");
    if (!fs::is_directory(input)) return {input};
    const fs::path inside = fs::is_directory(input / "objects") ? input / "objects" : input;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(inside, error)) {
        if (isObjectFile(entry.path())) files.push_back(entry.path());
    }
    if (files.empty()) {
        throw InputError(inside.string() + ": expected files like 0000.object in the folder");
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::string sentenceOf(const texture::Edit& edit) {
    std::string out = edit.name;
    if (!edit.parameters.empty()) out += " " + edit.parameters;
    if (!edit.region.empty()) out += " in " + edit.region;
    return out;
}

/// car.glb becomes car_0007.glb if there are many objects.
std::string numbered(const std::string& name, const fs::path& object, bool many) {
    if (!many) return name;
    const fs::path path(name);
    return (path.parent_path() /
            (path.stem().string() + "_" + object.stem().string() + path.extension().string()))
        .string();
}

/// Wrong endings are told before work begins.
void requireEndings(const DjpeteTextureApp::Settings& s) {
    for (const auto& file : s.meshes) {
        const std::string ending = fs::path(file).extension().string();
        if (ending != ".ply" && ending != ".obj" && ending != ".glb") {
            throw InputError("command line: --export " + file +
                             ": expected the ending .ply, .obj or .glb");
        }
    }
    for (const auto& file : s.points) {
        if (fs::path(file).extension() != ".ply") {
            throw InputError("command line: --export-points " + file +
                             ": expected the ending .ply");
        }
    }
}

std::string summaryOf(const ObjectModel& model, std::size_t edits) {
    std::size_t inferred = 0;
    for (const uint8_t flags : model.flags) {
        inferred += (flags & texture::flag::kInferredPoint) != 0 ? 1U : 0U;
    }
    char text[160];
    std::snprintf(text, sizeof(text),
                  "%s %.2f x %.2f x %.2f m, %zu points (%zu inferred), %.0f %% with colour, %zu %s",
                  obs::toString(model.objectClass).c_str(), model.size_m.x(), model.size_m.y(),
                  model.size_m.z(), model.size(), inferred, 100 * model.coverage(), edits,
                  edits == 1 ? "edit" : "edits");
    return text;
}

}  // namespace

bool DjpeteTextureApp::initialize(int argc, const char* const* argv) {
    const auto parsed = parseTextureCommandLine(argc, argv);
    if (!parsed) return false;
    settings = *parsed;
    requireEndings(settings);
    return true;
}

DjpeteTextureApp::Item DjpeteTextureApp::read(const fs::path& file) const {
    Item item;
    item.file = file;
    item.saved = texture::loadObject(file);
    auto& edits = item.saved.edits;
    if (edits.size() < settings.undo) {
        throw InputError(file.string() + ": expected " + std::to_string(settings.undo) +
                         " edits to undo, it has " + std::to_string(edits.size()));
    }
    edits.resize(edits.size() - settings.undo);
    return item;
}

void DjpeteTextureApp::edit(Item& item, const std::vector<texture::Edit>& edits) const {
    const bool keepStates = !settings.pictures.empty();
    item.states = {item.saved.original};
    const auto step = [&](const texture::Edit& e) {
        texture::EditReport report;
        ObjectModel next = texture::apply(item.states.back(), e, &report);
        if (!keepStates) item.states.clear();
        item.states.push_back(std::move(next));
        return report.text;
    };
    try {
        for (const auto& e : item.saved.edits) step(e);
        for (const auto& e : edits) item.news.push_back(sentenceOf(e) + ": " + step(e));
    } catch (const InputError& e) {
        throw InputError(item.file.string() + ": " + e.what());
    }
    item.saved.edits.insert(item.saved.edits.end(), edits.begin(), edits.end());
    if (!settings.albedo) return;
    for (ObjectModel& state : item.states) {
        if (state.albedo.empty()) {
            throw InputError(item.file.string() +
                             ": expected an object with albedo for --albedo; it is found by "
                             "djpete-slam with [texture] albedo = true on drives whose images show "
                             "the ground around the objects");
        }
        state = state.withAlbedo();
    }
}

void DjpeteTextureApp::write(const Item& item, bool many, std::ostream& out) const {
    const bool changed = settings.undo > 0 || !settings.edits.empty();
    fs::path target = item.file;
    if (!settings.out.empty()) {
        target = settings.out;
        if (fs::is_directory(settings.input)) {
            std::error_code error;
            fs::create_directories(settings.out, error);
            target /= item.file.filename();
        }
    }
    const ObjectModel& model = item.states.back();
    const auto& edits = item.saved.edits;
    if (changed || !settings.out.empty()) texture::saveObject(item.saved, target);
    out << target.string() << ": " << summaryOf(model, edits.size()) << "\n";
    for (const auto& news : item.news) out << "  " << news << "\n";
    for (std::size_t k = 0; settings.list && k < edits.size(); ++k) {
        out << "  " << k + 1 << " " << sentenceOf(edits[k]) << "\n";
    }
    for (const auto& name : settings.points) {
        io::writeObjectPly(model, numbered(name, item.file, many));
    }
    if (!settings.meshes.empty()) {
        texture::MeshOptions options;
        options.close = settings.closed;
        const auto mesh = texture::makeMesh(model, options);
        for (const auto& name : settings.meshes) {
            const std::string file = numbered(name, item.file, many);
            if (many && mesh.triangles.empty()) {
                out << "  " << file << ": not written, too few points for a surface\n";
            } else {
                io::writeMesh(mesh, file);
                out << "  " << file << ": " << mesh.triangles.size() << " triangles\n";
            }
        }
    }
    if (settings.pictures.empty()) return;
    const std::string stem = item.file.stem().string();
    if (edits.empty()) writePicture({{"", &model}}, settings.pictures / (stem + ".png"));
    for (std::size_t k = 0; k < edits.size(); ++k) {
        char number[32];
        std::snprintf(number, sizeof(number), "_%02zu_", k + 1);
        writePicture(
            {{"before", &item.states[k]}, {"after " + sentenceOf(edits[k]), &item.states[k + 1]}},
            settings.pictures / (stem + number + edits[k].name + ".png"));
    }
}

void DjpeteTextureApp::run(std::ostream& out) {
    std::vector<texture::Edit> edits;
    for (const auto& wanted : settings.edits) {
        if (wanted.name == "replace-from") {
            const ObjectModel other = texture::replay(texture::loadObject(wanted.parameters));
            edits.push_back(texture::replaceFrom(
                other, fs::path(wanted.parameters).filename().string(), wanted.region));
        } else {
            edits.push_back({wanted.name, wanted.parameters, wanted.region, {}});
        }
    }
    std::vector<Item> items;
    for (const auto& file : objectFiles(settings.input)) items.push_back(read(file));
    for (auto& item : items) edit(item, edits);
    const bool many = fs::is_directory(settings.input);
    for (const auto& item : items) write(item, many, out);
}

}  // namespace djpete::apps
