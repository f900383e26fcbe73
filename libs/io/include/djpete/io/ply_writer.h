/// Coloured point clouds in PLY (MRPT 2.5's own writer drops the colours).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "djpete/texture/background_cloud.h"
#include "djpete/texture/object_model.h"

namespace djpete::io {

/// binary_little_endian: float x y z nx ny nz (frame obj), uchar red green blue, uint count
/// (views that coloured the point; 0: neutral grey), float std (of the colour, 0..255).
void writeObjectPly(const texture::ObjectModel& model, const std::string& file);

/// NNNN.ply, NNNN the object's id.
std::map<map::ObjectId, std::string> objectPlyNames(
    const std::map<map::ObjectId, texture::ObjectModel>& models);

/// Every model as `folder`/NNNN.ply; makes the folder.
void writeObjectPlys(const std::map<map::ObjectId, texture::ObjectModel>& models,
                     const std::string& folder);

/// binary_little_endian: float x y z, uchar red green blue.
void writePointsPly(const std::vector<texture::ColouredPoint>& points, const std::string& file);

}  // namespace djpete::io
