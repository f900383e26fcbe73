/// A board of one colour, 2 m wide and 1 m high, straight before a camera, and models of it.
#pragma once

#include "djpete/evaluation/texture_errors.h"
#include "djpete/texture/render_model.h"

namespace djpete::evaluation {

struct MadeBoard {
    static constexpr double kDistance_m = 6;
    static constexpr int kColumns = 101, kRows = 51;  ///< 2 cm apart

    geometry::StereoCamera camera{300, 300, 160, 80, 0, 320, 160};
    geometry::SE3 T_identity;
    /// The camera looks along -x of obj; its right is obj's +y.
    geometry::SE3 T_cam_obj{(geometry::Mat3() << 0, 1, 0, 0, 0, -1, -1, 0, 0).finished(),
                            {0, 0, kDistance_m}};
    std::array<uint8_t, 3> srgb{180, 120, 60};
    TruthMesh mesh;

    MadeBoard() {
        for (int r = 0; r < kRows; ++r) {
            for (int c = 0; c < kColumns; ++c) {
                mesh.points.push_back(
                    {0, static_cast<float>(-1 + 0.02 * c), static_cast<float>(-0.5 + 0.02 * r)});
                mesh.normals.push_back({1, 0, 0});
                mesh.srgb.push_back(srgb);
                mesh.area_m2.push_back(4e-4F);
            }
        }
        for (uint32_t r = 0; r + 1 < kRows; ++r) {
            for (uint32_t c = 0; c + 1 < kColumns; ++c) {
                const uint32_t a = r * kColumns + c, b = a + kColumns;
                mesh.triangles.push_back({a, a + 1, b});
                mesh.triangles.push_back({a + 1, b + 1, b});
            }
        }
    }

    /// Frame 7 sees all of the board where it is.
    TruthView view() const {
        TruthView out{7,
                      T_cam_obj,
                      T_cam_obj,
                      {camera.width_px, camera.height_px, {}},
                      viewOfMesh(mesh, camera, T_cam_obj)};
        out.mask.pixels.assign(320 * 160, 255);
        return out;
    }
    /// What a camera of the simulator's makes of the board in so much light.
    std::array<float, 3> cameraColour(double light) const {
        const auto albedo = lightOfAlbedo(srgb);
        std::array<float, 3> out{};
        for (std::size_t c = 0; c < 3; ++c) {
            out[c] = static_cast<float>(255 * std::pow(light * albedo[c], 1 / kCameraGamma));
        }
        return out;
    }
    static texture::ColourSum sample(const std::array<float, 3>& rgb) {
        texture::ColourSum out;
        out.add(rgb, 1);
        return out;
    }
    /// Points every 4 cm with y in [y0, y1], coloured by frame 7.
    texture::ObjectModel model(double y0, double y1) const {
        texture::ObjectModel out;
        out.cloud = mrpt::maps::CColouredPointsMap::Create();
        out.views = {obs::FrameId{7}};
        for (const auto& p : mesh.points) {
            const auto column = std::lround((static_cast<double>(p[1]) + 1) / 0.02);
            const auto row = std::lround((static_cast<double>(p[2]) + 0.5) / 0.02);
            if (column % 2 != 0 || row % 2 != 0) continue;
            if (static_cast<double>(p[1]) < y0 - 1e-6 || static_cast<double>(p[1]) > y1 + 1e-6) {
                continue;
            }
            out.addPoint(p, {1, 0, 0}, 0.03F);
            out.colours.back() = sample(cameraColour(1));
            out.seenIn.back() = 1;
            out.showColour(out.size() - 1);
        }
        return out;
    }
};

}  // namespace djpete::evaluation
