/// How brightly each image was taken, from points that several images show.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "djpete/obs/sensor_frame.h"

namespace djpete::texture {

/// An image shows a colour c (0..255) of the objects' common scale as gain * c + offset.
struct Exposure {
    double gain = 1, offset = 0;

    std::array<float, 3> corrected(const std::array<float, 3>& rgb) const;
};

/// From the colours of an image to the common scale, for many of them.
class ToCommonScale {
  public:
    explicit ToCommonScale(const Exposure& e)
        : factor_(static_cast<float>(1 / e.gain)), offset_(static_cast<float>(e.offset)) {}
    std::array<float, 3> of(const std::array<float, 3>& rgb) const {
        return {(rgb[0] - offset_) * factor_, (rgb[1] - offset_) * factor_,
                (rgb[2] - offset_) * factor_};
    }

  private:
    float factor_, offset_;
};

inline std::array<float, 3> Exposure::corrected(const std::array<float, 3>& rgb) const {
    return ToCommonScale(*this).of(rgb);
}

/// Two images saw the same points: the median of log(brightness in `a` / brightness in `b`).
struct ExposurePair {
    obs::FrameId a, b;
    double logRatio = 0;
    double weight = 0;  ///< 1 / variance of logRatio
};

/// The gains of all `frames` that explain the pairs best (linear least squares on their
/// logarithms); their geometric mean is 1. Frames next to each other are held together weakly, so
/// that images without common points get what lies between. Pairs of unknown frames are left out.
std::map<obs::FrameId, double> solveGains(const std::vector<obs::FrameId>& frames,
                                          const std::vector<ExposurePair>& pairs);

/// Colours of points on the common scale, and what one image shows there; channels one by one.
struct ExposureSamples {
    std::vector<float> common, shown, weight;
};

/// Robust weighted fit of gain and offset that stays near `guess` where samples say little.
/// `gainSigma`: of the guess, relative.
Exposure fitExposure(const ExposureSamples& samples, const Exposure& guess, double gainSigma);

}  // namespace djpete::texture
