/// The true shape and colour of an actor.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "djpete/simulator/world.h"

namespace djpete::simulator {

/// A mesh with a colour per vertex.
struct ColouredMesh {
    struct Vertex {
        std::array<float, 3> p_obj{};   ///< frame obj: box centre; x front, y left, z up
        std::array<float, 3> n_obj{};   ///< unit, outwards
        std::array<float, 3> albedo{};  ///< red, green, blue, linear, 0..1
        std::array<uint8_t, 3> srgb{};  ///< the albedo coded as sRGB
    };
    std::vector<Vertex> vertices;
    std::vector<std::array<uint32_t, 3>> triangles;  ///< counter-clockwise from outside
};

/// The surface of an actor's body as the renderer draws it, its triangles split until no edge is
/// longer than `texel_m`, with the albedo of what it is made of at each vertex, seen with a
/// footprint of a texel. No light is in the colours. `phase`: of people, see World::phase. Throws
/// std::runtime_error if texel_m is not at least a millimetre.
ColouredMesh objectTruth(const Actor& actor, double texel_m = 0.02, uint32_t phase = 0);

/// Writes binary little-endian PLY: float x, y, z, nx, ny, nz, uchar red, green, blue (sRGB) and
/// the faces. Throws std::runtime_error naming the file that cannot be written.
void writePly(const ColouredMesh& mesh, const std::filesystem::path& path);

}  // namespace djpete::simulator
