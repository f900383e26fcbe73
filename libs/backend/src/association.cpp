#include "djpete/backend/association.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "association_cost.h"
#include "djpete/map/object_rules.h"

namespace djpete::backend {

namespace {

using geometry::SE3;
using map::ObjectObservation;

/// Cost of leaving a thing without a detection; above any cost that the gate lets through.
constexpr double kUnassigned = 200;
/// New size = old + this share of the difference, once a few were averaged.
constexpr double kSizeMemory = 0.05;
/// Log-odds are kept within this, so that new evidence can turn them.
constexpr double kSurest = 12;
/// ... and within this for what was seen a few times only: that may be one error thrice.
constexpr double kSureOnce = 3.5, kSurePerHit = 1;
/// A thing with a speed along its heading of more than this says which end is its front.
constexpr double kRolling_mps = 2;
constexpr double kRollingOdds = 1;
/// The heading is turned once the odds against it are these.
constexpr double kTurnOdds = 2;
/// Share of the range of old clutter that a new frame replaces.
constexpr double kClutterMemory = 0.05;
/// What was found at some range should be found at this times as far.
constexpr double kFartherStill = 1.05;
/// Nearer than this nothing is wholly in view.
constexpr double kNearest_m = 4;
/// Of the place where detections may be: height and yaw modulo pi.
constexpr double kHeightSpan_m = 3;

double logOdds(double p) { return std::log(p / (1 - p)); }

/// Evidence on which end is the front; true if the thing should be turned round.
bool voteOnHeading(TrackedThing& thing, bool against, const AssociationOptions& options) {
    const double vote = logOdds(1 - options.headingFlips);
    double odds = thing.headingOdds + (against ? -vote : vote);
    if (!thing.filter.likelyStatic()) {
        const double yaw = thing.filter.yaw_rad();
        const auto v = thing.filter.velocity_mps();
        const double along = std::cos(yaw) * v.x() + std::sin(yaw) * v.y();
        if (std::abs(along) > kRolling_mps) odds += along > 0 ? kRollingOdds : -kRollingOdds;
    }
    thing.headingOdds = std::clamp(odds, -kSurest, kSurest);
    return thing.headingOdds < -kTurnOdds;
}

void hit(TrackedThing& thing, Seen& seen, const ObjectAssociator::Frame& frame,
         const AssociationOptions& options) {
    if (thing.hits > 0) {
        const bool against = opposite(seen.z.yaw_rad, thing.filter.yaw_rad());
        if (against) {
            seen.observation = map::turnedRound(std::move(seen.observation));
            seen.z.yaw_rad = geometry::wrapAngle(seen.z.yaw_rad + M_PI);
        }
        thing.filter.update(seen.z, options.filter);
        const double share = std::max(1.0 / (thing.hits + 1.0), kSizeMemory);
        thing.size_m += share * (seen.observation.size_m - thing.size_m);
        thing.headingWrong = voteOnHeading(thing, against, options);
    } else {
        thing.filter = ObjectFilter(seen.z, options.filter);
        thing.size_m = seen.observation.size_m;
        thing.objectClass = seen.observation.objectClass;
        thing.headingOdds = logOdds(1 - options.headingFlips);
    }
    ++thing.hits;
    ++thing.frames;
    thing.misses = 0;
    thing.lastSeen_s = frame.time_s;
    thing.lastBox = seen.observation.box;
    if (seen.observation.appearance) thing.looks = seen.observation.appearance;
    thing.anchor = frame.anchor;
    thing.T_world_anchor = frame.T_world_anchor;
    thing.waiting.push_back(std::move(seen.observation));
}

double rangeOf(const Seen& seen) { return seen.observation.T_cam_obj.translation().norm(); }

/// True if a detector that found it before should find it now: well within the image, not much
/// farther than ever, and not behind something that was detected.
bool inView(const ObjectAssociator::Frame& frame, const TrackedThing& thing,
            const std::vector<Seen>& seen) {
    const geometry::Vec3 p_cam = frame.T_world_cam.inverse() * thing.filter.p_world();
    const double range_m = p_cam.norm();
    if (p_cam.z() < kNearest_m || range_m > kFartherStill * thing.farthestHit_m) return false;
    if (!frame.camera) return true;
    const geometry::Vec2 uv = frame.camera->project(p_cam);
    const double half_px = 0.5 * frame.camera->fx * thing.size_m.y() / p_cam.z();
    if (!frame.camera->contains(uv) || uv.x() < half_px ||
        uv.x() > frame.camera->width_px - 1 - half_px) {
        return false;
    }
    return std::none_of(seen.begin(), seen.end(), [&](const Seen& s) {
        const auto& box = s.observation.box;
        return box && rangeOf(s) < range_m && double(box->left) <= uv.x() &&
               uv.x() <= double(box->right) && double(box->top) <= uv.y() &&
               uv.y() <= double(box->bottom);
    });
}

}  // namespace

bool ObjectAssociator::confirmed(const TrackedThing& thing) const {
    return thing.hits >= options_.minDetections && 2 * thing.hits >= thing.frames &&
           thing.existence >= logOdds(options_.sureEnough);
}

double ObjectAssociator::clutterDensity() const {
    const double area = options_.maxRange_m * options_.maxRange_m * M_PI / 4;
    return std::max(clutter_, options_.leastClutter) / (area * kHeightSpan_m * M_PI);
}

std::vector<uint64_t> ObjectAssociator::associate(const Frame& frame,
                                                  std::vector<ObjectObservation> detections) {
    std::vector<Seen> seen = prepare(frame, std::move(detections), options_);
    // Nothing is known of clutter in the first frame: anything in it may be some.
    if (clutterFrames_ == 0) clutter_ = static_cast<double>(seen.size());

    std::vector<TrackedThing*> things;
    std::vector<Candidate> candidates;
    for (auto& [key, thing] : things_) {
        thing.filter.predict(frame.time_s - thing.lastPredicted_s, options_.filter);
        thing.lastPredicted_s = frame.time_s;
        for (std::size_t j = 0; j < seen.size(); ++j) {
            if (const auto match = matchCost(thing, seen[j], options_)) {
                candidates.push_back({things.size(), j, *match});
            }
        }
        things.push_back(&thing);
    }
    const auto chosen = choose(candidates, things.size(), seen.size(), kUnassigned);

    std::set<uint64_t> hits;
    std::vector<bool> used(seen.size(), false);
    double clutter = 0;
    const double logClutter = std::log(clutterDensity());
    for (std::size_t i = 0; i < things.size(); ++i) {
        if (!chosen[i]) continue;
        TrackedThing& thing = *things[i];
        const Candidate& c = candidates[*chosen[i]];
        used[c.detection] = true;
        if (!thing.object) clutter += 1;
        const double surest = std::min(kSurest, kSureOnce + kSurePerHit * thing.hits);
        thing.existence = std::min(surest, thing.existence + c.match.logDensity - logClutter +
                                               std::log(options_.detectionRate) +
                                               scoreOdds(seen[c.detection].observation));
        thing.farthestHit_m = std::max(thing.farthestHit_m, rangeOf(seen[c.detection]));
        hit(thing, seen[c.detection], frame, options_);
        hits.insert(thing.key);
    }
    for (std::size_t i = 0; i < things.size(); ++i) {
        if (chosen[i]) continue;
        TrackedThing& thing = *things[i];
        ++thing.frames;
        ++thing.misses;
        if (!inView(frame, thing, seen)) continue;
        thing.existence =
            std::max(-kSurest, thing.existence + std::log(1 - options_.detectionRate));
    }
    clutter += beginNew(frame, seen, used, hits);
    // The mean of the first frames, so that it is known soon; then it fades.
    const double share = std::max(1 / static_cast<double>(++clutterFrames_), kClutterMemory);
    clutter_ += share * (clutter - clutter_);
    forget(frame.time_s);
    return {hits.begin(), hits.end()};
}

double ObjectAssociator::beginNew(const Frame& frame, std::vector<Seen>& seen,
                                  const std::vector<bool>& used, std::set<uint64_t>& hits) {
    std::vector<obs::UprightBox> taken;
    for (std::size_t j = 0; j < seen.size(); ++j) {
        if (used[j]) taken.push_back(seen[j].box);
    }
    double begun = 0;
    for (std::size_t j = 0; j < seen.size(); ++j) {
        if (used[j]) continue;
        const auto doubled = [&](const obs::UprightBox& box) {
            return obs::birdsEyeOverlap(box, seen[j].box) > options_.doubleOverlap;
        };
        if (std::any_of(taken.begin(), taken.end(), doubled)) {
            ++doubles_;
            continue;
        }
        taken.push_back(seen[j].box);
        begun += 1;
        TrackedThing thing;
        thing.key = nextKey_++;
        thing.lastPredicted_s = frame.time_s;
        thing.existence =
            std::log(options_.newPerFrame / std::max(clutter_, options_.leastClutter)) +
            scoreOdds(seen[j].observation);
        thing.farthestHit_m = rangeOf(seen[j]);
        hit(thing, seen[j], frame, options_);
        hits.insert(thing.key);
        things_.emplace(thing.key, std::move(thing));
    }
    return begun;
}

std::vector<uint64_t> ObjectAssociator::ghosts() const {
    std::vector<uint64_t> out;
    for (const auto& [key, thing] : things_) {
        if (thing.object && thing.hits <= options_.ghostDetections &&
            thing.existence < logOdds(1 - options_.sureEnough)) {
            out.push_back(key);
        }
    }
    return out;
}

double ObjectAssociator::scoreOdds(const ObjectObservation& o) const {
    if (options_.scoreSlope <= 0) return 0;
    return std::clamp(options_.scoreSlope * (static_cast<double>(o.score) - options_.evenScore),
                      -options_.maxScoreOdds, options_.maxScoreOdds);
}

void ObjectAssociator::forget(double time_s) {
    for (auto it = things_.begin(); it != things_.end();) {
        const TrackedThing& t = it->second;
        const bool lost =
            t.object ? !t.filter.likelyStatic() && time_s - t.lastSeen_s > options_.maxOcclusion_s
                     : t.misses > options_.maxMisses;
        it = lost ? things_.erase(it) : std::next(it);
    }
}

void ObjectAssociator::follow(const std::function<SE3(map::KeyframeId)>& T_world_anchor) {
    for (auto& [key, thing] : things_) {
        const SE3 now = T_world_anchor(thing.anchor);
        if (now.matrix() == thing.T_world_anchor.matrix()) continue;
        thing.filter.transform(now * thing.T_world_anchor.inverse());
        thing.T_world_anchor = now;
    }
}

void ObjectAssociator::turnRound(uint64_t key) {
    auto& thing = things_.at(key);
    thing.filter.turnRound();
    thing.headingOdds = std::abs(thing.headingOdds);
    thing.headingWrong = false;
    for (auto& o : thing.waiting) o = map::turnedRound(std::move(o));
}

}  // namespace djpete::backend
