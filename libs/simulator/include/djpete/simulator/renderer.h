/// Cameras and LiDAR that look at a World.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "djpete/simulator/camera_model.h"
#include "djpete/simulator/world.h"

namespace djpete::simulator {

/// One camera's picture with its truth. Row-major, width * height.
struct RenderedImage {
    int width_px = 0, height_px = 0;
    std::vector<std::array<uint8_t, 3>> rgb;
    std::vector<uint32_t> actorId;  ///< Actor::id at the pixel centre, 0: none
    std::vector<float> depth_m;     ///< z in cam at the pixel centre, 0: sky
    double exposure = 1;            ///< truth: shutter times gain, 1 = nominal

    /// Of pixel (u, v) in the vectors.
    std::size_t index(int u, int v) const {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) +
               static_cast<std::size_t>(u);
    }
};

/// Pixels; the borders belong to it.
struct ImageBox {
    double left = 0, top = 0, right = 0, bottom = 0;
};

/// A return in frame velo.
struct LidarPoint {
    float x = 0, y = 0, z = 0, reflectance = 0;
    uint32_t actorId = 0;  ///< truth: Actor::id, 0: none
    uint8_t beam = 0;      ///< 0 (highest) .. 63
};

/// An HDL-64E at 10 Hz as KITTI drove it; the figures are measured on KITTI's scans.
struct LidarOptions {
    double azimuthStep_deg = 0.1675;     ///< 2149 columns a turn
    double rangeNoise_m = 0.008;         ///< sigma near by, per point
    double rangeNoisePerMetre = 0.0006;  ///< grows with the distance
    double beamBias_m = 0.01;            ///< sigma of the beams' own constant offsets
    double maxRange_m = 80;
    /// False: all columns at the frame's instant, as KITTI's motion-compensated scans. True: each
    /// column from where the vehicle is at its time within the 0.1 s of the turn that begins at
    /// the back and looks ahead at the frame's instant; points in frame velo of their own time.
    /// Other traffic stands still meanwhile.
    bool raw = false;
};

/// Ray-traces frames. The same world, frame and options give the same bytes for any number of
/// threads.
class Renderer {
  public:
    /// Throws std::runtime_error if ray tracing is not possible on this machine.
    Renderer(const World& world, unsigned threads, const CameraModel& cameraModel = {});
    ~Renderer();
    /// How many threads it uses.
    unsigned threads() const;
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// `T_vehicle_cam`: optical frame; `noise_seed` tells the noise of a frame's cameras apart; 0:
    /// the left one, else the right one (CameraModel::rightGain).
    RenderedImage renderCamera(uint64_t frame, const geometry::StereoCamera& camera,
                               const geometry::SE3& T_vehicle_cam, uint32_t noise_seed);
    /// 64 beams from +2 to -24.33 degrees (HDL-64E): beam after beam from the highest, each
    /// counter-clockwise with the first point ahead. Directions without an echo have no point.
    std::vector<LidarPoint> scan(uint64_t frame, const LidarOptions& options);
    /// Thread-safe for the frame that was rendered last. Share (0..1) of the camera-facing surface
    /// points of a car that nothing hides from the camera.
    double visibleFraction(uint64_t frame, const Actor& actor, const geometry::SE3& T_vehicle_cam);
    /// Image box around the car's mesh as if nothing hid it, not clipped to the image; of the part
    /// at least 0.1 m before the camera. nullopt if there is no such part.
    std::optional<ImageBox> imageBox(uint64_t frame, const Actor& actor,
                                     const geometry::StereoCamera& camera,
                                     const geometry::SE3& T_vehicle_cam);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace djpete::simulator
