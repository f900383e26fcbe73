#include "image_files.h"

#include <array>
#include <cstring>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "djpete/obs/errors.h"

namespace djpete::kitti2rawlog {

using obs::InputError;

namespace {

uint32_t bigEndian(const unsigned char* b) {
    return static_cast<uint32_t>(b[0]) << 24U | static_cast<uint32_t>(b[1]) << 16U |
           static_cast<uint32_t>(b[2]) << 8U | static_cast<uint32_t>(b[3]);
}

std::string text(ImageSize s) {
    return std::to_string(s.width_px) + "x" + std::to_string(s.height_px);
}

}  // namespace

ImageSize pngSize(const std::filesystem::path& file) {
    static constexpr unsigned char kStart[16] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n',
                                                 0,    0,   0,   13,  'I',  'H',  'D',  'R'};
    std::array<unsigned char, 24> head{};
    std::ifstream in(file, std::ios::binary);
    in.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head.size()));
    if (!in || std::memcmp(head.data(), kStart, sizeof kStart) != 0) {
        throw InputError(file.string() + ": cannot be read as an image; expected a PNG");
    }
    const uint32_t w = bigEndian(&head[16]), h = bigEndian(&head[20]);
    if (w == 0 || h == 0 || w > 65535 || h > 65535) {
        throw InputError(file.string() + ": the PNG's head gives a size of " + std::to_string(w) +
                         "x" + std::to_string(h) + "; expected that of an image");
    }
    return {static_cast<int>(w), static_cast<int>(h)};
}

void checkScanSize(const std::filesystem::path& file) {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(file, error);
    if (error) throw InputError(file.string() + ": cannot be read; expected a Velodyne scan");
    if (bytes == 0 || bytes % 16 != 0) {
        throw InputError(file.string() + ": scan is truncated: " + std::to_string(bytes) +
                         " bytes, expected a positive multiple of 16");
    }
}

void attachMasks(const std::filesystem::path& file, ImageSize expected,
                 std::vector<obs::ObjectDetection>& detections) {
    cv::Mat ids;
    try {
        ids = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception&) {
        ids.release();
    }
    if (ids.empty() || ids.type() != CV_16UC1) {
        throw InputError(file.string() +
                         ": cannot be read as instance masks; expected a grey 16-bit PNG");
    }
    if (!(ImageSize{ids.cols, ids.rows} == expected)) {
        throw InputError(file.string() + ": masks are " + text({ids.cols, ids.rows}) + " but " +
                         text(expected) + " was expected, the size of the images");
    }
    cv::Mat mask(ids.size(), CV_8UC1);
    for (auto& d : detections) {
        if (!d.sourceTrackId) continue;
        bool any = false;
        for (int v = 0; v < ids.rows; ++v) {
            const auto* in = ids.ptr<uint16_t>(v);
            auto* out = mask.ptr<uint8_t>(v);
            for (int u = 0; u < ids.cols; ++u) {
                const bool on = in[u] >= 1000 && in[u] < 10000 && in[u] % 1000 == *d.sourceTrackId;
                out[u] = on ? 255 : 0;
                any = any || on;
            }
        }
        if (!any) continue;
        d.mask = obs::RleMask::fromDense(mask.data, static_cast<uint32_t>(mask.cols),
                                         static_cast<uint32_t>(mask.rows), mask.step);
    }
}

}  // namespace djpete::kitti2rawlog
