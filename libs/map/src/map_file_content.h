/// The content of a map file: entities to bytes and back.
#pragma once

#include "djpete/map/map_file.h"
#include "map_file_bytes.h"

namespace djpete::map {

/// The one door to SlamMap's members for reading and restoring a whole map.
struct MapFileAccess {
    static void write(ByteWriter& out, const SlamMap& map);
    /// Content of a file of layout `version`; the result passes check().
    static SlamMap read(ByteReader& in, uint32_t version);
};

void write(ByteWriter& out, const MapFileInfo& info);
MapFileInfo readInfo(ByteReader& in, uint32_t version);

}  // namespace djpete::map
