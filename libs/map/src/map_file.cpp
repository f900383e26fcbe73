#include "djpete/map/map_file.h"

#include "djpete/obs/checked_file.h"
#include "djpete/obs/errors.h"
#include "map_file_content.h"

namespace djpete::map {

namespace fs = std::filesystem;
using obs::InputError;

namespace {

const obs::CheckedFileKind& kind() {
    static const obs::CheckedFileKind k{
        {'D', 'J', 'P', 'E', 'T', 'M', 'A', 'P'}, kMapFileVersion, "map file", ".djmap"};
    return k;
}

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

}  // namespace

void saveMap(const SlamMap& map, const fs::path& file, const MapFileInfo& info) {
    map.check();
    requireTextures(map, info, file);
    ByteWriter content;
    write(content, info);
    MapFileAccess::write(content, map);
    obs::writeChecked(kind(), content.bytes(), file);
}

LoadedMap loadMap(const fs::path& file) {
    const auto content = obs::readChecked(kind(), file);
    try {
        ByteReader in(content.bytes.data(), content.bytes.size());
        LoadedMap loaded;
        loaded.info = readInfo(in, content.version);
        loaded.map = MapFileAccess::read(in, content.version);
        if (in.left() != 0) throw DamagedBytes("there is more than a map in it");
        requireTextures(loaded.map, loaded.info, file);
        return loaded;
    } catch (const DamagedBytes& e) {
        throw InputError("the map file " + file.string() + " is damaged: " + e.what());
    }
}

}  // namespace djpete::map
