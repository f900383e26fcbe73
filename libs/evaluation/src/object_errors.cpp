#include "djpete/evaluation/object_errors.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>

#include "label_tracks.h"
#include "object_identity.h"

namespace djpete::evaluation {

using geometry::SE3;
using geometry::Vec3;

namespace {

constexpr double kRadToDeg = 180.0 / M_PI;
using Tracks = std::map<int64_t, LabelTrack>;

/// A row of the map that lies on a labelled box.
struct Match {
    const ObjectRow* row = nullptr;
    const LabelTrack* track = nullptr;
    double distance_m = 0;
    bool paired = false;  ///< one to one; else a further object at the same box
};

double distanceFromAbove(const SE3& a, const SE3& b) {
    return (a.translation() - b.translation()).head<2>().norm();
}

/// Whether an object of this class may be one of the wanted: the kinds of vehicle are easily
/// mistaken for each other, and Other may be anything.
bool comparable(obs::ObjectClass c, const std::set<obs::ObjectClass>& wanted) {
    if (wanted.count(c) > 0 || c == obs::ObjectClass::Other) return true;
    return obs::isVehicle(c) && std::any_of(wanted.begin(), wanted.end(), obs::isVehicle);
}

/// Candidates of one frame within the gate, nearest first.
std::vector<Match> candidatesInFrame(std::size_t frame, const std::vector<const ObjectRow*>& rows,
                                     const Tracks& tracks, double gate_m) {
    std::vector<Match> candidates;
    for (const auto* row : rows) {
        for (const auto& [id, track] : tracks) {
            const auto box = track.boxes.find(frame);
            if (box == track.boxes.end()) continue;
            const double d = distanceFromAbove(row->T_world_obj, box->second.T_world_obj);
            if (d < gate_m) candidates.push_back({row, &track, d, false});
        }
    }
    std::sort(candidates.begin(), candidates.end(), [](const Match& a, const Match& b) {
        return std::tie(a.distance_m, a.row->objectId, a.track->trackId) <
               std::tie(b.distance_m, b.row->objectId, b.track->trackId);
    });
    return candidates;
}

/// Greedy one-to-one pairs of wanted boxes; then the rest vote: for wanted boxes, then for others.
void matchFrame(const std::vector<Match>& candidates, std::vector<Match>& matches) {
    std::set<int64_t> usedObjects, usedTracks;
    for (const Match& c : candidates) {
        if (!c.track->wanted || usedObjects.count(c.row->objectId) > 0) continue;
        if (!usedTracks.insert(c.track->trackId).second) continue;
        usedObjects.insert(c.row->objectId);
        matches.push_back({c.row, c.track, c.distance_m, true});
    }
    for (const bool wanted : {true, false}) {
        for (const Match& c : candidates) {
            if (c.track->wanted != wanted) continue;
            if (usedObjects.insert(c.row->objectId).second) matches.push_back(c);
        }
    }
}

std::vector<Match> matchAll(const std::vector<const ObjectRow*>& rows, const Tracks& tracks,
                            double gate_m) {
    std::map<std::size_t, std::vector<const ObjectRow*>> byFrame;
    for (const auto* row : rows) byFrame[row->frame].push_back(row);
    std::vector<Match> matches;
    for (const auto& [frame, inFrame] : byFrame) {
        matchFrame(candidatesInFrame(frame, inFrame, tracks, gate_m), matches);
    }
    return matches;
}

/// The track each object belongs to: most votes, then nearest, wanted tracks before others.
std::map<int64_t, int64_t> ownersOf(const std::vector<Match>& matches) {
    struct Votes {
        bool wanted = false;
        int count = 0;
        double sum_m = 0;
    };
    std::map<int64_t, std::map<int64_t, Votes>> votes;
    for (const auto& m : matches) {
        Votes& v = votes[m.row->objectId][m.track->trackId];
        v.wanted = m.track->wanted;
        ++v.count;
        v.sum_m += m.distance_m;
    }
    std::map<int64_t, int64_t> owners;
    for (const auto& [objectId, perTrack] : votes) {
        const auto best =
            std::max_element(perTrack.begin(), perTrack.end(), [](const auto& a, const auto& b) {
                const Votes &x = a.second, &y = b.second;
                return std::make_tuple(x.wanted, x.count, -x.sum_m / x.count) <
                       std::make_tuple(y.wanted, y.count, -y.sum_m / y.count);
            });
        owners[objectId] = best->first;
    }
    return owners;
}

/// Whether a label would exist if there really were something.
bool wouldBeLabelled(const ObjectRow& row, const CameraPath& cameras,
                     const ObjectCriteria& criteria) {
    const Vec3 p_cam = cameras.at(row.frame).inverse() * row.T_world_obj.translation();
    if (criteria.maxRange_m && horizontalRange(p_cam) > *criteria.maxRange_m) return false;
    return kRadToDeg * std::abs(std::atan2(p_cam.x(), p_cam.z())) < criteria.halfFieldOfView_deg;
}

/// Mean time from one frame to the next as the rows tell it.
std::optional<double> framePeriod(const std::vector<const ObjectRow*>& rows) {
    std::map<std::size_t, double> timeOfFrame;
    for (const auto* row : rows) {
        if (row->time_s) timeOfFrame.emplace(row->frame, *row->time_s);
    }
    if (timeOfFrame.size() < 2) return std::nullopt;
    const auto first = timeOfFrame.begin();
    const auto last = std::prev(timeOfFrame.end());
    const double period_s =
        (last->second - first->second) / static_cast<double>(last->first - first->first);
    if (period_s <= 0) return std::nullopt;
    return period_s;
}

/// Error samples, of one track or of all.
struct Samples {
    std::vector<double> centre, bev, yaw, yawModPi, length, width, height, velocity;

    void add(const Match& m, const std::optional<double>& framePeriod_s) {
        const PlacedBox& box = m.track->boxes.at(m.row->frame);
        const SE3 T_label_obj = box.T_world_obj.inverse() * m.row->T_world_obj;
        centre.push_back(T_label_obj.translation().norm());
        bev.push_back(m.distance_m);
        const double angle = kRadToDeg * std::abs(T_label_obj.yaw_rad());
        yaw.push_back(angle);
        yawModPi.push_back(std::min(angle, 180 - angle));
        const Vec3 size = (m.row->size_m - box.size_m).cwiseAbs();
        length.push_back(size.x());
        width.push_back(size.y());
        height.push_back(size.z());
        if (!m.track->moving || !framePeriod_s) return;
        const auto v_world = m.track->velocityAt(m.row->frame, *framePeriod_s);
        if (v_world) velocity.push_back((m.row->velocity_world - *v_world).norm());
    }
};

TrackErrors describeTrack(const LabelTrack& track, const std::vector<int64_t>& objectIds,
                          const Samples& samples) {
    TrackErrors out;
    out.trackId = track.trackId;
    out.objectClass = track.objectClass;
    out.labelledFrames = track.framesInRange;
    out.moving = track.moving;
    out.objectIds = objectIds;
    out.matchedRows = samples.centre.size();
    out.centre_m = quantile(samples.centre, 0.5);
    out.bev_m = quantile(samples.bev, 0.5);
    out.yaw_deg = quantile(samples.yaw, 0.5);
    out.yawModPi_deg = quantile(samples.yawModPi, 0.5);
    return out;
}

/// Adds how well each track keeps its object.
void addIdentities(ObjectErrors& out, const std::vector<Match>& matches, const Tracks& tracks,
                   std::size_t minGapFrames) {
    std::map<int64_t, std::map<std::size_t, int64_t>> objectOfFrame;  // by track
    for (const auto& m : matches) {
        if (!m.paired || !m.track->boxes.at(m.row->frame).inRange) continue;
        objectOfFrame[m.track->trackId][m.row->frame] = m.row->objectId;
    }
    for (auto& track : out.tracks) {
        const auto& objects = objectOfFrame[track.trackId];
        const ObjectIdentity identity = identityOf(tracks.at(track.trackId), objects, minGapFrames);
        track.switches = identity.switches;
        track.seenAgain = identity.seenAgain;
        track.knownAgain = identity.knownAgain;
        out.withoutSwitch += !objects.empty() && identity.switches == 0 ? 1 : 0;
        out.switches += identity.switches;
        out.seenAgain += identity.seenAgain;
        out.knownAgain += identity.knownAgain;
    }
}

void summariseInto(ObjectErrors& out, const Samples& all) {
    out.centre_m = summarise(all.centre);
    out.bev_m = summarise(all.bev);
    out.yaw_deg = summarise(all.yaw);
    out.yawModPi_deg = summarise(all.yawModPi);
    out.length_m = summarise(all.length);
    out.width_m = summarise(all.width);
    out.height_m = summarise(all.height);
    out.velocity_mps = summarise(all.velocity);
}

}  // namespace

ObjectErrors evaluateObjects(const std::vector<ObjectRow>& objects,
                             const std::vector<LabelBox>& labels, const CameraPath& cameras,
                             const CameraPath& motionCameras, const ObjectCriteria& criteria) {
    const Tracks tracks = placeLabels(labels, cameras, motionCameras, criteria);
    std::vector<const ObjectRow*> rows;
    for (const auto& row : objects) {
        if (cameras.contains(row.frame) && comparable(row.objectClass, criteria.classes)) {
            rows.push_back(&row);
        }
    }
    const auto matches = matchAll(rows, tracks, criteria.gate_m);
    const auto owners = ownersOf(matches);
    const auto period_s = framePeriod(rows);

    Samples all;
    std::map<int64_t, Samples> perTrack;
    for (const auto& m : matches) {
        const bool own = owners.at(m.row->objectId) == m.track->trackId;
        if (!m.paired || !own || !m.track->counted) continue;
        if (!m.track->boxes.at(m.row->frame).inRange) continue;
        all.add(m, period_s);
        perTrack[m.track->trackId].add(m, period_s);
    }

    ObjectErrors out;
    summariseInto(out, all);
    std::map<int64_t, std::vector<int64_t>> objectsOfTrack;
    for (const auto& [objectId, trackId] : owners) objectsOfTrack[trackId].push_back(objectId);
    for (const auto& [id, track] : tracks) {
        if (!track.counted) continue;
        const auto& ids = objectsOfTrack[id];
        ++out.labelled;
        ++(ids.empty() ? out.missed : ids.size() == 1 ? out.matchedOneToOne : out.duplicated);
        out.tracks.push_back(describeTrack(track, ids, perTrack[id]));
    }
    addIdentities(out, matches, tracks, criteria.minGapFrames);
    std::set<int64_t> falseIds;
    for (const auto* row : rows) {
        if (owners.count(row->objectId) == 0 && wouldBeLabelled(*row, cameras, criteria)) {
            falseIds.insert(row->objectId);
        }
    }
    out.falseObjectIds.assign(falseIds.begin(), falseIds.end());
    return out;
}

}  // namespace djpete::evaluation
