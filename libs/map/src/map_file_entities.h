/// Single entities of the map to bytes and back. Landmarks' observations are not written: the
/// keyframes' links say the same.
#pragma once

#include "djpete/map/entities.h"
#include "map_file_bytes.h"

namespace djpete::map {

void write(ByteWriter& out, const Keyframe& keyframe);
void write(ByteWriter& out, const FramePose& pose);
void write(ByteWriter& out, const Landmark& landmark);
void write(ByteWriter& out, const ObjectTrack& track);

/// `version` is the file's layout: a field that came with layout N is read if version >= N.
Keyframe readKeyframe(ByteReader& in, uint32_t version);
FramePose readFramePose(ByteReader& in, uint32_t version);
Landmark readLandmark(ByteReader& in, uint32_t version);
ObjectTrack readObject(ByteReader& in, uint32_t version);

/// Shortest keyframe, frame, landmark and object in bytes: bounds how many a file can hold.
constexpr std::size_t kLeastKeyframe = 300, kLeastFrame = 100, kLeastLandmark = 35,
                      kLeastObject = 50;

}  // namespace djpete::map
