/// From the light on a camera's pixels to its picture.
#pragma once

#include "djpete/simulator/camera_model.h"
#include "painter.h"

namespace djpete::simulator {

/// How long the shutter was open (1 = nominal) and what was amplified after it.
struct Exposure {
    double shutter = 1, gain = 1;
    double total() const { return shutter * gain; }
};

/// Shutter times gain with which a camera answers to a mean brightness (of brightnessOf).
double exposureFor(const CameraModel& model, double brightness);
/// As much as can be by the shutter, the rest by gain.
Exposure withTotal(const CameraModel& model, double total);
/// Mean of a picture's light as the exposure control sees it: what is too bright counts as white.
double brightnessOf(const std::vector<Vec3f>& colours);

/// Vignetting, exposure, noise, tone curve and quantisation of one picture.
class Development {
  public:
    /// `noise`: seed of this picture.
    Development(const CameraModel& model, const Exposure& exposure,
                const geometry::StereoCamera& camera, uint32_t noise);
    /// `colours` row-major, one per pixel.
    void developRow(int v, const std::vector<Vec3f>& colours, RenderedImage& out) const;

  private:
    /// Value (0..255) and its noise for a light.
    struct Tone {
        float value = 0, sigma = 0;
    };
    Tone toneOf(float light) const;

    const geometry::StereoCamera& camera_;
    uint32_t noise_;
    float exposure_, chroma_, vignetting_;
    std::vector<Tone> tones_;
};

/// Blurs light along both axes with a Gaussian of a standard deviation in pixels.
void blurLight(float sigma_px, int width, int height, unsigned threads,
               std::vector<Vec3f>& colours);
/// Blurs light along the way that the standing world takes in the image while the camera moves by
/// `T_cam_end_cam_begin`, centred on the picture's instant. Depth as in RenderedImage.
void blurByMotion(const geometry::StereoCamera& camera, const geometry::SE3& T_end_begin,
                  const std::vector<float>& depth_m, unsigned threads, std::vector<Vec3f>& colours);

}  // namespace djpete::simulator
