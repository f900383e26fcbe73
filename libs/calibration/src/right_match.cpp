#include "right_match.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "djpete/obs/errors.h"

namespace djpete::calibration {

namespace {

constexpr int kWindow_px = 11;
constexpr float kWayBack_px = 0.25F;
constexpr float kMaxRow_px = 8.F;

cv::Mat greyOf(const mrpt::img::CImage& image, const frontend::OdometryInput& input) {
    const cv::Mat& mat = image.asCvMatRef();
    if (mat.type() != CV_8UC1 && mat.type() != CV_8UC3) {
        throw obs::InputError("frame " + std::to_string(input.frame.value) +
                              ": an image is not grey or BGR of 8 bit");
    }
    if (mat.channels() == 1) return mat;
    cv::Mat grey;
    cv::cvtColor(mat, grey, cv::COLOR_BGR2GRAY);
    return grey;
}

void follow(const cv::Mat& from, const cv::Mat& to, const std::vector<cv::Point2f>& start,
            std::vector<cv::Point2f>& end, std::vector<uchar>& found) {
    std::vector<float> error;
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.005);
    cv::calcOpticalFlowPyrLK(from, to, start, end, found, error, {kWindow_px, kWindow_px}, 1, until,
                             cv::OPTFLOW_USE_INITIAL_FLOW, 1e-3);
}

}  // namespace

std::vector<RightMatch> matchRight(const frontend::OdometryInput& input,
                                   const obs::CObservationVisualKeyframe& odometry) {
    std::vector<RightMatch> out;
    if (!input.images.right) return out;
    const cv::Mat left = greyOf(input.images.left, input);
    const cv::Mat right = greyOf(*input.images.right, input);
    if (left.size() != right.size()) {
        throw obs::InputError("frame " + std::to_string(input.frame.value) +
                              ": left and right image are not of the same size");
    }
    std::vector<cv::Point2f> start, there, back;
    for (const auto& f : odometry.features) {
        if (!f.uRight_px) continue;
        start.emplace_back(f.u_px, f.v_px);
        there.emplace_back(*f.uRight_px, f.v_px);
    }
    if (start.empty()) return out;
    std::vector<uchar> found, foundBack;
    follow(left, right, start, there, found);
    back = start;
    follow(right, left, there, back, foundBack);
    for (std::size_t i = 0; i < start.size(); ++i) {
        if (!found[i] || !foundBack[i]) continue;
        const cv::Point2f way = back[i] - start[i];
        if (std::hypot(way.x, way.y) > kWayBack_px) continue;
        if (std::abs(there[i].y - start[i].y) > kMaxRow_px) continue;
        if (!(start[i].x - there[i].x > 0)) continue;
        out.push_back({start[i].x, start[i].y, there[i].x, there[i].y});
    }
    return out;
}

}  // namespace djpete::calibration
