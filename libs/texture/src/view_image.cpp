#include "view_image.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "djpete/obs/errors.h"

namespace djpete::texture {

namespace {

[[noreturn]] void badView(const TextureView& view, const std::string& what) {
    throw obs::InputError("frame " + std::to_string(view.frame.value) + ": " + what);
}

std::string sizeText(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

std::array<float, 3> ViewImage::sample(const geometry::Vec2& uv) const {
    const int x = static_cast<int>(std::floor(uv.x())), y = static_cast<int>(std::floor(uv.y()));
    const auto fx = static_cast<float>(uv.x() - x), fy = static_cast<float>(uv.y() - y);
    const uint8_t* top = pixels.ptr<uint8_t>(y);
    const uint8_t* below = pixels.ptr<uint8_t>(y + 1);
    const int channels = pixels.channels();
    std::array<float, 3> rgb{};
    for (int c = 0; c < channels; ++c) {
        const int left = x * channels + c, right = left + channels;
        const float a =
            static_cast<float>(top[left]) * (1 - fx) + static_cast<float>(top[right]) * fx;
        const float b =
            static_cast<float>(below[left]) * (1 - fx) + static_cast<float>(below[right]) * fx;
        rgb[static_cast<std::size_t>(2 - c)] = a * (1 - fy) + b * fy;  // stored blue first
    }
    if (channels == 1) rgb[0] = rgb[1] = rgb[2];
    return rgb;
}

ViewImage checkedImage(const TextureView& view) {
    ViewImage out;
    out.camera = view.images.camera.model;
    if (!out.camera.valid()) badView(view, "texture image without calibration");
    if (view.images.left.isEmpty()) badView(view, "no image to take colours from");
    out.pixels = view.images.left.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
    if (out.pixels.type() != CV_8UC1 && out.pixels.type() != CV_8UC3) {
        badView(view, "texture image must be 8-bit grey or colour");
    }
    if (out.pixels.cols != out.camera.width_px || out.pixels.rows != out.camera.height_px) {
        badView(view, "texture image is " + sizeText(out.pixels.cols, out.pixels.rows) + " but " +
                          sizeText(out.camera.width_px, out.camera.height_px) + " was expected");
    }
    return out;
}

cv::Mat denseMask(const obs::RleMask& mask, int border_px, const cv::Size& imageSize,
                  const TextureView& view, map::ObjectId object) {
    const int width = static_cast<int>(mask.width_px), height = static_cast<int>(mask.height_px);
    if (!mask.consistent() || width != imageSize.width || height != imageSize.height) {
        badView(view, "mask of object " + std::to_string(object.value) + " is " +
                          sizeText(width, height) + " or broken but " +
                          sizeText(imageSize.width, imageSize.height) + " was expected");
    }
    std::vector<uint8_t> dense = mask.toDense();
    cv::Mat out = cv::Mat(height, width, CV_8UC1, dense.data()).clone();
    const int size = 2 * std::abs(border_px) + 1;
    const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_RECT, {size, size});
    if (border_px > 0) cv::erode(out, out, kernel);
    if (border_px < 0) cv::dilate(out, out, kernel);
    return out;
}

std::array<cv::Mat, 2> greyPair(const TextureView& view) {
    std::array<cv::Mat, 2> out;
    const std::array<const mrpt::img::CImage*, 2> images{&view.images.left, &*view.images.right};
    for (std::size_t i = 0; i < 2; ++i) {
        const cv::Mat pixels = images[i]->asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
        if (pixels.channels() == 3) {
            cv::cvtColor(pixels, out[i], cv::COLOR_BGR2GRAY);
        } else {
            out[i] = pixels;
        }
    }
    if (out[0].size() != out[1].size()) {
        badView(view, "right image is " + sizeText(out[1].cols, out[1].rows) + " but " +
                          sizeText(out[0].cols, out[0].rows) + " was expected");
    }
    return out;
}

}  // namespace djpete::texture
