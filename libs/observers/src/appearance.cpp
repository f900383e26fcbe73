#include "djpete/observers/appearance.h"

#include <mrpt/img/CImage.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "djpete/obs/appearance.h"

namespace djpete::observers {

namespace {

constexpr int kLeastPixels = 200;
constexpr double kBorder = 0.15;  // of a box without a mask, on each side
constexpr int kBins = 8;
constexpr double kColourful = 30;  // saturation from which a hue counts in full

cv::Rect rectangleOf(const obs::ImageBox& box, double border, const cv::Size& size) {
    const auto margin = [&](float span) { return float(border) * span; };
    const cv::Rect r(
        cv::Point(int(box.left + margin(box.width())), int(box.top + margin(box.height()))),
        cv::Point(int(box.right - margin(box.width())), int(box.bottom - margin(box.height()))));
    return r & cv::Rect({0, 0}, size);
}

/// The pixels to look at: 255 in `inside`, which is as large as `area`.
struct Region {
    cv::Rect area;
    cv::Mat inside;
};

std::optional<Region> regionOf(const obs::ObjectDetection& d, const cv::Size& size) {
    Region out;
    const bool masked = d.mask && d.mask->consistent() && int(d.mask->width_px) == size.width &&
                        int(d.mask->height_px) == size.height;
    if (masked) {
        auto dense = d.mask->toDense();
        const cv::Mat mask(size, CV_8UC1, dense.data());
        out.area = d.box ? rectangleOf(*d.box, 0, size) : cv::boundingRect(mask);
        out.inside = mask(out.area).clone();
    } else if (d.box) {
        out.area = rectangleOf(*d.box, kBorder, size);
        out.inside = cv::Mat(out.area.size(), CV_8UC1, cv::Scalar(255));
    }
    if (out.area.area() < kLeastPixels || cv::countNonZero(out.inside) < kLeastPixels) {
        return std::nullopt;
    }
    return out;
}

using Sums = std::array<double, kBins>;

void put(const Sums& sums, std::size_t group, obs::Appearance& out) {
    double total = 0;
    for (double v : sums) total += v;
    if (total <= 0) return;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        out[group * kBins + i] = uint8_t(std::lround(255 * sums[i] / total));
    }
}

int binOf(double value, double span) { return std::clamp(int(value * kBins / span), 0, kBins - 1); }

obs::Appearance appearanceOf(const cv::Mat& image, const cv::Mat& inside) {
    cv::Mat grey = image, hsv;
    if (image.channels() == 3) {
        cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
        cv::cvtColor(image, hsv, cv::COLOR_BGR2HSV);
    }
    const double mean = std::max(1.0, cv::mean(grey, inside)[0]);
    Sums hue{}, relative{}, absolute{};
    for (int y = 0; y < grey.rows; ++y) {
        for (int x = 0; x < grey.cols; ++x) {
            if (inside.at<uint8_t>(y, x) == 0) continue;
            const double v = grey.at<uint8_t>(y, x);
            ++relative[size_t(binOf(v / mean, 2))];
            ++absolute[size_t(binOf(v, 256))];
            if (hsv.empty()) continue;
            const auto& c = hsv.at<cv::Vec3b>(y, x);
            hue[size_t(binOf(c[0], 180))] += std::min(1.0, c[1] / kColourful);
        }
    }
    obs::Appearance out{};
    put(hue, 0, out);
    put(relative, 1, out);
    put(absolute, 2, out);
    return out;
}

}  // namespace

void describeAppearance(obs::CObservationDetectedObjects& detections, const obs::ImageSet& images) {
    const cv::Mat& image = images.left.asCvMatRef();
    for (auto& d : detections.detections) {
        if (const auto region = regionOf(d, image.size())) {
            d.appearance = appearanceOf(image(region->area), region->inside);
        }
    }
}

}  // namespace djpete::observers
