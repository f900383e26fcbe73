/// Images of a simulated drive as plain arrays.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace djpete::evaluation {

/// Row-major; pixel (u, v) is at v * width + u.
template <class Pixel>
struct PlainImage {
    int width_px = 0, height_px = 0;
    std::vector<Pixel> pixels;

    bool contains(int u, int v) const { return u >= 0 && v >= 0 && u < width_px && v < height_px; }
    std::size_t index(int u, int v) const {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) +
               static_cast<std::size_t>(u);
    }
    const Pixel& at(int u, int v) const { return pixels[index(u, v)]; }
};

using RgbImage = PlainImage<std::array<uint8_t, 3>>;  ///< red, green, blue
using MaskImage = PlainImage<uint8_t>;                ///< 0: outside
/// KITTI MOTS: 1000 * class + id; class 1 vehicles, 2 pedestrians; 10000: ignored.
using InstanceImage = PlainImage<uint16_t>;

/// Throw obs::InputError naming the file if it is missing or of another kind.
RgbImage readRgb(const std::string& path);
InstanceImage readInstances(const std::string& path);
/// Throws obs::InputError naming the file if it cannot be written.
void writeRgb(const RgbImage& image, const std::string& path);

/// The pixels of one instance: class 1 or 2 and this id.
MaskImage maskOf(const InstanceImage& instances, int64_t id);
std::size_t area(const MaskImage& mask);

}  // namespace djpete::evaluation
