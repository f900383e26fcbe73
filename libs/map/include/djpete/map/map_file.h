/// Maps on disk: one `.djmap` file holds all that a SlamMap knows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "djpete/map/slam_map.h"

namespace djpete::map {

/// What a map file says beside the map.
struct MapFileInfo {
    std::string drive;                  ///< name of the drive that began the map
    std::vector<std::string> sessions;  ///< names of all drives in the map, in order
    std::string toolVersion;            ///< of the program that wrote the file
    /// Files of the objects' textures, relative to the folder of the map file, without "..".
    std::map<ObjectId, std::string> textures;
};

struct LoadedMap {
    SlamMap map;
    MapFileInfo info;
};

/// Newest layout that this program reads, and the one that it writes.
constexpr uint32_t kMapFileVersion = 1;

/// Writes `map` to `file`: first all of it to `<file>.part`, then that takes the name, so that an
/// old file stays whole whatever happens. Equal maps give equal bytes. Throws obs::InputError if
/// the file cannot be written or a texture's path is not relative or its object not in the map.
void saveMap(const SlamMap& map, const std::filesystem::path& file, const MapFileInfo& info);

/// Reads a file of saveMap; poses, ids, counters and revision are those of the saved map, bit by
/// bit. Throws obs::InputError if the file is not there, not a map, damaged, or of a newer program.
LoadedMap loadMap(const std::filesystem::path& file);

}  // namespace djpete::map
