#include "djpete/texture/background_cloud.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "dense_stereo.h"
#include "depth_map.h"
#include "djpete/geometry/cuboid.h"
#include "view_image.h"
#include "voxel_key.h"

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

/// A point that the image sees.
struct Candidate {
    Vec3 p_cam{0, 0, 0};
    Vec2 uv{0, 0};
};

std::vector<Candidate> scanCandidates(const TextureView& view, const ViewImage& image,
                                      double maxDistance_m) {
    const SE3 T_cam_velo =
        view.T_world_cam.inverse() * view.T_world_vehicle * view.scan->T_vehicle_velo;
    std::vector<Candidate> ahead;
    DepthMap depth(PixelRect{0, 0, image.pixels.cols, image.pixels.rows});
    for (const auto& point : view.scan->points) {
        Candidate c;
        c.p_cam = T_cam_velo * point.position();
        if (c.p_cam.z() < kNear_m || c.p_cam.norm() > maxDistance_m) continue;
        c.uv = image.camera.project(c.p_cam);
        if (!image.camera.contains(c.uv, 1)) continue;
        depth.drawPoint(c.uv, c.p_cam.z(), kBeamHalfWidth_px, kBeamHalfHeight_px);
        ahead.push_back(c);
    }
    // Neighbouring beams on sloping ground are a share of the depth apart, hence 5 %.
    const auto hidden = [&](const Candidate& c) {
        const float front = depth.at(static_cast<int>(std::lround(c.uv.x())),
                                     static_cast<int>(std::lround(c.uv.y())));
        return c.p_cam.z() > 1.05 * static_cast<double>(front) + kHiddenBehind_m;
    };
    ahead.erase(std::remove_if(ahead.begin(), ahead.end(), hidden), ahead.end());
    return ahead;
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

bool onAnyObject(const Vec3& p_world, const TextureView& view, double margin_m) {
    for (const auto& object : view.objects) {
        const Vec3 apart = p_world - object.T_world_obj.translation();
        if (apart.norm() > 0.5 * object.size_m.norm() + 2 * margin_m) continue;
        const Vec3 p_obj = object.T_world_obj.rotation().transpose() * apart;
        if (geometry::Cuboid{object.size_m}.contains(p_obj, margin_m)) return true;
    }
    return false;
}

ColouredPoint carried(const ColouredPoint& p, const SE3& T_world_vehicle) {
    const Vec3 p_world = T_world_vehicle * Vec3(p.x, p.y, p.z);
    return {static_cast<float>(p_world.x()), static_cast<float>(p_world.y()),
            static_cast<float>(p_world.z()), p.rgb};
}

}  // namespace

BackgroundCloud::BackgroundCloud(const BackgroundCloudOptions& options) : options_(options) {}

std::size_t BackgroundCloud::addView(const TextureView& view) {
    const ViewImage image = checkedImage(view);
    std::vector<Candidate> candidates;
    if (view.scan) {
        candidates = scanCandidates(view, image, options_.max_distance_m);
    } else if (view.images.right && image.camera.hasRight()) {
        candidates = stereoCandidates(view, image, options_.stereo_max_distance_m);
    }
    auto& mine = views_[view.frame];
    mine.T_world_vehicle = view.T_world_vehicle;
    const SE3 T_vehicle_cam = view.T_world_vehicle.inverse() * view.T_world_cam;
    std::vector<uint64_t> fresh;
    std::vector<std::pair<uint64_t, std::size_t>> order;  // voxel, candidate
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Vec3 p_world = view.T_world_cam * candidates[i].p_cam;
        const auto key = voxelKey(p_world, options_.voxel_m);
        if (!key || std::binary_search(occupied_.begin(), occupied_.end(), *key)) continue;
        if (onAnyObject(p_world, view, options_.object_margin_m)) continue;
        order.emplace_back(*key, i);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [key, i] : order) {
        if (count_ >= options_.max_points) break;
        if (!fresh.empty() && fresh.back() == key) continue;
        fresh.push_back(key);
        const auto rgb = image.sample(candidates[i].uv);
        const Vec3 p = T_vehicle_cam * candidates[i].p_cam;
        ColouredPoint point{
            static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), {}};
        for (std::size_t c = 0; c < 3; ++c) {
            point.rgb[c] = static_cast<uint8_t>(std::lround(rgb[c]));
        }
        mine.p_vehicle.push_back(point);
        ++count_;
    }
    const auto middle = static_cast<std::ptrdiff_t>(occupied_.size());
    occupied_.insert(occupied_.end(), fresh.begin(), fresh.end());
    std::inplace_merge(occupied_.begin(), occupied_.begin() + middle, occupied_.end());
    return fresh.size();
}

std::vector<ColouredPoint> BackgroundCloud::points(const map::SlamMap& map) const {
    std::vector<ColouredPoint> out;
    out.reserve(count_);
    for (const auto& [frame, view] : views_) {
        SE3 T_world_vehicle = view.T_world_vehicle;
        if (const auto T_world_cam = map.cameraAt(frame)) {
            const auto& keyframe = map.keyframes().at(map.frames().at(frame).reference);
            T_world_vehicle = *T_world_cam * keyframe.T_vehicle_cam.inverse();
        }
        for (const auto& p : view.p_vehicle) out.push_back(carried(p, T_world_vehicle));
    }
    return out;
}

std::vector<ColouredPoint> BackgroundCloud::points() const { return points(map::SlamMap()); }

}  // namespace djpete::texture
