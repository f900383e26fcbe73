#include "map_file_content.h"

#include "map_file_entities.h"

namespace djpete::map {

namespace {

template <class Map>
void writeAll(ByteWriter& out, const Map& entities) {
    out.put(static_cast<uint64_t>(entities.size()));
    for (const auto& [id, entity] : entities) write(out, entity);
}

/// Entities in rising order of `id`, as they were written.
template <class Map, class Read, class IdOf>
void readAll(ByteReader& in, std::size_t least, Map& entities, Read read, IdOf idOf) {
    for (std::size_t n = in.getCount(least); n > 0; --n) {
        auto entity = read();
        const auto id = idOf(entity);
        if (!entities.empty() && !(entities.rbegin()->first < id)) {
            throw DamagedBytes("ids are not in order");
        }
        entities.emplace_hint(entities.end(), id, std::move(entity));
    }
}

/// Keyframes' links are what is written; the landmarks learn theirs from them.
void linkLandmarks(const std::map<KeyframeId, Keyframe>& keyframes,
                   std::map<LandmarkId, Landmark>& landmarks) {
    for (const auto& [id, kf] : keyframes) {
        for (std::size_t i = 0; i < kf.landmarks.size(); ++i) {
            if (!kf.landmarks[i]) continue;
            const auto it = landmarks.find(*kf.landmarks[i]);
            if (it == landmarks.end()) throw DamagedBytes("a feature names an unknown landmark");
            auto& seen = it->second.observations;
            if (!seen.empty() && seen.rbegin()->first == id) {
                throw DamagedBytes("a landmark is observed twice in one keyframe");
            }
            seen.emplace_hint(seen.end(), id, static_cast<uint32_t>(i));
        }
    }
}

template <class Map>
void requireBelow(const Map& entities, uint64_t next) {
    if (!entities.empty() && entities.rbegin()->first.value >= next) {
        throw DamagedBytes("an id is not below the next one to be given");
    }
}

}  // namespace

void MapFileAccess::write(ByteWriter& out, const SlamMap& map) {
    for (const uint64_t value :
         {map.revision_.value, map.nextKeyframe_, map.nextLandmark_, map.nextObject_}) {
        out.put(value);
    }
    writeAll(out, map.keyframes_);
    writeAll(out, map.frames_);
    writeAll(out, map.landmarks_);
    writeAll(out, map.objects_);
}

SlamMap MapFileAccess::read(ByteReader& in, uint32_t version) {
    SlamMap map;
    for (uint64_t* value :
         {&map.revision_.value, &map.nextKeyframe_, &map.nextLandmark_, &map.nextObject_}) {
        *value = in.get<uint64_t>();
    }
    const auto id = [](const auto& entity) { return entity.id; };
    readAll(
        in, kLeastKeyframe, map.keyframes_, [&] { return readKeyframe(in, version); }, id);
    readAll(
        in, kLeastFrame, map.frames_, [&] { return readFramePose(in, version); },
        [](const FramePose& pose) { return pose.frame; });
    readAll(
        in, kLeastLandmark, map.landmarks_, [&] { return readLandmark(in, version); }, id);
    readAll(
        in, kLeastObject, map.objects_, [&] { return readObject(in, version); }, id);
    requireBelow(map.keyframes_, map.nextKeyframe_);
    requireBelow(map.landmarks_, map.nextLandmark_);
    requireBelow(map.objects_, map.nextObject_);
    linkLandmarks(map.keyframes_, map.landmarks_);
    try {
        map.check();
    } catch (const std::logic_error& e) {
        throw DamagedBytes(e.what());
    }
    return map;
}

void write(ByteWriter& out, const MapFileInfo& info) {
    out.putText(info.drive);
    out.put(static_cast<uint64_t>(info.sessions.size()));
    for (const auto& session : info.sessions) out.putText(session);
    out.putText(info.toolVersion);
    out.put(static_cast<uint64_t>(info.textures.size()));
    for (const auto& [object, file] : info.textures) {
        out.put(object.value);
        out.putText(file);
    }
}

MapFileInfo readInfo(ByteReader& in, uint32_t /*version*/) {
    MapFileInfo info;
    info.drive = in.getText();
    for (std::size_t n = in.getCount(8); n > 0; --n) info.sessions.push_back(in.getText());
    info.toolVersion = in.getText();
    for (std::size_t n = in.getCount(16); n > 0; --n) {
        const ObjectId object{in.get<uint64_t>()};
        if (!info.textures.emplace(object, in.getText()).second) {
            throw DamagedBytes("an object has two textures");
        }
    }
    return info;
}

}  // namespace djpete::map
