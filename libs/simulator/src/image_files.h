/// Pictures as KITTI's PNG files, each whole or not there at all.
#pragma once

#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <string>

#include "djpete/simulator/renderer.h"

namespace djpete::simulator {

/// Writes under another name first, so that a file with this name is complete. Throws
/// std::runtime_error naming the file.
void writeWhole(const std::filesystem::path& file, const std::string& bytes);
/// The same for a PNG, with the fastest settings that still compress.
void writePng(const cv::Mat& image, const std::filesystem::path& file);
/// True if the file begins and ends as a PNG does.
bool isWholePng(const std::filesystem::path& file);

cv::Mat greyOf(const RenderedImage& image);
cv::Mat colourOf(const RenderedImage& image);
/// 16 bit, code per actor id; an id without code gets kIgnoreCode.
constexpr uint16_t kIgnoreCode = 10000;
cv::Mat instancesOf(const RenderedImage& image, const std::map<uint32_t, uint16_t>& codes);
/// KITTI's depth coding: 16 bit, metres times 256; 0 for the sky and beyond 255 m.
cv::Mat depthOf(const RenderedImage& image);

}  // namespace djpete::simulator
