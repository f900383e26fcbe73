#include "djpete/obs/checked_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "djpete/obs/errors.h"

namespace djpete::obs {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kHead = 20, kTail = 8;

template <class T>
void put(T value, std::vector<uint8_t>& out) {
    for (std::size_t i = 0; i < sizeof(T); ++i) out.push_back(static_cast<uint8_t>(value >> 8 * i));
}

template <class T>
T get(const uint8_t* from) {
    T value = 0;
    for (std::size_t i = sizeof(T); i-- > 0;) value = static_cast<T>(value << 8U | from[i]);
    return value;
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

void writeAtomically(const CheckedFileKind& kind, const fs::path& file,
                     const std::vector<uint8_t>& bytes) {
    if (fs::is_directory(file)) {
        throw InputError(file.string() + " is a folder, expected the name of " + kind.article() +
                         kind.name);
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
        throw InputError("cannot write the " + kind.name + " " + file.string() + ": " + failed);
    }
}

std::vector<uint8_t> readWhole(const CheckedFileKind& kind, const fs::path& file) {
    if (!fs::exists(file)) throw InputError("no " + kind.name + " " + file.string());
    if (!fs::is_regular_file(file)) {
        throw InputError(file.string() + " is not a file, expected " + kind.article() + kind.name +
                         " (" + kind.ending + ")");
    }
    std::ifstream in(file, std::ios::binary);
    std::error_code error;
    const auto size = fs::file_size(file, error);
    if (!in || error) throw InputError("cannot read the " + kind.name + " " + file.string());
    std::vector<uint8_t> bytes(static_cast<std::size_t>(size));
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!in) throw InputError("cannot read all of the " + kind.name + " " + file.string());
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

void writeChecked(const CheckedFileKind& kind, const std::vector<uint8_t>& content,
                  const fs::path& file) {
    std::vector<uint8_t> all(kind.magic.begin(), kind.magic.end());
    all.reserve(kHead + content.size() + kTail);
    put(kind.version, all);
    put(static_cast<uint64_t>(content.size()), all);
    all.insert(all.end(), content.begin(), content.end());
    put(crc64(all.data(), all.size()), all);
    writeAtomically(kind, file, all);
}

CheckedContent readChecked(const CheckedFileKind& kind, const fs::path& file) {
    const auto bytes = readWhole(kind, file);
    const std::string name = "the " + kind.name + " " + file.string();
    const auto damaged = [&](const std::string& what) {
        return InputError(name + " is damaged: " + what);
    };
    if (bytes.size() < kind.magic.size() ||
        std::memcmp(bytes.data(), kind.magic.data(), kind.magic.size()) != 0) {
        throw InputError(file.string() + " is not " + kind.article() + kind.name +
                         ": expected it to begin with " +
                         std::string(kind.magic.begin(), kind.magic.end()));
    }
    if (bytes.size() < kHead + kTail) throw damaged("it ends within its head");
    const auto version = get<uint32_t>(bytes.data() + 8);
    const auto length = get<uint64_t>(bytes.data() + 12);
    if (length != bytes.size() - kHead - kTail) {
        throw damaged("expected " + std::to_string(length) + " bytes of content, found " +
                      std::to_string(bytes.size() - kHead - kTail));
    }
    if (get<uint64_t>(bytes.data() + kHead + length) != crc64(bytes.data(), bytes.size() - kTail)) {
        throw damaged("its checksum is not that of its content");
    }
    if (version == 0 || version > kind.version) {
        throw InputError(name + " has layout " + std::to_string(version) + ", expected 1 to " +
                         std::to_string(kind.version) + ": a newer program wrote it");
    }
    return {version, {bytes.begin() + kHead, bytes.end() - kTail}};
}

}  // namespace djpete::obs
