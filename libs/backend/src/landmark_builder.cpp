#include "landmark_builder.h"

#include <cmath>
#include <optional>

namespace djpete::backend {

namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

/// A landmark that no second keyframe has seen goes after this many keyframes.
constexpr std::size_t kPatience = 4;
constexpr double kMaxReprojection_px = 3;

Vec2 pixel(const obs::KeyframeFeature& f) {
    return {static_cast<double>(f.u_px), static_cast<double>(f.v_px)};
}

std::optional<double> depthOf(const obs::KeyframeFeature& f, const geometry::StereoCamera& camera,
                              const BackboneOptions& options) {
    std::optional<double> depth;
    if (f.depth_m) {
        depth = static_cast<double>(*f.depth_m);
    } else if (f.uRight_px && camera.hasRight()) {
        const double disparity = static_cast<double>(f.u_px) - static_cast<double>(*f.uRight_px);
        if (disparity >= options.minDisparity_px) depth = camera.depthFromDisparity(disparity);
    }
    if (depth && *depth > options.maxDepth_m) depth.reset();
    return depth;
}

bool reprojects(const map::Keyframe& kf, const obs::KeyframeFeature& f, const Vec3& p_world) {
    const Vec3 p_cam = kf.T_world_cam.inverse() * p_world;
    return p_cam.z() > 0.1 && (kf.camera.project(p_cam) - pixel(f)).norm() < kMaxReprojection_px;
}

/// The middle of the shortest line between two rays; nothing if they are nearly parallel, meet
/// behind a camera, or miss each other.
std::optional<Vec3> triangulate(const map::Keyframe& a, const obs::KeyframeFeature& fa,
                                const map::Keyframe& b, const obs::KeyframeFeature& fb,
                                double minParallax_rad) {
    const Vec3 ra = (a.T_world_cam.rotation() * a.camera.ray(pixel(fa))).normalized();
    const Vec3 rb = (b.T_world_cam.rotation() * b.camera.ray(pixel(fb))).normalized();
    if (ra.cross(rb).norm() < std::sin(minParallax_rad)) return std::nullopt;
    const Vec3 between = b.T_world_cam.translation() - a.T_world_cam.translation();
    const double c = ra.dot(rb), da = ra.dot(between), db = rb.dot(between);
    const double s = (da - c * db) / (1 - c * c), t = (c * da - db) / (1 - c * c);
    const Vec3 p_world =
        0.5 * (a.T_world_cam.translation() + s * ra + b.T_world_cam.translation() + t * rb);
    if (!reprojects(a, fa, p_world) || !reprojects(b, fb, p_world)) return std::nullopt;
    return p_world;
}

}  // namespace

void LandmarkBuilder::begin(map::SlamMap& map, const Vec3& p_world, const Sighting& now) {
    const auto& f = map.keyframes().at(now.keyframe).features[now.feature];
    const auto id = map.addLandmark(p_world, f.rgb);
    map.observe(id, now.keyframe, now.feature);
    landmarkOf_[f.track] = id;
    begun_.back().push_back(id);
    const auto first = waiting_.find(f.track);
    if (first == waiting_.end()) return;
    const auto& kf = map.keyframes().at(first->second.keyframe);
    if (!kf.landmarks[first->second.feature] &&
        reprojects(kf, kf.features[first->second.feature], p_world)) {
        map.observe(id, first->second.keyframe, first->second.feature);
    }
    waiting_.erase(first);
}

void LandmarkBuilder::connect(map::SlamMap& map, map::KeyframeId keyframe,
                              const BackboneOptions& options, BackendStatistics& statistics) {
    begun_.emplace_back();
    const map::Keyframe& kf = map.keyframes().at(keyframe);
    for (uint32_t i = 0; i < kf.features.size(); ++i) {
        const auto& f = kf.features[i];
        const auto known = landmarkOf_.find(f.track);
        if (known != landmarkOf_.end() && map.landmarks().count(known->second) != 0) {
            // Two tracks may have become one landmark: the first of them counts.
            if (map.landmarks().at(known->second).observations.count(keyframe) == 0) {
                map.observe(known->second, keyframe, i);
            }
            continue;
        }
        if (const auto depth = depthOf(f, kf.camera, options)) {
            begin(map, kf.T_world_cam * kf.camera.backProject(pixel(f), *depth), {keyframe, i});
            continue;
        }
        const auto first = waiting_.find(f.track);
        if (first == waiting_.end()) {
            waiting_[f.track] = {keyframe, i};
            continue;
        }
        const auto& other = map.keyframes().at(first->second.keyframe);
        const auto p_world = triangulate(other, other.features[first->second.feature], kf, f,
                                         options.minParallax_rad);
        if (p_world) begin(map, *p_world, {keyframe, i});
    }
    statistics.landmarksCreated += begun_.back().size();
    if (begun_.size() > kPatience) cullUnseen(map, statistics);
}

void LandmarkBuilder::merged(const map::SlamMap& map, map::LandmarkId kept, map::LandmarkId gone) {
    for (const auto& [keyframe, feature] : map.landmarks().at(gone).observations) {
        if (keyframe < first_) continue;
        const auto track = map.keyframes().at(keyframe).features[feature].track;
        const auto it = landmarkOf_.find(track);
        if (it != landmarkOf_.end() && it->second == gone) it->second = kept;
    }
}

void LandmarkBuilder::cullUnseen(map::SlamMap& map, BackendStatistics& statistics) {
    for (const auto id : begun_.front()) {
        const auto it = map.landmarks().find(id);
        if (it == map.landmarks().end() || it->second.observations.size() >= 2) continue;
        map.removeLandmark(id);
        ++statistics.landmarksCulled;
    }
    begun_.pop_front();
}

}  // namespace djpete::backend
