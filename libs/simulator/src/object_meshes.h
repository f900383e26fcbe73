/// The truth of the objects of a drive as files.
#pragma once

#include <filesystem>
#include <set>

#include "djpete/simulator/world.h"

namespace djpete::simulator {

/// Track ids of the labels in a file of KITTI's tracking labels. Throws std::runtime_error naming
/// file and line if a row is not one.
std::set<uint32_t> labelledIds(const std::filesystem::path& labelFile);

/// Writes folder/NNN.ply (true shape and albedo, frame obj; people in the first shape of their
/// walk) for each of these actors, several at once; keeps files that are there already.
void writeObjectMeshes(const World& world, const std::set<uint32_t>& ids, double texel_m,
                       const std::filesystem::path& folder, unsigned threads);

}  // namespace djpete::simulator
