/// Corners, gradients, grey levels and noise of images.
#include <algorithm>
#include <numeric>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "realism_statistics.h"

namespace djpete_bench {
namespace {

/// Counts of whole numbers, for percentiles of many pixels.
class Histogram {
  public:
    explicit Histogram(std::size_t size) : counts_(size, 0) {}
    void add(std::size_t value) { ++counts_[std::min(value, counts_.size() - 1)]; }
    /// Interpolated within the bin, so that whole numbers do not hide differences.
    double at(double share) const {
        const double all = std::accumulate(counts_.begin(), counts_.end(), 0.0);
        double below = 0;
        for (std::size_t i = 0; i < counts_.size(); ++i) {
            const double here = static_cast<double>(counts_[i]);
            if (here > 0 && below + here >= share * all)
                return static_cast<double>(i) - 0.5 + (share * all - below) / here;
            below += here;
        }
        return static_cast<double>(counts_.size());
    }

  private:
    std::vector<std::size_t> counts_;
};

/// Sigma of the noise in the flattest tenth of all 16x16 blocks that are neither black nor
/// saturated, grey levels. The kernel is blind to planes; 6 is its norm.
double noiseOf(const cv::Mat& grey) {
    static const cv::Mat kernel = (cv::Mat_<float>(3, 3) << 1, -2, 1, -2, 4, -2, 1, -2, 1);
    cv::Mat residual;
    cv::filter2D(grey, residual, CV_32F, kernel);
    constexpr int kBlock = 16;
    std::vector<double> sigmas;
    for (int v = 0; v + kBlock <= grey.rows; v += kBlock) {
        for (int u = 0; u + kBlock <= grey.cols; u += kBlock) {
            const cv::Rect block(u, v, kBlock, kBlock);
            const double level = cv::mean(grey(block))[0];
            if (level < 25 || level > 225) continue;
            sigmas.push_back(std::sqrt(M_PI / 2) * cv::mean(cv::abs(residual(block)))[0] / 6);
        }
    }
    return percentile(std::move(sigmas), 0.1).value_or(0);
}

}  // namespace

std::optional<double> percentile(std::vector<double> values, double share) {
    if (values.empty()) return std::nullopt;
    const auto nth = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + nth, values.end());
    return values[static_cast<std::size_t>(nth)];
}

std::optional<double> mean(const std::vector<double>& values) {
    if (values.empty()) return std::nullopt;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Statistics imageStatistics(const RealismDrive& drive) {
    constexpr std::array<int, 4> kThresholds{10, 20, 40, 60};
    std::array<std::vector<double>, 4> corners;
    std::array<std::vector<double>, 3> bands;  // of FAST 20: upper, middle, lower third
    constexpr double kGradientScale = 10;      // bins per grey level per pixel
    Histogram gradients(4000), levels(256);
    std::vector<double> noise;
    for (std::size_t frame : drive.frames) {
        const cv::Mat grey = drive.left(frame);
        for (std::size_t k = 0; k < kThresholds.size(); ++k) {
            std::vector<cv::KeyPoint> found;
            cv::FAST(grey, found, kThresholds[k], true);
            corners[k].push_back(static_cast<double>(found.size()));
            if (kThresholds[k] != 20) continue;
            std::array<double, 3> count{};
            for (const auto& p : found)
                ++count[std::min<std::size_t>(
                    2, static_cast<std::size_t>(3 * p.pt.y / static_cast<float>(grey.rows)))];
            for (std::size_t b = 0; b < 3; ++b) bands[b].push_back(count[b]);
        }
        cv::Mat dx, dy;
        cv::Sobel(grey, dx, CV_32F, 1, 0, 3, 0.125);
        cv::Sobel(grey, dy, CV_32F, 0, 1, 3, 0.125);
        for (int v = 1; v + 1 < grey.rows; ++v) {
            for (int u = 1; u + 1 < grey.cols; ++u) {
                const double g = std::hypot(dx.at<float>(v, u), dy.at<float>(v, u));
                gradients.add(static_cast<std::size_t>(kGradientScale * g + 0.5));
                levels.add(grey.at<uchar>(v, u));
            }
        }
        noise.push_back(noiseOf(grey));
    }
    Statistics out;
    for (std::size_t k = 0; k < kThresholds.size(); ++k)
        out.push_back({"FAST " + std::to_string(kThresholds[k]) + " corners per image",
                       mean(corners[k]), false});
    const std::array<const char*, 3> kBands{"upper", "middle", "lower"};
    for (std::size_t b = 0; b < 3; ++b)
        out.push_back(
            {std::string("FAST 20 in the ") + kBands[b] + " third", mean(bands[b]), true});
    for (int p : {50, 75, 90, 95, 99})
        out.push_back({"gradient p" + std::to_string(p) + ", grey/px",
                       gradients.at(p / 100.0) / kGradientScale, false});
    for (int p : {5, 50, 95})
        out.push_back({"grey level p" + std::to_string(p), levels.at(p / 100.0), true});
    out.push_back({"noise in flat blocks, grey", mean(noise), false});
    return out;
}

}  // namespace djpete_bench
