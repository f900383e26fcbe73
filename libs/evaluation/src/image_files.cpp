#include "djpete/evaluation/image_files.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "djpete/obs/errors.h"

namespace djpete::evaluation {

namespace {

cv::Mat readImage(const std::string& path, int mode, int type, const std::string& expected) {
    cv::Mat image;
    try {
        image = cv::imread(path, mode);
    } catch (const cv::Exception&) {
        image.release();
    }
    if (image.empty() || image.type() != type) {
        throw obs::InputError(path + ": cannot be read, expected " + expected);
    }
    return image;
}

}  // namespace

RgbImage readRgb(const std::string& path) {
    const cv::Mat image = readImage(path, cv::IMREAD_COLOR, CV_8UC3, "an image");
    RgbImage out{image.cols, image.rows, {}};
    out.pixels.reserve(image.total());
    for (int v = 0; v < image.rows; ++v) {
        const auto* row = image.ptr<cv::Vec3b>(v);
        for (int u = 0; u < image.cols; ++u) {
            out.pixels.push_back({row[u][2], row[u][1], row[u][0]});
        }
    }
    return out;
}

InstanceImage readInstances(const std::string& path) {
    const cv::Mat image = readImage(path, cv::IMREAD_UNCHANGED, CV_16UC1, "a grey 16-bit PNG");
    InstanceImage out{image.cols, image.rows, {}};
    out.pixels.reserve(image.total());
    for (int v = 0; v < image.rows; ++v) {
        const auto* row = image.ptr<uint16_t>(v);
        out.pixels.insert(out.pixels.end(), row, row + image.cols);
    }
    return out;
}

void writeRgb(const RgbImage& image, const std::string& path) {
    cv::Mat out(image.height_px, image.width_px, CV_8UC3);
    for (int v = 0; v < out.rows; ++v) {
        for (int u = 0; u < out.cols; ++u) {
            const auto& p = image.at(u, v);
            out.at<cv::Vec3b>(v, u) = {p[2], p[1], p[0]};
        }
    }
    bool written = false;
    try {
        written = cv::imwrite(path, out);
    } catch (const cv::Exception&) {
        written = false;
    }
    if (!written) throw obs::InputError(path + ": cannot be written");
}

MaskImage maskOf(const InstanceImage& instances, int64_t id) {
    MaskImage out{instances.width_px, instances.height_px, {}};
    out.pixels.resize(instances.pixels.size());
    std::transform(instances.pixels.begin(), instances.pixels.end(), out.pixels.begin(),
                   [id](uint16_t value) {
                       const bool on = value >= 1000 && value < 3000 && value % 1000 == id;
                       return static_cast<uint8_t>(on ? 255 : 0);
                   });
    return out;
}

std::size_t area(const MaskImage& mask) {
    return static_cast<std::size_t>(
        std::count_if(mask.pixels.begin(), mask.pixels.end(), [](uint8_t v) { return v != 0; }));
}

}  // namespace djpete::evaluation
