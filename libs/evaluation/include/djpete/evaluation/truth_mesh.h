/// The true shape and colour of an object, as the simulator writes it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "djpete/geometry/camera.h"
#include "djpete/geometry/se3.h"

namespace djpete::evaluation {

/// Frame obj: box centre; x front, y left, z up; metres.
struct TruthMesh {
    std::vector<std::array<float, 3>> points, normals;
    std::vector<std::array<uint8_t, 3>> srgb;  ///< albedo, without light
    std::vector<float> area_m2;                ///< a third of the triangles around each vertex
    std::vector<std::array<uint32_t, 3>> triangles;

    std::size_t size() const { return points.size(); }
    geometry::Vec3 point(std::size_t i) const { return vec(points[i]); }
    geometry::Vec3 normal(std::size_t i) const { return vec(normals[i]); }

  private:
    static geometry::Vec3 vec(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }
};

/// Reads objects/NNN.ply of simulate-drive: binary little-endian, float x y z nx ny nz, uchar red
/// green blue, faces of three corners as `list uchar int`. Throws obs::InputError naming the file
/// for anything else.
TruthMesh readTruthMesh(const std::string& path);

/// What a camera sees of a mesh with nothing before it: a part of the image.
struct MeshView {
    static constexpr uint32_t kNothing = 0xFFFFFFFF;

    int x0 = 0, y0 = 0, width = 0, height = 0;  ///< of the part; row-major
    std::vector<float> depth_m;                 ///< z in cam; infinity where there is nothing
    std::vector<uint32_t> vertex;               ///< a corner of the triangle seen, or kNothing

    /// Index of pixel (u, v) of the image, or nothing outside the part.
    std::optional<std::size_t> at(int u, int v) const {
        if (u < x0 || v < y0 || u >= x0 + width || v >= y0 + height) return std::nullopt;
        return static_cast<std::size_t>(v - y0) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(u - x0);
    }
};

/// Z-buffer of all triangles that lie wholly before the camera, whichever way they face.
MeshView viewOfMesh(const TruthMesh& mesh, const geometry::StereoCamera& camera,
                    const geometry::SE3& T_cam_obj);

/// Vertices that the view sees: inside the image, not hidden by the mesh itself, facing the camera
/// by at least `minFacing_cos`, and not farther than `maxRange_m`. Parallel to the vertices.
std::vector<bool> verticesSeen(const TruthMesh& mesh, const MeshView& view,
                               const geometry::StereoCamera& camera, const geometry::SE3& T_cam_obj,
                               double minFacing_cos, double maxRange_m);

}  // namespace djpete::evaluation
