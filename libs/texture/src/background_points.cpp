#include "djpete/texture/background_points.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "dense_stereo.h"
#include "depth_map.h"
#include "view_image.h"

namespace djpete::texture {

namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

constexpr double kNear_m = 0.5;
constexpr double kHiddenBehind_m = 0.5;
constexpr double kBeamHalfWidth_px = 2,
                 kBeamHalfHeight_px = 3.5;  // of a 64-beam scan in KITTI's image
constexpr double kNearestStereo_m = 3;
constexpr double kMinContrast = 2;  // grey levels

/// A point in front of the camera.
struct Candidate {
    Vec3 p_cam{0, 0, 0};
    Vec2 uv{0, 0};
    bool seen = true;
};

std::vector<Candidate> scanCandidates(const TextureView& view, const ViewImage& image,
                                      const ViewPointRange& range) {
    const SE3 T_cam_velo =
        view.T_world_cam.inverse() * view.T_world_vehicle * view.scan->T_vehicle_velo;
    std::vector<Candidate> out;
    out.reserve(view.scan->points.size());
    DepthMap depth(PixelRect{0, 0, image.pixels.cols, image.pixels.rows});
    for (const auto& point : view.scan->points) {
        Candidate c;
        c.p_cam = T_cam_velo * point.position();
        if (c.p_cam.norm() > range.scan_m) continue;
        c.seen = c.p_cam.z() >= kNear_m;
        if (c.seen) {
            c.uv = image.camera.project(c.p_cam);
            c.seen = image.camera.contains(c.uv, 1);
        }
        if (c.seen) {
            depth.drawPoint(c.uv, c.p_cam.z(), kBeamHalfWidth_px, kBeamHalfHeight_px);
        } else if (!range.unseen) {
            continue;
        }
        out.push_back(c);
    }
    // Neighbouring beams on sloping ground are a share of the depth apart, hence 5 %.
    const auto hidden = [&](const Candidate& c) {
        const float front = depth.at(static_cast<int>(std::lround(c.uv.x())),
                                     static_cast<int>(std::lround(c.uv.y())));
        return c.p_cam.z() > 1.05 * static_cast<double>(front) + kHiddenBehind_m;
    };
    for (auto& c : out) c.seen = c.seen && !hidden(c);
    if (range.unseen) return out;
    out.erase(std::remove_if(out.begin(), out.end(), [](const auto& c) { return !c.seen; }),
              out.end());
    return out;
}

/// True if the depth at (x, y) is known and goes on around it without a jump, at least where half
/// of the neighbours are known: matching fattens edges and invents islands.
bool onSurface(const cv::Mat& depth, int x, int y) {
    constexpr int kReach_px = 3;
    constexpr float kJump = 0.1F;  // share of the depth
    const float z = depth.at<float>(y, x);
    if (z <= 0 || x < kReach_px || y < kReach_px || x >= depth.cols - kReach_px ||
        y >= depth.rows - kReach_px) {
        return false;
    }
    int known = 0;
    for (int dy = -kReach_px; dy <= kReach_px; dy += kReach_px) {
        for (int dx = -kReach_px; dx <= kReach_px; dx += kReach_px) {
            const float other = depth.at<float>(y + dy, x + dx);
            if (other <= 0) continue;
            if (std::abs(other - z) > kJump * z) return false;
            ++known;
        }
    }
    return known >= 6;  // itself and more than half of the others
}

/// Dense stereo at half resolution.
std::vector<Candidate> stereoCandidates(const TextureView& view, const ViewImage& image,
                                        double maxDistance_m) {
    std::array<cv::Mat, 2> half;
    const auto pair = greyPair(view);
    for (std::size_t i = 0; i < 2; ++i) {
        cv::resize(pair[i], half[i], cv::Size(pair[i].cols / 2, pair[i].rows / 2), 0, 0,
                   cv::INTER_AREA);
    }
    geometry::StereoCamera camera = image.camera;
    camera.width_px = half[0].cols;
    camera.height_px = half[0].rows;
    const double sx = half[0].cols / static_cast<double>(pair[0].cols);
    const double sy = half[0].rows / static_cast<double>(pair[0].rows);
    camera.fx *= sx;
    camera.fy *= sy;
    camera.cx = (camera.cx + 0.5) * sx - 0.5;
    camera.cy = (camera.cy + 0.5) * sy - 0.5;
    const PixelRect all{0, 0, camera.width_px, camera.height_px};
    const cv::Mat depth =
        denseDepth(half, camera, all, kNearestStereo_m, maxDistance_m, kMinContrast);
    std::vector<Candidate> out;
    for (int y = 0; y < depth.rows; ++y) {
        for (int x = 0; x < depth.cols; ++x) {
            const auto z = static_cast<double>(depth.at<float>(y, x));
            if (!onSurface(depth, x, y)) continue;
            Candidate c;
            c.p_cam = camera.backProject(Vec2(x, y), z);
            c.uv = image.camera.project(c.p_cam);
            if (c.p_cam.norm() > maxDistance_m || !image.camera.contains(c.uv, 1)) continue;
            out.push_back(c);
        }
    }
    return out;
}

}  // namespace

std::vector<ViewPoint> viewPoints(const TextureView& view, const ViewPointRange& range) {
    const ViewImage image = checkedImage(view);
    std::vector<Candidate> candidates;
    if (view.scan) {
        candidates = scanCandidates(view, image, range);
    } else if (view.images.right && image.camera.hasRight()) {
        candidates = stereoCandidates(view, image, range.stereo_m);
    }
    std::vector<ViewPoint> out;
    out.reserve(candidates.size());
    for (const auto& c : candidates) {
        ViewPoint point{c.p_cam, c.seen, {0, 0, 0}};
        if (c.seen) {
            const auto rgb = image.sample(c.uv);
            for (std::size_t i = 0; i < 3; ++i) {
                point.rgb[i] = static_cast<uint8_t>(std::lround(rgb[i]));
            }
        }
        out.push_back(point);
    }
    return out;
}

}  // namespace djpete::texture
