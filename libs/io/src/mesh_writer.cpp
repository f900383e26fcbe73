#include "djpete/io/mesh_writer.h"

#include <assimp/config.h>
#include <assimp/Exporter.hpp>
#include <cstring>
#include <filesystem>

#include "djpete/obs/errors.h"
#include "mesh_scene.h"
#include "text_file.h"

namespace djpete::io {

namespace {

using obs::InputError;
using texture::ColouredMesh;
namespace fs = std::filesystem;

void writeBytes(const void* bytes, std::size_t size, const std::string& file) {
    TextFile out(file, true);
    out.stream().write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    out.close();
}

void writePly(const ColouredMesh& mesh, const std::string& file) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment frame obj, metres\n";
    bytes += "element vertex " + std::to_string(mesh.vertices.size()) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
        bytes += std::string("property float ") + name + "\n";
    }
    for (const char* name : {"red", "green", "blue"}) {
        bytes += std::string("property uchar ") + name + "\n";
    }
    bytes += "element face " + std::to_string(mesh.triangles.size()) +
             "\nproperty list uchar int vertex_indices\nend_header\n";
    // Debian builds MRPT for little-endian machines only.
    const auto put = [&](const auto& value) {
        char raw[sizeof(value)];
        std::memcpy(raw, &value, sizeof(value));
        bytes.append(raw, sizeof(value));
    };
    for (const auto& v : mesh.vertices) {
        put(v.position);
        put(v.normal);
        put(v.rgb);
    }
    for (const auto& t : mesh.triangles) {
        put(uint8_t{3});
        put(t);
    }
    writeBytes(bytes.data(), bytes.size(), file);
}

/// The file of this format, and what comes with it, as NAME.ENDING beside it.
void writeByAssimp(const aiScene& scene, const char* format, const fs::path& file) {
    Assimp::Exporter exporter;
    Assimp::ExportProperties properties;
    properties.SetPropertyString(AI_CONFIG_EXPORT_BLOB_NAME, file.stem().string());
    const aiExportDataBlob* blob = exporter.ExportToBlob(&scene, format, 0, &properties);
    if (blob == nullptr) {
        throw InputError(file.string() + ": cannot be made: " + exporter.GetErrorString());
    }
    writeBytes(blob->data, blob->size, file.string());
    for (blob = blob->next; blob != nullptr; blob = blob->next) {
        const fs::path beside(blob->name.C_Str());
        const std::string ending =
            beside.has_extension() ? beside.extension().string() : "." + beside.string();
        writeBytes(blob->data, blob->size, fs::path(file).replace_extension(ending).string());
    }
}

}  // namespace

void writeMesh(const ColouredMesh& mesh, const std::string& file) {
    const fs::path path(file);
    const std::string ending = path.extension().string();
    if (ending != ".ply" && ending != ".obj" && ending != ".glb") {
        throw InputError(file + ": expected a mesh file with the ending .ply, .obj or .glb");
    }
    if (mesh.triangles.empty()) {
        throw InputError(file + ": there is no surface to write; expected a model with points");
    }
    if (ending == ".ply") return writePly(mesh, file);
    SceneStyle style;
    std::vector<uint8_t> png;
    if (!mesh.atlas.empty()) png = pngOf(mesh.atlas);
    if (ending == ".glb") {
        style.yUp = true;
        style.linearColours = true;
        style.png = png;
        if (!png.empty()) style.texture = "*0";
        return writeByAssimp(*sceneOf(mesh, style), "glb2", path);
    }
    if (!png.empty()) {
        const fs::path picture = fs::path(path).replace_extension(".png");
        style.texture = picture.filename().string();
        writeBytes(png.data(), png.size(), picture.string());
    }
    writeByAssimp(*sceneOf(mesh, style), "obj", path);
}

}  // namespace djpete::io
