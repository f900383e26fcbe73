#include "object_keeper.h"

#include <chrono>
#include <cmath>
#include <utility>

#include "djpete/map/object_rules.h"
#include "djpete/obs/overlap.h"
#include "track_stitching.h"

namespace djpete::backend {

namespace {

using geometry::SE3;
using map::FrameId;
using map::KeyframeId;
using map::ObjectId;
using map::ObjectObservation;
using map::ObjectState;
using map::ObjectTrack;
using map::SlamMap;

/// Moving objects that overlapped in this many common frames, and in all of those, are one.
constexpr unsigned kCommonFrames = 2;
/// Objects that are solved once more with each job.
constexpr unsigned kAgainPerJob = 4;

double seconds(const SlamMap& map, const map::FramePose& pose) {
    const auto since = pose.stamp - map.frames().begin()->second.stamp;
    return std::chrono::duration<double>(since).count();
}

/// As measured, until the next solve.
ObjectState measuredState(const SlamMap& map, const ObjectObservation& o) {
    const auto& pose = map.frames().at(o.frame);
    ObjectState state;
    state.frame = o.frame;
    state.anchor = pose.reference;
    state.T_anchor_obj = pose.T_ref_cam * o.T_cam_obj;
    state.covariance = (o.information + 0.01 * geometry::Mat6::Identity()).inverse();
    return state;
}

/// At a new frame: a standing object is where it was, a moving one where it is measured.
ObjectState nextState(const SlamMap& map, const ObjectTrack& track, const ObjectObservation& o) {
    ObjectState state = measuredState(map, o);
    if (track.states.empty()) return state;
    const ObjectState& last = track.states.rbegin()->second;
    if (track.moving) {
        state.twist = last.twist;
        return state;
    }
    state = last;
    state.frame = o.frame;
    return state;
}

obs::UprightBox boxAt(const SlamMap& map, const ObjectTrack& track, const ObjectState& state) {
    return obs::uprightBox(map.T_world_obj(state), track.size_m);
}

uint32_t worldOf(const SlamMap& map, const ObjectTrack& track) {
    return map.keyframes().at(track.states.rbegin()->second.anchor).world;
}

bool sameThing(const SlamMap& map, const ObjectTrack& a, const ObjectTrack& b,
               double mergeOverlap) {
    if (a.states.empty() || b.states.empty()) return false;
    if (worldOf(map, a) != worldOf(map, b)) return false;
    if (!a.moving && !b.moving) {
        return obs::birdsEyeOverlap(boxAt(map, a, a.states.rbegin()->second),
                                    boxAt(map, b, b.states.rbegin()->second)) > mergeOverlap;
    }
    unsigned common = 0;
    for (const auto& [frame, state] : a.states) {
        const auto other = b.states.find(frame);
        if (other == b.states.end()) continue;
        if (obs::birdsEyeOverlap(boxAt(map, a, state), boxAt(map, b, other->second)) <=
            mergeOverlap) {
            return false;
        }
        ++common;
    }
    return common >= kCommonFrames;
}

}  // namespace

std::optional<uint64_t> ObjectKeeper::keyOf(ObjectId object) const {
    for (const auto& [key, thing] : associator_.things()) {
        if (thing.object == object) return key;
    }
    return std::nullopt;
}

void ObjectKeeper::adopt(const SlamMap& map) {
    for (const auto& [id, track] : map.objects()) solved_.insert(id);
}

void ObjectKeeper::observe(SlamMap& map, FrameId frame, std::vector<ObjectObservation> detections,
                           BackendStatistics& statistics) {
    const auto& pose = map.frames().at(frame);
    ObjectAssociator::Frame at;
    at.frame = frame;
    at.time_s = seconds(map, pose);
    at.anchor = pose.reference;
    at.T_world_anchor = map.keyframes().at(pose.reference).T_world_cam;
    at.T_world_cam = at.T_world_anchor * pose.T_ref_cam;
    const auto& camera = map.keyframes().at(pose.reference).camera;
    if (camera.valid() && camera.width_px > 0) at.camera = camera;
    std::vector<uint64_t> wrong;
    for (const uint64_t key : associator_.associate(at, std::move(detections))) {
        TrackedThing& thing = associator_.thing(key);
        if (thing.headingWrong) wrong.push_back(key);
        ++statistics.detectionsMatched;
        if (!thing.object) {
            if (associator_.confirmed(thing)) confirm(map, thing, statistics);
            continue;
        }
        for (auto& o : thing.waiting) {
            const auto state = nextState(map, map.objects().at(*thing.object), o);
            map.addObservation(*thing.object, std::move(o), state);
        }
        thing.waiting.clear();
        due_.insert(*thing.object);
    }
    for (const uint64_t key : wrong) {
        const auto object = associator_.thing(key).object;
        if (object) {
            turnRound(map, *object, statistics);
        } else {
            associator_.turnRound(key);
        }
    }
    for (const uint64_t key : associator_.ghosts()) {
        remove(map, *associator_.thing(key).object);
        associator_.remove(key);
        ++statistics.objectsRemoved;
    }
    statistics.rejected["detection that doubles another one"] = associator_.doubles();
    if (associator_.doubles() == 0) statistics.rejected.erase("detection that doubles another one");
}

void ObjectKeeper::remove(SlamMap& map, ObjectId object) {
    map.removeObject(object);
    due_.erase(object);
    again_.erase(object);
    solved_.erase(object);
    changed_.erase(object);
    ++epochs_[object];
}

void ObjectKeeper::confirm(SlamMap& map, TrackedThing& thing, BackendStatistics& statistics) {
    ObjectTrack track;
    track.objectClass = thing.objectClass;
    track.size_m = thing.size_m;
    const ObjectId id = map.addObject(std::move(track));
    for (auto& o : thing.waiting) {
        const auto state = measuredState(map, o);
        map.addObservation(id, std::move(o), state);
    }
    thing.waiting.clear();
    thing.object = id;
    due_.insert(id);
    ++statistics.objectsCreated;
}

void ObjectKeeper::solveAgain(const SlamMap& map) {
    for (const auto& [id, track] : map.objects()) again_.insert(id);
}

ObjectProblem ObjectKeeper::problem(const SlamMap& map, bool all) {
    for (unsigned n = 0; n < kAgainPerJob && !again_.empty(); ++n) {
        const ObjectId id = *again_.begin();
        again_.erase(again_.begin());
        if (map.objects().count(id) != 0) due_.insert(id);
    }
    if (all) {
        for (const auto& [id, track] : map.objects()) due_.insert(id);
    }
    ObjectProblem problem;
    problem.all = all;
    for (const ObjectId id : due_) {
        const auto& track = map.objects().at(id);
        ObjectProblem::Object object;
        object.id = id;
        object.epoch = epochs_[id];
        object.moving = track.moving;
        object.objectClass = track.objectClass;
        for (const auto& [frame, o] : track.observations) {
            const auto& pose = map.frames().at(frame);
            const auto& keyframe = map.keyframes().at(pose.reference);
            ObjectProblem::Edge edge;
            edge.frame = frame;
            edge.time_s = seconds(map, pose);
            edge.anchor = pose.reference;
            edge.T_world_anchor = keyframe.T_world_cam;
            edge.up_world =
                (keyframe.T_world_cam * keyframe.T_vehicle_cam.inverse()).rotation().col(2);
            if (const auto state = track.states.find(frame); state != track.states.end()) {
                edge.T_world_obj = map.T_world_obj(state->second);
                edge.twist = state->second.twist;
            }
            edge.T_world_cam = edge.T_world_anchor * pose.T_ref_cam;
            edge.T_cam_obj = o.T_cam_obj;
            edge.information = o.information;
            edge.size_m = o.size_m;
            edge.points = o.points;
            object.edges.push_back(edge);
        }
        problem.objects.push_back(std::move(object));
    }
    due_.clear();
    return problem;
}

void ObjectKeeper::merge(SlamMap& map, const ObjectUpdate& update, BackendStatistics& statistics) {
    for (const auto& u : update.objects) {
        const auto it = map.objects().find(u.id);
        if (it == map.objects().end() || u.epoch != epochs_[u.id]) continue;
        if (!u.solved) {
            ++statistics.objectSolveFailures;
            continue;
        }
        ++statistics.objectSolves;
        solved_.insert(u.id);
        changed_.insert(u.id);
        const ObjectTrack& track = it->second;
        std::map<FrameId, ObjectState> states;
        if (u.moving) {
            states = track.states;
            const FrameId newest = u.states.back().frame;
            for (const auto& [frame, o] : track.observations) {
                if (frame > newest) states[frame] = measuredState(map, o);
            }
            for (const auto& s : u.states) states[s.frame] = s;
        } else {
            ObjectState state = u.states.back();
            for (const auto& [frame, o] : track.observations) {
                state.frame = frame;
                states[frame] = state;
            }
        }
        map.setObjectEstimate(u.id, u.moving, u.size_m, std::move(states), u.views);
        if (u.turnRound) turnRound(map, u.id, statistics);
    }
}

void ObjectKeeper::turnRound(SlamMap& map, ObjectId object, BackendStatistics& statistics) {
    map.setObject(map::turnedRound(map.objects().at(object)));
    if (const auto key = keyOf(object)) associator_.turnRound(*key);
    ++epochs_[object];
    ++statistics.headingsFlipped;
}

bool ObjectKeeper::mergeDoubles(SlamMap& map, BackendStatistics& statistics) {
    bool any = false;
    // Only what changed can have become a double.
    const auto changed = std::exchange(changed_, {});
    for (const auto& s : stitches(map, changed, options_)) {
        join(map, s.earlier, s.later);
        ++statistics.objectsMerged;
        any = true;
    }
    for (const ObjectId id : changed) {
        const auto a = map.objects().find(id);
        if (a == map.objects().end()) continue;
        for (const auto& [other, b] : map.objects()) {
            if (other == id || solved_.count(other) == 0 ||
                obs::isVehicle(a->second.objectClass) != obs::isVehicle(b.objectClass) ||
                !sameThing(map, a->second, b, associator_.options().mergeOverlap)) {
                continue;
            }
            join(map, std::min(id, other), std::max(id, other));
            ++statistics.objectsMerged;
            any = true;
            break;  // the one that is left is due for a solve, and looked at again after it
        }
    }
    return any;
}

void ObjectKeeper::join(SlamMap& map, ObjectId kept, ObjectId gone) {
    const ObjectTrack& a = map.objects().at(kept);
    ObjectTrack b = map.objects().at(gone);
    const double yawA = map.T_world_obj(a.states.rbegin()->second).yaw_rad();
    // Where the one follows the other, its beginning; else where both are last.
    const bool follows = a.states.rbegin()->first < b.states.begin()->first;
    const auto& stateB = follows ? b.states.begin()->second : b.states.rbegin()->second;
    const double yawB = map.T_world_obj(stateB).yaw_rad();
    const bool opposite = std::abs(geometry::wrapAngle(yawA - yawB)) > M_PI / 2;
    if (opposite) b = map::turnedRound(std::move(b));
    map.setObject(map::merged(a, b));
    remove(map, gone);
    joined_[gone] = kept;
    ++epochs_[kept];
    due_.insert(kept);

    const auto keyA = keyOf(kept), keyB = keyOf(gone);
    if (!keyB) return;
    const bool laterB =
        !keyA || associator_.thing(*keyA).lastSeen_s < associator_.thing(*keyB).lastSeen_s;
    if (!laterB) {
        associator_.remove(*keyB);
        return;
    }
    if (keyA) associator_.remove(*keyA);
    associator_.thing(*keyB).object = kept;
    if (opposite) associator_.turnRound(*keyB);
}

void ObjectKeeper::follow(const SlamMap& map) {
    associator_.follow([&map](KeyframeId id) -> SE3 { return map.keyframes().at(id).T_world_cam; });
}

}  // namespace djpete::backend
