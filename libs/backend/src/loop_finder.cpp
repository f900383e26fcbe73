#include <algorithm>
#include <chrono>

#include "djpete/backend/loops.h"

namespace djpete::backend {

using map::KeyframeId;

namespace {

/// Keyframes of one world, nearest first, that look the same way from near by.
std::vector<LoopJob::Near> nearKeyframes(const map::SlamMap& map, const map::Keyframe& kf,
                                         const std::set<KeyframeId>& excluded,
                                         const LoopOptions& options) {
    std::vector<std::pair<double, LoopJob::Near>> found;
    for (const auto& [id, other] : map.keyframes()) {
        if (id >= kf.id) break;
        if (other.world != kf.world || excluded.count(id) != 0) continue;
        const geometry::SE3 T_near_view = other.T_world_cam.inverse() * kf.T_world_cam;
        const double distance_m = T_near_view.translation().norm();
        if (distance_m > options.nearDistance_m) continue;
        if (T_near_view.angle_rad() > options.nearAngle_rad) continue;
        found.push_back({distance_m, {id, T_near_view}});
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<LoopJob::Near> out;
    constexpr std::size_t kMostNear = 2;
    for (std::size_t i = 0; i < std::min(kMostNear, found.size()); ++i) {
        out.push_back(found[i].second);
    }
    return out;
}

}  // namespace

LoopJob loopJob(const map::SlamMap& map, KeyframeId id, bool claimed, const LoopOptions& options) {
    LoopJob job;
    const map::Keyframe& kf = map.keyframes().at(id);
    job.view = places::placeView(kf);
    for (auto it = map.keyframes().rbegin(); it != map.keyframes().rend(); ++it) {
        const bool recent = kf.id.value - it->first.value < options.minGapKeyframes;
        if (it->second.segment != kf.segment || !recent) break;
        job.excluded.insert(it->first);
    }
    const bool lost = kf.world != map.keyframes().begin()->second.world;
    job.search = claimed || lost || id.value % options.searchEvery == 0;
    job.near = nearKeyframes(map, kf, job.excluded, options);
    return job;
}

LoopUpdate LoopFinder::find(const LoopJob& job) {
    const auto begin = std::chrono::steady_clock::now();
    LoopUpdate out;
    out.id = job.view.id;
    for (const auto& near : job.near) {
        const auto* view = database_.find(near.id);
        if (!view) continue;
        if (auto match =
                places::matchViewsNear(*view, job.view, near.T_near_view, options_.match)) {
            out.matches.push_back({near.id, std::move(*match), true});
        }
    }
    if (out.matches.empty() && job.search) {
        const auto allowed = [&](KeyframeId id) { return job.excluded.count(id) == 0; };
        for (const auto& candidate :
             database_.query(job.view, options_.loops.candidates, allowed)) {
            const auto* view = database_.find(candidate.id);
            if (!view) continue;
            auto match = places::matchViews(*view, job.view, options_.match, out.id.value);
            if (!match) continue;
            out.matches.push_back({candidate.id, std::move(*match), false});
            break;
        }
    }
    database_.add(job.view);
    out.time_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return out;
}

}  // namespace djpete::backend
