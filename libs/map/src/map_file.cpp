/// Layout of every version: magic (8 bytes), version (4), length of the content (8), content,
/// CRC-64 of all before it (8). Numbers are little-endian.
#include "djpete/map/map_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "djpete/obs/errors.h"
#include "map_file_content.h"

namespace djpete::map {

namespace fs = std::filesystem;
using obs::InputError;

namespace {

constexpr std::array<char, 8> kMagic = {'D', 'J', 'P', 'E', 'T', 'M', 'A', 'P'};
constexpr std::size_t kHead = 20, kTail = 8;

void requireTextures(const SlamMap& map, const MapFileInfo& info, const fs::path& file) {
    for (const auto& [object, name] : info.textures) {
        const auto begin =
            file.string() + ": the texture of object " + std::to_string(object.value);
        if (map.objects().count(object) == 0) {
            throw InputError(begin + " belongs to no object of the map");
        }
        const fs::path path(name);
        bool inside = !name.empty() && path.is_relative();
        for (const auto& part : path) inside = inside && part != "..";
        if (!inside) {
            throw InputError(begin + " is expected beside or below the map file, not at '" + name +
                             "'");
        }
    }
}

/// Writes all of `bytes` and sees them on the disk; returns what went wrong, or nothing.
std::string writeWhole(const fs::path& file, const std::vector<uint8_t>& bytes) {
    const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0) return std::strerror(errno);
    std::string failed;
    for (std::size_t done = 0; done < bytes.size() && failed.empty();) {
        const ssize_t n = ::write(fd, bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno != EINTR) failed = std::strerror(errno);
        if (n > 0) done += static_cast<std::size_t>(n);
    }
    if (failed.empty() && ::fsync(fd) != 0) failed = std::strerror(errno);
    if (::close(fd) != 0 && failed.empty()) failed = std::strerror(errno);
    return failed;
}

void writeAtomically(const fs::path& file, const std::vector<uint8_t>& bytes) {
    if (fs::is_directory(file)) {
        throw InputError(file.string() + " is a folder, expected the name of a map file");
    }
    const fs::path part = file.string() + ".part";
    std::string failed = writeWhole(part, bytes);
    std::error_code error;
    if (failed.empty()) {
        fs::rename(part, file, error);
        if (error) failed = error.message();
    }
    if (!failed.empty()) {
        fs::remove(part, error);
        throw InputError("cannot write the map file " + file.string() + ": " + failed);
    }
}

std::vector<uint8_t> readWhole(const fs::path& file) {
    if (!fs::exists(file)) throw InputError("no map file " + file.string());
    if (!fs::is_regular_file(file)) {
        throw InputError(file.string() + " is not a file, expected a map file (.djmap)");
    }
    std::ifstream in(file, std::ios::binary);
    std::error_code error;
    const auto size = fs::file_size(file, error);
    if (!in || error) throw InputError("cannot read the map file " + file.string());
    std::vector<uint8_t> bytes(static_cast<std::size_t>(size));
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!in) throw InputError("cannot read all of the map file " + file.string());
    return bytes;
}

}  // namespace

uint64_t crc64(const uint8_t* bytes, std::size_t size) {
    static const auto table = [] {
        std::array<uint64_t, 256> t{};
        for (uint64_t i = 0; i < t.size(); ++i) {
            uint64_t c = i;
            for (int bit = 0; bit < 8; ++bit) {
                c = (c & 1) != 0 ? (c >> 1) ^ 0xC96C5795D7870F42ULL : c >> 1;
            }
            t[static_cast<std::size_t>(i)] = c;
        }
        return t;
    }();
    uint64_t crc = ~uint64_t{0};
    for (std::size_t i = 0; i < size; ++i) crc = table[(crc ^ bytes[i]) & 0xFF] ^ (crc >> 8);
    return ~crc;
}

void saveMap(const SlamMap& map, const fs::path& file, const MapFileInfo& info) {
    map.check();
    requireTextures(map, info, file);
    ByteWriter content;
    write(content, info);
    MapFileAccess::write(content, map);
    ByteWriter all;
    for (const char c : kMagic) all.put(c);
    all.put(kMapFileVersion);
    all.put(static_cast<uint64_t>(content.bytes().size()));
    all.append(content.bytes());
    all.put(crc64(all.bytes().data(), all.bytes().size()));
    writeAtomically(file, all.bytes());
}

LoadedMap loadMap(const fs::path& file) {
    const auto bytes = readWhole(file);
    const auto damaged = [&](const std::string& what) {
        return InputError("the map file " + file.string() + " is damaged: " + what);
    };
    if (bytes.size() < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), 8) != 0) {
        throw InputError(file.string() + " is not a map file: expected it to begin with DJPETMAP");
    }
    if (bytes.size() < kHead + kTail) throw damaged("it ends within its head");
    ByteReader head(bytes.data() + kMagic.size(), kHead - kMagic.size());
    const auto version = head.get<uint32_t>();
    const auto length = head.get<uint64_t>();
    if (length != bytes.size() - kHead - kTail) {
        throw damaged("expected " + std::to_string(length) + " bytes of content, found " +
                      std::to_string(bytes.size() - kHead - kTail));
    }
    ByteReader tail(bytes.data() + kHead + length, kTail);
    if (tail.get<uint64_t>() != crc64(bytes.data(), bytes.size() - kTail)) {
        throw damaged("its checksum is not that of its content");
    }
    if (version == 0 || version > kMapFileVersion) {
        throw InputError("the map file " + file.string() + " has layout " +
                         std::to_string(version) + ", expected 1 to " +
                         std::to_string(kMapFileVersion) + ": a newer program wrote it");
    }
    try {
        ByteReader in(bytes.data() + kHead, static_cast<std::size_t>(length));
        LoadedMap loaded;
        loaded.info = readInfo(in, version);
        loaded.map = MapFileAccess::read(in, version);
        if (in.left() != 0) throw DamagedBytes("there is more than a map in it");
        requireTextures(loaded.map, loaded.info, file);
        return loaded;
    } catch (const DamagedBytes& e) {
        throw damaged(e.what());
    }
}

}  // namespace djpete::map
