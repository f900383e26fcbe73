#include "canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "djpete/geometry/cuboid.h"
#include "djpete/obs/errors.h"

namespace djpete::figures {

namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

constexpr int kGap_px = 8, kCaption_px = 26;
constexpr double kNear_m = 0.3;

cv::Mat scaledTo(const cv::Mat& panel, double factor) {
    if (std::abs(factor - 1) < 1e-9) return panel;
    cv::Mat out;
    cv::resize(panel, out, cv::Size(), factor, factor,
               factor < 1 ? cv::INTER_AREA : cv::INTER_CUBIC);
    return out;
}

}  // namespace

cv::Mat colourCopy(const mrpt::img::CImage& image) {
    cv::Mat out;
    const cv::Mat& pixels = image.asCvMatRef();
    if (pixels.channels() == 1) {
        cv::cvtColor(pixels, out, cv::COLOR_GRAY2BGR);
    } else {
        pixels.copyTo(out);
    }
    return out;
}

void text(cv::Mat& on, const std::string& what, const cv::Point& at, const cv::Scalar& colour,
          double size) {
    cv::putText(on, what, at, cv::FONT_HERSHEY_SIMPLEX, size, colour, 1, cv::LINE_AA);
}

cv::Mat captioned(const cv::Mat& panel, const std::string& what) {
    cv::Mat out(panel.rows + kCaption_px, panel.cols, CV_8UC3, cv::Scalar::all(255));
    panel.copyTo(out(cv::Rect(0, kCaption_px, panel.cols, panel.rows)));
    text(out, what, {4, 18}, cv::Scalar::all(30));
    return out;
}

cv::Mat beside(const std::vector<cv::Mat>& panels) {
    std::vector<cv::Mat> scaled;
    int width = 0;
    for (const auto& p : panels) {
        scaled.push_back(scaledTo(p, static_cast<double>(panels[0].rows) / p.rows));
        width += scaled.back().cols + (scaled.size() > 1 ? kGap_px : 0);
    }
    cv::Mat out(panels[0].rows, width, CV_8UC3, cv::Scalar::all(255));
    int x = 0;
    for (const auto& p : scaled) {
        const int rows = std::min(p.rows, out.rows);
        p.rowRange(0, rows).copyTo(out(cv::Rect(x, 0, p.cols, rows)));
        x += p.cols + kGap_px;
    }
    return out;
}

cv::Mat below(const std::vector<cv::Mat>& panels) {
    std::vector<cv::Mat> scaled;
    int height = 0;
    for (const auto& p : panels) {
        scaled.push_back(scaledTo(p, static_cast<double>(panels[0].cols) / p.cols));
        height += scaled.back().rows + (scaled.size() > 1 ? kGap_px : 0);
    }
    cv::Mat out(height, panels[0].cols, CV_8UC3, cv::Scalar::all(255));
    int y = 0;
    for (const auto& p : scaled) {
        const int cols = std::min(p.cols, out.cols);
        p.colRange(0, cols).copyTo(out(cv::Rect(0, y, cols, p.rows)));
        y += p.rows + kGap_px;
    }
    return out;
}

void save(const cv::Mat& picture, const std::string& file) {
    bool written = false;
    try {
        written = cv::imwrite(file, picture);
    } catch (const cv::Exception&) {
        written = false;
    }
    if (!written) throw obs::InputError(file + ": cannot be written");
}

cv::Scalar colourOf(int64_t id) {
    const double golden = std::fmod(0.61803398875 * static_cast<double>(id) + 0.1, 1.0);
    const cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar(golden * 179, 210, 255));
    cv::Mat bgr;
    cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
    const auto c = bgr.at<cv::Vec3b>(0, 0);
    return {double(c[0]), double(c[1]), double(c[2])};
}

void drawBox(cv::Mat& on, const geometry::StereoCamera& camera, const SE3& T_cam_obj,
             const Vec3& size_m, const cv::Scalar& colour, int width_px) {
    const auto corners = geometry::Cuboid{size_m}.corners();
    const auto edge = [&](Vec3 a, Vec3 b, int width) {
        if (a.z() < b.z()) std::swap(a, b);
        if (a.z() < kNear_m) return;
        if (b.z() < kNear_m) b = a + (b - a) * ((a.z() - kNear_m) / (a.z() - b.z()));
        const Vec2 p = camera.project(a), q = camera.project(b);
        if (p.cwiseAbs().maxCoeff() > 2e4 || q.cwiseAbs().maxCoeff() > 2e4) return;
        cv::line(on, cv::Point(int(std::lround(p.x())), int(std::lround(p.y()))),
                 cv::Point(int(std::lround(q.x())), int(std::lround(q.y()))), colour, width,
                 cv::LINE_AA);
    };
    for (unsigned i = 0; i < 8; ++i) {
        for (const unsigned bit : {1U, 2U, 4U}) {
            if ((i & bit) == 0)
                edge(T_cam_obj * corners[i], T_cam_obj * corners[i | bit], width_px);
        }
    }
    edge(T_cam_obj * corners[1], T_cam_obj * corners[7], 1);
    edge(T_cam_obj * corners[3], T_cam_obj * corners[5], 1);
}

VirtualCamera lookingAt(const Vec3& eye, const Vec3& target, double height_deg, int width_px,
                        int height_px) {
    VirtualCamera out;
    auto& m = out.model;
    m.fx = m.fy = 0.5 * height_px / std::tan(0.5 * height_deg * M_PI / 180);
    m.cx = 0.5 * (width_px - 1);
    m.cy = 0.5 * (height_px - 1);
    m.width_px = width_px;
    m.height_px = height_px;
    const Vec3 ahead = (target - eye).normalized();
    const Vec3 right = ahead.cross(Vec3(0, 0, 1)).normalized();
    geometry::Mat3 R_base_cam;
    R_base_cam << right, ahead.cross(right), ahead;
    out.T_cam_base = SE3(R_base_cam, eye).inverse();
    return out;
}

}  // namespace djpete::figures
