#include "djpete/evaluation/truth_mesh.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "djpete/obs/errors.h"

namespace djpete::evaluation {

namespace {

using obs::InputError;

constexpr std::size_t kVertexBytes = 6 * 4 + 3, kFaceBytes = 1 + 3 * 4;
const char* const kVertexProperties[] = {"float x",   "float y",     "float z",
                                         "float nx",  "float ny",    "float nz",
                                         "uchar red", "uchar green", "uchar blue"};

std::string nextLine(std::ifstream& in, const std::string& path) {
    std::string line;
    do {
        if (!std::getline(in, line)) throw InputError(path + ": the PLY header has no end");
        if (!line.empty() && line.back() == '\r') line.pop_back();
    } while (line.rfind("comment", 0) == 0);
    return line;
}

void expectLine(std::ifstream& in, const std::string& path, const std::string& wanted) {
    const std::string line = nextLine(in, path);
    if (line != wanted) {
        throw InputError(path + ": PLY header says '" + line + "', expected '" + wanted + "'");
    }
}

std::size_t elementCount(std::ifstream& in, const std::string& path, const std::string& element) {
    const std::string line = nextLine(in, path);
    std::istringstream words(line);
    std::string word, name, rest;
    std::size_t count = 0;
    if (!(words >> word >> name >> count) || word != "element" || name != element ||
        words >> rest) {
        throw InputError(path + ": PLY header says '" + line + "', expected 'element " + element +
                         " COUNT'");
    }
    return count;
}

std::vector<char> readBytes(std::ifstream& in, const std::string& path, std::size_t count,
                            std::size_t size) {
    if (count > (std::size_t{1} << 28U)) throw InputError(path + ": expected fewer elements");
    std::vector<char> bytes(count * size);
    if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
        throw InputError(path + ": ends early, expected " + std::to_string(count) +
                         " elements of " + std::to_string(size) + " bytes");
    }
    return bytes;
}

void readVertices(std::ifstream& in, const std::string& path, std::size_t count, TruthMesh& mesh) {
    const auto bytes = readBytes(in, path, count, kVertexBytes);
    mesh.points.resize(count);
    mesh.normals.resize(count);
    mesh.srgb.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const char* at = bytes.data() + i * kVertexBytes;
        std::memcpy(mesh.points[i].data(), at, 12);
        std::memcpy(mesh.normals[i].data(), at + 12, 12);
        std::memcpy(mesh.srgb[i].data(), at + 24, 3);
        for (float v : mesh.points[i]) {
            if (!std::isfinite(v)) {
                throw InputError(path + ": vertex " + std::to_string(i) + " is not finite");
            }
        }
    }
}

void readFaces(std::ifstream& in, const std::string& path, std::size_t count, TruthMesh& mesh) {
    const auto bytes = readBytes(in, path, count, kFaceBytes);
    mesh.triangles.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const char* at = bytes.data() + i * kFaceBytes;
        if (*at != 3) throw InputError(path + ": face " + std::to_string(i) + " is no triangle");
        std::memcpy(mesh.triangles[i].data(), at + 1, 12);
        for (uint32_t corner : mesh.triangles[i]) {
            if (corner >= mesh.size()) {
                throw InputError(path + ": face " + std::to_string(i) + " has corner " +
                                 std::to_string(corner) + ", expected below " +
                                 std::to_string(mesh.size()));
            }
        }
    }
}

}  // namespace

TruthMesh readTruthMesh(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw InputError(path + ": cannot be opened, expected the PLY of a true shape");
    expectLine(in, path, "ply");
    expectLine(in, path, "format binary_little_endian 1.0");
    const std::size_t vertices = elementCount(in, path, "vertex");
    for (const char* p : kVertexProperties) expectLine(in, path, std::string("property ") + p);
    const std::size_t faces = elementCount(in, path, "face");
    expectLine(in, path, "property list uchar int vertex_indices");
    expectLine(in, path, "end_header");
    TruthMesh mesh;
    readVertices(in, path, vertices, mesh);
    readFaces(in, path, faces, mesh);
    mesh.area_m2.assign(mesh.size(), 0);
    for (const auto& t : mesh.triangles) {
        const geometry::Vec3 a = mesh.point(t[0]);
        const double area = 0.5 * (mesh.point(t[1]) - a).cross(mesh.point(t[2]) - a).norm();
        for (uint32_t corner : t) mesh.area_m2[corner] += static_cast<float>(area / 3);
    }
    return mesh;
}

}  // namespace djpete::evaluation
