#include "djpete/io/ply_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "text_file.h"

namespace djpete::io {

namespace {

/// One little-endian record after another; x86-64 and ARM64, for which Debian builds MRPT, are
/// little-endian.
class Records {
  public:
    template <class T>
    void put(T value) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        bytes_.insert(bytes_.end(), bytes, bytes + sizeof(T));
    }
    const std::vector<char>& bytes() const { return bytes_; }

  private:
    std::vector<char> bytes_;
};

std::string header(std::size_t vertices, const std::string& comment,
                   const std::vector<std::string>& properties) {
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment " + comment +
                      "\nelement vertex " + std::to_string(vertices) + "\n";
    for (const auto& p : properties) out += "property " + p + "\n";
    return out + "end_header\n";
}

void writeFile(const std::string& head, const Records& records, const std::string& file) {
    TextFile out(file, true);
    out.text(head);
    out.stream().write(records.bytes().data(),
                       static_cast<std::streamsize>(records.bytes().size()));
    out.close();
}

uint8_t toByte(float share) {
    return static_cast<uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
}

}  // namespace

void writeObjectPly(const texture::ObjectModel& model, const std::string& file) {
    Records records;
    for (std::size_t i = 0; i < model.size(); ++i) {
        float x = 0, y = 0, z = 0, r = 0, g = 0, b = 0;
        model.cloud->getPointRGB(i, x, y, z, r, g, b);
        for (float v : {x, y, z}) records.put(v);
        for (float v : model.normals[i]) records.put(v);
        for (float v : {r, g, b}) records.put(toByte(v));
        records.put(model.colours[i].count);
        records.put(model.colours[i].standardDeviation());
    }
    writeFile(header(model.size(),
                     "object " + std::to_string(model.id.value) + " " +
                         obs::toString(model.objectClass) + ", frame obj, metres",
                     {"float x", "float y", "float z", "float nx", "float ny", "float nz",
                      "uchar red", "uchar green", "uchar blue", "uint count", "float std"}),
              records, file);
}

std::map<map::ObjectId, std::string> objectPlyNames(
    const std::map<map::ObjectId, texture::ObjectModel>& models) {
    std::map<map::ObjectId, std::string> out;
    for (const auto& [id, model] : models) {
        char name[32];
        std::snprintf(name, sizeof(name), "%04llu.ply", static_cast<unsigned long long>(id.value));
        out[id] = name;
    }
    return out;
}

void writeObjectPlys(const std::map<map::ObjectId, texture::ObjectModel>& models,
                     const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throwUnwritable(folder);
    for (const auto& [id, name] : objectPlyNames(models)) {
        writeObjectPly(models.at(id), folder + "/" + name);
    }
}

void writePointsPly(const std::vector<texture::ColouredPoint>& points, const std::string& file) {
    Records records;
    for (const auto& p : points) {
        for (float v : {p.x, p.y, p.z}) records.put(v);
        for (uint8_t v : p.rgb) records.put(v);
    }
    writeFile(header(points.size(), "frame world, metres",
                     {"float x", "float y", "float z", "uchar red", "uchar green", "uchar blue"}),
              records, file);
}

}  // namespace djpete::io
