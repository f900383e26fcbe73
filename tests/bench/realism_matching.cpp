/// Tracks over time and matches between left and right.
#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "realism_statistics.h"

namespace djpete_bench {
namespace {

struct Track {
    cv::Point2f at;
    double length = 1;  // frames
};

/// Lucas-Kanade there and back; true per point if it comes back to where it was.
std::vector<uchar> follow(const cv::Mat& from, const cv::Mat& to,
                          const std::vector<cv::Point2f>& start, std::vector<cv::Point2f>& end,
                          const cv::Size& window, float tolerance_px) {
    std::vector<uchar> there, back;
    std::vector<float> error;
    std::vector<cv::Point2f> again;
    if (start.empty()) return {};
    cv::calcOpticalFlowPyrLK(from, to, start, end, there, error, window, 4);
    cv::calcOpticalFlowPyrLK(to, from, end, again, back, error, window, 4);
    const cv::Rect2f inside(2, 2, static_cast<float>(to.cols - 4), static_cast<float>(to.rows - 4));
    for (std::size_t i = 0; i < start.size(); ++i) {
        const cv::Point2f d = again[i] - start[i];
        there[i] =
            there[i] && back[i] && std::hypot(d.x, d.y) < tolerance_px && inside.contains(end[i]);
    }
    return there;
}

constexpr int kTracks = 600;
constexpr double kQuality = 0.005, kDistance_px = 10;

}  // namespace

Statistics trackStatistics(const RealismDrive& drive) {
    std::vector<Track> tracks;
    std::vector<double> lengths, lost;
    cv::Mat previous;
    for (std::size_t frame : drive.frames) {
        const cv::Mat grey = drive.left(frame);
        if (!previous.empty()) {
            std::vector<cv::Point2f> start, end;
            for (const auto& t : tracks) start.push_back(t.at);
            const auto kept = follow(previous, grey, start, end, {15, 15}, 0.7F);
            std::vector<Track> next;
            double gone = 0;
            for (std::size_t i = 0; i < tracks.size(); ++i) {
                if (kept[i]) {
                    next.push_back({end[i], tracks[i].length + 1});
                } else {
                    lengths.push_back(tracks[i].length);
                    ++gone;
                }
            }
            if (!tracks.empty()) lost.push_back(gone / static_cast<double>(tracks.size()));
            tracks = std::move(next);
        }
        cv::Mat free(grey.size(), CV_8U, cv::Scalar(255));
        for (const auto& t : tracks)
            cv::circle(free, t.at, static_cast<int>(kDistance_px), cv::Scalar(0), cv::FILLED);
        std::vector<cv::Point2f> fresh;
        if (const int wanted = kTracks - static_cast<int>(tracks.size()); wanted > 0)
            cv::goodFeaturesToTrack(grey, fresh, wanted, kQuality, kDistance_px, free, 5);
        for (const auto& p : fresh) tracks.push_back({p});
        previous = grey;
    }
    for (const auto& t : tracks) lengths.push_back(t.length);
    return {{"track length p50, frames", percentile(lengths, 0.5), false},
            {"track length mean, frames", mean(lengths), false},
            {"tracks lost per frame, share", mean(lost), false}};
}

Statistics stereoStatistics(const RealismDrive& drive) {
    constexpr int kRange_px = 128, kBlock_px = 7, kEvery = 5;
    const auto matcher = cv::StereoSGBM::create(0, kRange_px, kBlock_px, 8 * kBlock_px * kBlock_px,
                                                32 * kBlock_px * kBlock_px, 1, 31, 10, 100, 2);
    std::vector<double> disparities, density, matched, residuals, rows;
    for (std::size_t k = 0; k < drive.frames.size(); k += kEvery) {
        const cv::Mat left = drive.left(drive.frames[k]), right = drive.right(drive.frames[k]);
        cv::Mat disparity;
        matcher->compute(left, right, disparity);
        double found = 0;
        for (int v = 0; v < left.rows; ++v) {
            for (int u = kRange_px; u < left.cols; ++u) {
                const int d = disparity.at<short>(v, u);
                if (d < 8) continue;  // half a pixel: invalid or the sky
                ++found;
                if ((u + v) % 4 == 0) disparities.push_back(d / 16.0);
            }
        }
        density.push_back(found / (static_cast<double>(left.rows) * (left.cols - kRange_px)));
        std::vector<cv::Point2f> corners, ends;
        cv::goodFeaturesToTrack(left, corners, kTracks, kQuality, kDistance_px, cv::noArray(), 5);
        const auto kept = follow(left, right, corners, ends, {11, 11}, 0.3F);
        double good = 0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const cv::Point2f d = corners[i] - ends[i];
            if (!kept[i] || std::abs(d.y) > 1.5F || d.x < 0 || d.x > kRange_px) continue;
            ++good;
            rows.push_back(std::abs(static_cast<double>(d.y)));
            cv::Mat a, b, difference;
            cv::getRectSubPix(left, {9, 9}, corners[i], a);
            cv::getRectSubPix(right, {9, 9}, ends[i], b);
            cv::absdiff(a, b, difference);
            residuals.push_back(cv::mean(difference)[0]);
        }
        matched.push_back(good / std::max(1.0, static_cast<double>(corners.size())));
    }
    Statistics out;
    for (int p : {10, 50, 90})
        out.push_back({"disparity p" + std::to_string(p) + ", px",
                       percentile(disparities, p / 100.0), false});
    out.push_back({"disparity density, share", mean(density), false});
    out.push_back({"corners matched left to right, share", mean(matched), false});
    out.push_back({"patch difference left - right p50, grey", percentile(residuals, 0.5), false});
    out.push_back({"row difference p50, px", percentile(rows, 0.5), true});
    return out;
}

}  // namespace djpete_bench
