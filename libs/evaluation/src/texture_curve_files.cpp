#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "djpete/evaluation/texture_curve.h"
#include "djpete/obs/errors.h"
#include "djpete/texture/render_model.h"

namespace djpete::evaluation {

namespace {

constexpr int kWidth_px = 900, kHeight_px = 360, kLeft_px = 70, kBottom_px = 50, kTop_px = 40;

std::string field(const std::optional<double>& value) {
    if (!value) return "";
    char text[32];
    std::snprintf(text, sizeof(text), "%.4f", *value);
    return text;
}

/// One diagram: values over the number of views.
class Diagram {
  public:
    Diagram(std::size_t steps, double top, const std::string& title)
        : steps_(static_cast<double>(std::max<std::size_t>(2, steps))), top_(top > 0 ? top : 1) {
        image_ = cv::Mat(kHeight_px, kWidth_px, CV_8UC3, cv::Scalar::all(255));
        text(title, {kLeft_px, kTop_px - 15}, 0.55);
        text("views", {kWidth_px - 70, kHeight_px - 12}, 0.45);
        for (int i = 0; i <= 4; ++i) {
            const double y = top_ * i / 4;
            cv::line(image_, at(1, y), at(steps_, y), cv::Scalar::all(225));
            char label[32];
            std::snprintf(label, sizeof(label), "%.1f", y);
            text(label, {15, at(1, y).y + 5}, 0.45);
        }
        for (int s = 1; s <= static_cast<int>(steps); s += steps > 20 ? 5 : 1) {
            text(std::to_string(s), {at(s, 0).x - 5, kHeight_px - 28}, 0.4);
        }
    }
    void draw(const std::vector<double>& values, const cv::Scalar& colour, int thickness) {
        for (std::size_t i = 1; i < values.size(); ++i) {
            const auto x = static_cast<double>(i);
            cv::line(image_, at(x, values[i - 1]), at(x + 1, values[i]), colour, thickness,
                     cv::LINE_AA);
        }
    }
    const cv::Mat& image() const { return image_; }

  private:
    cv::Point at(double step, double value) const {
        const double x = (step - 1) / (steps_ - 1), y = std::clamp(value / top_, 0.0, 1.0);
        return {static_cast<int>(std::lround(kLeft_px + x * (kWidth_px - kLeft_px - 25))),
                static_cast<int>(std::lround(kHeight_px - kBottom_px -
                                             y * (kHeight_px - kBottom_px - kTop_px)))};
    }
    void text(const std::string& words, const cv::Point& where, double size) {
        cv::putText(image_, words, where, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar::all(30), 1,
                    cv::LINE_AA);
    }
    cv::Mat image_;
    double steps_, top_;
};

cv::Mat diagramOf(const TextureCurves& curves, CurveValue value, const std::string& title) {
    std::size_t steps = 0;
    double top = 0;
    for (const auto& o : curves.objects) {
        steps = std::max(steps, o.points.size());
        for (const auto& p : o.points) top = std::max(top, (p.*value).value_or(0));
    }
    Diagram diagram(steps, top, title);
    for (const auto& o : curves.objects) {
        std::vector<double> values;
        for (const auto& p : o.points) {
            if (p.*value) values.push_back(*(p.*value));
        }
        diagram.draw(values, {200, 170, 120}, 1);
    }
    diagram.draw(meanCurve(curves, value), {40, 40, 200}, 3);
    return diagram.image();
}

}  // namespace

std::optional<double> imageErrorOf(const texture::ObjectModel& model, const RgbImage& image,
                                   const MaskImage& mask, const geometry::StereoCamera& camera,
                                   const geometry::SE3& T_cam_est) {
    texture::RenderOptions seenOnly;
    seenOnly.onlySeen = true;
    const auto rendered = texture::renderModel(model, camera, T_cam_est, seenOnly);
    // Sums over covered values (x rendering, y image), and over all of the mask's.
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0, all = 0, allY = 0, allYy = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (mask.pixels[i] == 0) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const double x = rendered.rgb[i][c], y = image.pixels[i][c];
            all += 1, allY += y, allYy += y * y;
            if (rendered.covered(i))
                n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
        }
    }
    if (all == 0) return std::nullopt;
    const double mean = allY / all;
    // Of pixels without rendering, around the mask's mean.
    double squares = (allYy - syy) - 2 * mean * (allY - sy) + mean * mean * (all - n);
    if (n > 0) {
        const double vx = sxx - sx * sx / n, vy = syy - sy * sy / n, vxy = sxy - sx * sy / n;
        squares += std::max(0.0, vy - (vx > 0 && vxy > 0 ? vxy * vxy / vx : 0));
    }
    return std::sqrt(std::max(0.0, squares) / all);
}

void writeCurvesCsv(const TextureCurves& curves, const std::string& file) {
    std::ofstream out(file);
    out << "object,actor,step,frame,points,coloured_points,colour_error_de2000,image_error\n";
    for (const auto& o : curves.objects) {
        for (const auto& p : o.points) {
            out << o.objectId << ',' << o.actorId << ',' << p.step << ',' << p.frame << ','
                << p.points << ',' << p.colouredPoints << ',' << field(p.colourError) << ','
                << field(p.imageError) << '\n';
        }
    }
    if (!out.flush()) throw obs::InputError(file + ": cannot be written");
}

void plotCurves(const TextureCurves& curves, const std::string& file) {
    cv::Mat both;
    cv::vconcat(diagramOf(curves, &CurvePoint::imageError,
                          "error in held-out images over all of the mask (RMS, 0..255)"),
                diagramOf(curves, &CurvePoint::colourError,
                          "colour error of the points coloured so far (CIEDE2000, median)"),
                both);
    bool written = false;
    try {
        written = cv::imwrite(file, both);
    } catch (const cv::Exception&) {
        written = false;
    }
    if (!written) throw obs::InputError(file + ": cannot be written");
}

}  // namespace djpete::evaluation
