#include "image_files.h"

#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

namespace djpete::simulator {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kPngMark = 8;  // bytes at the beginning of every PNG
constexpr std::size_t kPngEnd = 12;  // bytes of its last chunk, IEND

void writeBytes(const fs::path& file, const char* bytes, std::size_t size) {
    fs::path part = file;
    part += ".part";
    std::ofstream out(part, std::ios::binary);
    out.write(bytes, static_cast<std::streamsize>(size));
    out.close();
    std::error_code failed;
    if (out) fs::rename(part, file, failed);
    if (!out || failed) {
        std::error_code ignored;
        fs::remove(part, ignored);
        throw std::runtime_error(file.string() + ": cannot be written");
    }
}

/// The picture's own memory; not to be written to.
cv::Mat rgbOf(const RenderedImage& image) {
    return {image.height_px, image.width_px, CV_8UC3,
            const_cast<std::array<uint8_t, 3>*>(image.rgb.data())};
}

}  // namespace

void writeWhole(const fs::path& file, const std::string& bytes) {
    writeBytes(file, bytes.data(), bytes.size());
}

void writePng(const cv::Mat& image, const fs::path& file) {
    // Without settings OpenCV takes one filter and run lengths: half the time of level 1.
    std::vector<uint8_t> bytes;
    if (!cv::imencode(".png", image, bytes))
        throw std::runtime_error(file.string() + ": cannot be written");
    writeBytes(file, reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

bool isWholePng(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string head(kPngMark, '\0'), tail(kPngEnd, '\0');
    if (!in.read(head.data(), kPngMark)) return false;
    in.seekg(-static_cast<std::streamoff>(kPngEnd), std::ios::end);
    if (!in.read(tail.data(), kPngEnd)) return false;
    return head.compare(1, 3, "PNG") == 0 && tail.compare(4, 4, "IEND") == 0;
}

cv::Mat greyOf(const RenderedImage& image) {
    cv::Mat out;
    cv::cvtColor(rgbOf(image), out, cv::COLOR_RGB2GRAY);
    return out;
}

cv::Mat colourOf(const RenderedImage& image) {
    cv::Mat out;
    cv::cvtColor(rgbOf(image), out, cv::COLOR_RGB2BGR);
    return out;
}

cv::Mat instancesOf(const RenderedImage& image, const std::map<uint32_t, uint16_t>& codes) {
    cv::Mat out(image.height_px, image.width_px, CV_16UC1);
    // Neighbours mostly show the same actor.
    uint32_t lastId = 0;
    uint16_t lastCode = 0;
    for (int v = 0; v < image.height_px; ++v) {
        auto* row = out.ptr<uint16_t>(v);
        for (int u = 0; u < image.width_px; ++u) {
            const uint32_t id = image.actorId[image.index(u, v)];
            if (id != lastId) {
                const auto code = codes.find(id);
                lastCode = id == 0 ? uint16_t{0} : code == codes.end() ? kIgnoreCode : code->second;
                lastId = id;
            }
            row[u] = lastCode;
        }
    }
    return out;
}

cv::Mat depthOf(const RenderedImage& image) {
    cv::Mat out(image.height_px, image.width_px, CV_16UC1);
    for (int v = 0; v < image.height_px; ++v) {
        auto* row = out.ptr<uint16_t>(v);
        for (int u = 0; u < image.width_px; ++u) {
            const float z = image.depth_m[image.index(u, v)];
            row[u] = z < 255.F ? static_cast<uint16_t>(std::lround(256.F * z)) : uint16_t{0};
        }
    }
    return out;
}

}  // namespace djpete::simulator
