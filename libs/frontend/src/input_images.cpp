#include "input_images.h"

#include <opencv2/imgproc.hpp>

#include "djpete/obs/errors.h"

namespace djpete::frontend {

namespace {

std::string sizeText(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

[[noreturn]] void fail(const OdometryInput& input, const std::string& what) {
    throw obs::InputError("frame " + std::to_string(input.frame.value) + ": " + what);
}

cv::Mat matOf(const mrpt::img::CImage& image, const OdometryInput& input, const char* name) {
    if (image.isEmpty()) fail(input, std::string(name) + " is empty; expected an 8 bit image");
    const cv::Mat& mat = image.asCvMatRef();
    if (mat.empty() || (mat.type() != CV_8UC1 && mat.type() != CV_8UC3)) {
        fail(input, std::string(name) + " is not grey or BGR of 8 bit");
    }
    return mat;
}

cv::Mat greyOf(const cv::Mat& mat) {
    if (mat.channels() == 1) return mat;
    cv::Mat grey;
    cv::cvtColor(mat, grey, cv::COLOR_BGR2GRAY);
    return grey;
}

void requireSize(const cv::Mat& mat, const cv::Size& expected, const OdometryInput& input,
                 const char* name) {
    if (mat.size() == expected) return;
    fail(input, std::string(name) + " is " + sizeText(mat.cols, mat.rows) + " but " +
                    sizeText(expected.width, expected.height) + " was expected");
}

}  // namespace

InputImages checkedImages(const OdometryInput& input) {
    InputImages out;
    out.camera = input.images.camera;
    auto& model = out.camera.model;
    if (!model.valid()) fail(input, "camera without calibration; expected positive focal lengths");
    const cv::Mat left = matOf(input.images.left, input, "left image");
    if (model.width_px > 0 && model.height_px > 0) {
        requireSize(left, {model.width_px, model.height_px}, input, "left image");
    }
    model.width_px = left.cols;
    model.height_px = left.rows;
    out.leftGrey = greyOf(left);
    if (left.channels() == 3) out.leftColour = left;
    if (input.images.right) {
        if (!model.hasRight()) fail(input, "right image without a baseline; expected it positive");
        const cv::Mat right = matOf(*input.images.right, input, "right image");
        requireSize(right, left.size(), input, "right image");
        out.rightGrey = greyOf(right);
    }
    if (input.exclusion) {
        const cv::Mat mask = matOf(*input.exclusion, input, "exclusion mask");
        if (mask.channels() != 1) fail(input, "exclusion mask has colours; expected one channel");
        requireSize(mask, left.size(), input, "exclusion mask");
        out.exclusion = mask;
    }
    return out;
}

}  // namespace djpete::frontend
