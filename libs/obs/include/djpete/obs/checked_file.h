/// Files that are written whole or not at all and know when they are damaged.
///
/// Layout: magic (8 bytes), version (4), length of the content (8), content, CRC-64 of all before
/// it (8). Numbers are little-endian.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace djpete::obs {

/// What a file is, for its head and for sentences about it.
struct CheckedFileKind {
    std::array<char, 8> magic;
    uint32_t version = 1;  ///< that this program writes; it reads 1 to this one
    std::string name;      ///< "map file"
    std::string ending;    ///< ".djmap"

    std::string article() const { return name.front() == 'o' ? "an " : "a "; }
};

struct CheckedContent {
    uint32_t version = 0;
    std::vector<uint8_t> bytes;
};

/// Writes beside the file and renames, so that an earlier file stays whole until the new one is.
/// Throws InputError naming the file.
void writeChecked(const CheckedFileKind& kind, const std::vector<uint8_t>& content,
                  const std::filesystem::path& file);

/// Throws InputError naming the file if it is missing, of another kind, damaged or too new.
CheckedContent readChecked(const CheckedFileKind& kind, const std::filesystem::path& file);

/// CRC-64 (ECMA-182, reflected, as in xz).
uint64_t crc64(const uint8_t* bytes, std::size_t size);

}  // namespace djpete::obs
