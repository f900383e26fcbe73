/// How well a textured model agrees with the true surface.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "djpete/evaluation/image_files.h"
#include "djpete/evaluation/truth_mesh.h"
#include "djpete/texture/object_model.h"

namespace djpete::evaluation {

/// True if views coloured the point: it has samples, and its colour was not inferred.
bool isColoured(const texture::ObjectModel& model, std::size_t point);

/// A frame that looked at the object, with what is true there.
struct TruthView {
    std::size_t frame = 0;
    geometry::SE3 T_cam_est;   ///< pose of the model's frame obj by the estimate
    geometry::SE3 T_cam_true;  ///< pose of the mesh's frame obj
    MaskImage mask;            ///< of the object in the left image
    MeshView view;             ///< of the mesh at T_cam_true
};

/// Vertices that at least one view saw: not hidden by the mesh, facing the camera by cos >= 0.2,
/// within `maxRange_m`, and the pixel's mask is the object's (so nothing else hides them).
std::vector<bool> seenVertices(const TruthMesh& mesh, const std::vector<TruthView>& views,
                               const geometry::StereoCamera& camera, double maxRange_m);

/// Areas (m2) of the true surface: each vertex stands for a third of its triangles.
struct Coverage {
    double seen_m2 = 0;
    double covered10_m2 = 0, covered5_m2 = 0;  ///< seen, with a coloured point within 0.10, 0.05 m
    std::optional<double> share10() const { return share(covered10_m2); }
    std::optional<double> share5() const { return share(covered5_m2); }

  private:
    std::optional<double> share(double part) const {
        if (!(seen_m2 > 0)) return std::nullopt;
        return part / seen_m2;
    }
};
Coverage coverageOf(const texture::ObjectModel& model, const geometry::SE3& T_true_est,
                    const TruthMesh& mesh, const std::vector<bool>& seen);

/// Light, 0..1, of a coloured point and of the true surface there.
struct ColourPair {
    std::array<double, 3> estimate{0, 0, 0};  ///< as the camera's curve has it, no gain yet
    std::array<double, 3> albedo{0, 0, 0};
    std::array<float, 3> normal_obj{0, 0, 1};  ///< of the true surface
    bool sunny = false;                        ///< faces the sun, whatever shadows fall there
};

/// The simulator's cameras: code = 255 light^(1/1.15).
constexpr double kCameraGamma = 1.15;
/// Light of a camera's value of 0..255.
std::array<double, 3> lightOfCamera(const std::array<double, 3>& rgb);
/// Light of an albedo coded as sRGB.
std::array<double, 3> lightOfAlbedo(const std::array<uint8_t, 3>& srgb);

/// Each coloured point with the nearest true vertex within 0.15 m whose normal is within 60
/// degrees; points without one are left out.
std::vector<ColourPair> colourPairs(const texture::ObjectModel& model,
                                    const geometry::SE3& T_true_est, const TruthMesh& mesh);
/// The same with the model's own estimate of the albedo, already linear; empty if it has none.
std::vector<ColourPair> albedoPairs(const texture::ObjectModel& model,
                                    const geometry::SE3& T_true_est, const TruthMesh& mesh);
/// Pixels of the object's mask with the albedo that the mesh has there: what light (and the lens)
/// alone does to colours. Every `step`-th pixel of both directions.
std::vector<ColourPair> pixelPairs(const RgbImage& image, const TruthView& view,
                                   const TruthMesh& mesh, int step);

/// Sets `sunny` of all pairs by the direction towards the sun, frame obj.
void markSunny(std::vector<ColourPair>& pairs, const geometry::Vec3& sun_obj);

/// CIEDE2000 of each pair with estimate * gain.
std::vector<double> colourErrors(const std::vector<ColourPair>& pairs, double gain);
/// The gain for which the mean of colourErrors is least, within 1/16 to 16; 1 without pairs.
double fitGain(const std::vector<ColourPair>& pairs);

/// Samples that came from somewhere else.
struct Bleeding {
    std::size_t samples = 0, wrongSamples = 0;
    std::size_t points = 0, wrongPoints = 0;  ///< wrong: more than half of its samples are
};
/// Each coloured point at the estimated pose in each view that it was seen in: wrong if the pixel
/// is not the object's, or the point lies more than 0.25 m behind the true surface. `views` holds
/// those of the model's views that are known, found by frame.
Bleeding bleedingOf(const texture::ObjectModel& model, const std::vector<TruthView>& views,
                    const geometry::StereoCamera& camera);

/// Mean over coloured points with two samples or more of their standard deviation, 0..255.
std::optional<double> colourSpread(const texture::ObjectModel& model);

}  // namespace djpete::evaluation
