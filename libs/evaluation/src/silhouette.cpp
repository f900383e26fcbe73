#include "djpete/evaluation/silhouette.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace djpete::evaluation {

namespace {

double psnrOf(double squares, double count) {
    constexpr double kBest_dB = 60;
    const double mse = squares / count;
    return mse > 0 ? std::min(kBest_dB, 10 * std::log10(255.0 * 255.0 / mse)) : kBest_dB;
}

}  // namespace

std::optional<ImageMatch> matchImages(const texture::RenderedModel& rendered, const RgbImage& image,
                                      const MaskImage& mask) {
    constexpr std::size_t kFewest = 50;
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    ImageMatch out;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (mask.pixels[i] == 0 || !rendered.covered(i)) continue;
        ++out.pixels;
        for (std::size_t c = 0; c < 3; ++c) {
            const double x = rendered.rgb[i][c], y = image.pixels[i][c];
            n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
        }
    }
    if (out.pixels < kFewest) return std::nullopt;
    const double vx = sxx - sx * sx / n, vy = syy - sy * sy / n, vxy = sxy - sx * sy / n;
    // Least squares: what the rendering explains of the image's spread. A negative of the image
    // explains nothing.
    const double explained = vx > 0 && vxy > 0 ? vxy * vxy / vx : 0;
    out.psnr_dB = psnrOf(std::max(0.0, vy - explained), n);
    out.flatPsnr_dB = psnrOf(std::max(0.0, vy), n);
    return out;
}

MaskImage closedSilhouette(const texture::RenderedModel& rendered, int radius_px) {
    MaskImage out{rendered.width_px, rendered.height_px, {}};
    out.pixels.resize(rendered.point.size());
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        out.pixels[i] = rendered.covered(i) ? 255 : 0;
    }
    if (radius_px > 0) {
        cv::Mat view(out.height_px, out.width_px, CV_8UC1, out.pixels.data());
        const int side = 2 * radius_px + 1;
        cv::morphologyEx(view, view, cv::MORPH_CLOSE,
                         cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
    }
    return out;
}

std::optional<double> silhouetteIou(const MaskImage& silhouette, const MaskImage& mask,
                                    const MaskImage& ignore) {
    std::size_t both = 0, either = 0;
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        if (!ignore.pixels.empty() && ignore.pixels[i] != 0) continue;
        const bool a = silhouette.pixels[i] != 0, b = mask.pixels[i] != 0;
        if (a && b) ++both;
        if (a || b) ++either;
    }
    if (either == 0) return std::nullopt;
    return static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace djpete::evaluation
