#include <algorithm>
#include <map>
#include <set>

#include "djpete/backend/backbone.h"

namespace djpete::backend {

namespace {

using map::KeyframeId;
using map::LandmarkId;
using map::SlamMap;

/// Ids with counts, largest count first, newest first among equals.
std::vector<std::pair<KeyframeId, unsigned>> byCount(const std::map<KeyframeId, unsigned>& counts) {
    std::vector<std::pair<KeyframeId, unsigned>> out(counts.rbegin(), counts.rend());
    std::stable_sort(out.begin(), out.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    return out;
}

/// The newest keyframe, those that share most landmarks with it, then the newest of the rest.
std::set<KeyframeId> freeWindow(const SlamMap& map, const BackboneOptions& options,
                                unsigned windowSize) {
    const map::Keyframe& newest = *map.lastKeyframe();
    std::map<KeyframeId, unsigned> shared;
    for (const auto& landmark : newest.landmarks) {
        if (!landmark) continue;
        for (const auto& [keyframe, feature] : map.landmarks().at(*landmark).observations) {
            if (keyframe != newest.id && map.keyframes().at(keyframe).world == newest.world) {
                ++shared[keyframe];
            }
        }
    }
    std::set<KeyframeId> window{newest.id};
    for (const auto& [keyframe, count] : byCount(shared)) {
        if (window.size() >= windowSize || count < options.minShared) break;
        window.insert(keyframe);
    }
    for (auto it = map.keyframes().rbegin(); it != map.keyframes().rend(); ++it) {
        if (window.size() >= windowSize) break;
        if (it->second.world == newest.world) window.insert(it->first);
    }
    return window;
}

/// Landmarks that a free keyframe sees and that two keyframes see at least.
std::set<LandmarkId> landmarksOf(const SlamMap& map, const std::set<KeyframeId>& window) {
    std::set<LandmarkId> out;
    for (const KeyframeId id : window) {
        for (const auto& landmark : map.keyframes().at(id).landmarks) {
            if (landmark && map.landmarks().at(*landmark).observations.size() >= 2) {
                out.insert(*landmark);
            }
        }
    }
    return out;
}

std::set<KeyframeId> outerKeyframes(const SlamMap& map, const std::set<KeyframeId>& window,
                                    const std::set<LandmarkId>& landmarks, unsigned maxFixed) {
    std::map<KeyframeId, unsigned> seen;
    for (const LandmarkId id : landmarks) {
        for (const auto& [keyframe, feature] : map.landmarks().at(id).observations) {
            if (window.count(keyframe) == 0) ++seen[keyframe];
        }
    }
    std::set<KeyframeId> out;
    for (const auto& [keyframe, count] : byCount(seen)) {
        if (out.size() >= maxFixed) break;
        out.insert(keyframe);
    }
    return out;
}

/// Odometry between neighbours where one of them has too few landmarks to stand alone. A neighbour
/// outside comes in as a fixed camera.
std::vector<std::pair<KeyframeId, KeyframeId>> weakPairs(const SlamMap& map,
                                                         const std::set<KeyframeId>& window,
                                                         const std::set<LandmarkId>& landmarks,
                                                         unsigned weakBelow) {
    const auto weak = [&](const map::Keyframe& kf) {
        unsigned n = 0;
        for (const auto& l : kf.landmarks) n += l && landmarks.count(*l) != 0 ? 1U : 0U;
        return n < weakBelow;
    };
    std::vector<std::pair<KeyframeId, KeyframeId>> out;
    for (const KeyframeId id : window) {
        const auto it = map.keyframes().find(id);
        const auto before = it == map.keyframes().begin() ? it : std::prev(it);
        if (before != it && before->second.segment == it->second.segment) {
            if (weak(it->second) || (window.count(before->first) != 0 && weak(before->second))) {
                out.emplace_back(before->first, id);
            }
        }
        const auto after = std::next(it);
        if (after != map.keyframes().end() && after->second.segment == it->second.segment &&
            window.count(after->first) == 0 && weak(it->second)) {
            out.emplace_back(id, after->first);
        }
    }
    return out;
}

/// Motions that scans measured between cameras of the problem.
void addScans(const SlamMap& map, const std::map<KeyframeId, std::size_t>& index,
              BackboneProblem& problem) {
    for (const auto& [id, b] : index) {
        const auto it = map.keyframes().find(id);
        const auto& motion = it->second.scanMotion;
        if (!motion) continue;
        auto from = it;
        while (from != map.keyframes().begin() && from->second.frame > motion->from) --from;
        const auto a = index.find(from->first);
        if (a == index.end() || from->second.frame != motion->from ||
            from->second.segment != it->second.segment ||
            (problem.cameras[a->second].fixed && problem.cameras[b].fixed)) {
            continue;
        }
        problem.scans.push_back({a->second, b, motion->T_from_cam, motion->information});
    }
}

}  // namespace

BackboneProblem backboneProblem(const SlamMap& map, const BackboneOptions& options,
                                unsigned windowSize, KeyframeId firstFree) {
    BackboneProblem problem;
    if (map.keyframes().size() < 2) return problem;
    const auto window = freeWindow(map, options, windowSize);
    const auto landmarks = landmarksOf(map, window);
    const auto weak = weakPairs(map, window, landmarks, options.weakBelow);
    auto cameras = outerKeyframes(map, window, landmarks, options.maxFixed);
    cameras.insert(window.begin(), window.end());
    for (const auto& [a, b] : weak) {
        cameras.insert(a);
        cameras.insert(b);
    }

    std::map<KeyframeId, std::size_t> index;
    const KeyframeId first = map.keyframes().begin()->first;
    bool anyFixed = false;
    for (const KeyframeId id : cameras) {
        const auto& kf = map.keyframes().at(id);
        const bool fixed = id == first || id < firstFree || window.count(id) == 0;
        anyFixed = anyFixed || fixed;
        index[id] = problem.cameras.size();
        problem.cameras.push_back({id, kf.camera, kf.T_world_cam, fixed});
    }
    if (!anyFixed) problem.cameras.front().fixed = true;

    for (const LandmarkId id : landmarks) {
        const auto& landmark = map.landmarks().at(id);
        const std::size_t before = problem.observations.size();
        for (const auto& [keyframe, feature] : landmark.observations) {
            const auto it = index.find(keyframe);
            if (it == index.end()) continue;
            problem.observations.push_back({it->second, problem.points.size(),
                                            map.keyframes().at(keyframe).features[feature]});
        }
        if (problem.observations.size() < before + 2) {
            problem.observations.resize(before);
            continue;
        }
        problem.points.push_back({id, landmark.p_world});
    }
    for (const auto& [a, b] : weak) {
        const auto& from = map.keyframes().at(a);
        const auto& to = map.keyframes().at(b);
        problem.odometry.push_back(
            {index.at(a), index.at(b), from.T_odom_cam.inverse() * to.T_odom_cam});
    }
    addScans(map, index, problem);
    return problem;
}

}  // namespace djpete::backend
