/// What is true of a frame, as rows and codes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "djpete/simulator/labels.h"

namespace djpete::simulator {

/// KITTI's MOTS code per actor of the world: 1000 * class + id with class 1 for cars, vans and
/// trucks and 2 for pedestrians, if it has a label in this frame. All others are missing
/// (cyclists, actors without a label): "ignore".
std::map<uint32_t, uint16_t> maskCodes(const std::vector<Label>& labels);

/// Rows for objects.txt of every actor that the image shows or that is within `range_m` of the
/// vehicle: frame, id, type, 1 if it moves, T_world_obj (12 numbers, row by row), velocity in world
/// (m/s), turn rate about world's z (rad/s). `world`: World::T_world_start. Motion is the
/// difference between the frames before and after.
std::string objectRows(const World& world, uint64_t frame, const RenderedImage& image,
                       double range_m);

/// `frame share`: of the left image that moving cars, vans and trucks cover.
std::string movingRow(const World& world, uint64_t frame, const RenderedImage& image);

/// `frame left right`: relative exposure of both cameras.
std::string exposureRow(uint64_t frame, const RenderedImage& left, const RenderedImage& right);

}  // namespace djpete::simulator
