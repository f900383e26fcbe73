#include "convoy.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "actor_body.h"
#include "boxes.h"
#include "noise.h"

namespace djpete::simulator {
namespace {

using geometry::SE3;
using geometry::Vec3;

constexpr int kWidth_px = 62, kHeight_px = 19;  // of the image that shares are measured in
constexpr double kStep_m = 2.0;                 // between the places of the way that count
using Mask = std::bitset<kWidth_px * kHeight_px>;

/// A place with what it covers of the image, at each step of the way.
struct Candidate {
    ConvoyPlace place;
    std::vector<Mask> masks;
};

/// True if a ray from the origin of the box's frame meets the box.
bool meets(const Vec3& from, const Vec3& direction, const Vec3& half) {
    double enter = 0.5, leave = 80;
    for (int k = 0; k < 3; ++k) {
        const double a = (-half[k] - from[k]) / direction[k],
                     b = (half[k] - from[k]) / direction[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter < leave;
}

class Planner {
  public:
    Planner(const Route& route, const WorldOptions& options)
        : path_(route.path), options_(options), camera_(rigCamera(kWidth_px, kHeight_px)) {
        if (options.T_first_cam.empty()) {  // the way is longer than the drive
            for (double s = 0; s < path_.length_m(); s += kStep_m)
                steps_.push_back({s, path_.poseAt(s, options.laneOffset_m)});
            return;
        }
        const std::size_t stride = 1 + route.frames / 500;
        for (std::size_t f = 0; f < route.frames; f += stride) {
            const SE3& T = route.T_world_vehicle[f];
            const Vec3 foot(T.translation().x(), T.translation().y(), 0);
            steps_.push_back({route.path_m[f], SE3::fromYaw(T.yaw_rad(), foot)});
        }
    }

    std::vector<ConvoyPlace> plan() const {
        const auto leads = leadCandidates(), besides = besideCandidates();
        struct Formation {
            std::vector<const Candidate*> who;
            double miss;
        };
        std::vector<Formation> all;
        std::map<std::pair<const Candidate*, const Candidate*>, bool> known;
        const auto consider = [&](const std::vector<const Candidate*>& who) {
            for (std::size_t i = 0; i < who.size(); ++i) {
                for (std::size_t k = 0; k < i; ++k) {
                    const auto [pair, isNew] = known.insert({{who[i], who[k]}, false});
                    if (isNew) pair->second = apart(who[i]->place, who[k]->place);
                    if (!pair->second) return;
                }
            }
            all.push_back({who, std::abs(share(who) - options_.convoyShare)});
        };
        for (const auto& lead : leads) {
            consider({&lead});
            for (const auto& a : besides) {
                consider({&lead, &a});
                for (const auto& b : besides)
                    if (b.place.type == ActorType::Car && b.place.ahead_m > a.place.ahead_m + 7)
                        consider({&lead, &a, &b});
            }
        }
        if (all.empty()) return {};
        const auto best = std::min_element(
            all.begin(), all.end(), [](const auto& a, const auto& b) { return a.miss < b.miss; });
        // Of those that are about as good, the fullest ones; chance chooses among them.
        const double enough = std::max(best->miss, 0.008);
        std::size_t most = 0;
        for (const auto& f : all)
            if (f.miss <= enough) most = std::max(most, f.who.size());
        std::vector<const Formation*> good;
        for (const auto& f : all)
            if (f.miss <= enough && f.who.size() == most) good.push_back(&f);
        std::vector<ConvoyPlace> out;
        for (const auto* c : good[hash(driveSeed(options_), 440U) % good.size()]->who)
            out.push_back(c->place);
        return out;
    }

  private:
    /// The own vehicle somewhere on its way, on the plane.
    struct Step {
        double s_m;
        SE3 T_world_own;
    };

    std::optional<Candidate> candidate(const BodyKind& body, double ahead_m, bool fromCamera,
                                       double left_m) const {
        Actor actor;
        actor.type = body.type;
        actor.kind = body.kind;
        actor.seed = hash(driveSeed(options_), 441U, body.kind, left_m > 0 ? 1U : 0U);
        Candidate c;
        c.place = {body.type, body.kind, actor.seed, bodySize(actor), ahead_m, left_m};
        if (fromCamera)
            c.place.ahead_m += T_vehicle_camera().translation().x() + 0.5 * c.place.size_m.x();
        constexpr double kRoom_m = 0.35;
        const Vec3 own_m(4.4, 1.8, 1.5);
        for (const auto& step : steps_) {
            if (gapBetween(step.T_world_own, own_m, at(c.place, step.s_m), c.place.size_m) <
                kRoom_m)
                return {};
        }
        for (const auto& step : steps_) c.masks.push_back(maskOf(c.place, step));
        return c;
    }

    std::vector<Candidate> leadCandidates() const {
        std::vector<Candidate> out;
        for (const auto& body : kVehicleBodies)
            if (body.type != ActorType::Car)
                for (double gap_m : {9.5, 8.5, 7.5})
                    if (auto c = candidate(body, gap_m, true, 0)) out.push_back(std::move(*c));
        return out;
    }

    std::vector<Candidate> besideCandidates() const {
        // Clear of the own lane and of those who come along the left kerb.
        const double left_m = 3.0 + 0.5 * std::max(0.0, options_.laneOffset_m);
        std::vector<Candidate> out;
        for (const auto& body : kVehicleBodies) {
            if (body.type == ActorType::Car && body.kind > 2) continue;
            for (double ahead_m : {4.0, 5.5, 7.0, 9.0, 14.0, 18.0})
                if (auto c = candidate(body, ahead_m, false, left_m)) out.push_back(std::move(*c));
        }
        return out;
    }

    SE3 at(const ConvoyPlace& place, double s) const {
        return path_.poseAt(s + place.ahead_m, place.left_m);
    }

    /// Two who would not touch each other while they sway.
    bool apart(const ConvoyPlace& a, const ConvoyPlace& b) const {
        const bool sameLane = a.left_m == b.left_m;
        for (const auto& step : steps_)
            if (gapBetween(at(a, step.s_m), a.size_m, at(b, step.s_m), b.size_m) <
                (sameLane ? 2.5 : 0.35))
                return false;
        return true;
    }

    Mask maskOf(const ConvoyPlace& place, const Step& step) const {
        constexpr double kCameraHeight_m = 1.73;
        const SE3 T_world_cam = step.T_world_own *
                                SE3(geometry::Mat3::Identity(), Vec3(0, 0, kCameraHeight_m)) *
                                T_vehicle_camera();
        const SE3 T_obj_cam = (at(place, step.s_m) *
                               SE3(geometry::Mat3::Identity(), Vec3(0, 0, 0.5 * place.size_m.z())))
                                  .inverse() *
                              T_world_cam;
        // A car fills less of its box than a van does.
        const bool car = place.type == ActorType::Car;
        const Vec3 half =
            0.5 * place.size_m.cwiseProduct(car ? Vec3(0.94, 0.94, 0.88) : Vec3(0.98, 0.96, 0.96));
        Mask mask;
        for (int v = 0; v < kHeight_px; ++v) {
            for (int u = 0; u < kWidth_px; ++u) {
                const Vec3 d((u - camera_.cx) / camera_.fx, (v - camera_.cy) / camera_.fy, 1);
                if (meets(T_obj_cam.translation(), T_obj_cam.rotation() * d, half))
                    mask.set(static_cast<std::size_t>(v * kWidth_px + u));
            }
        }
        return mask;
    }

    static double share(const std::vector<const Candidate*>& who) {
        std::size_t pixels = 0;
        const std::size_t steps = who.front()->masks.size();
        for (std::size_t i = 0; i < steps; ++i) {
            Mask all;
            for (const auto* c : who) all |= c->masks[i];
            pixels += all.count();
        }
        // Bodies are rounder than boxes; measured over drives of 200 frames.
        constexpr double kBodyShare = 0.9;
        return kBodyShare * static_cast<double>(pixels) /
               static_cast<double>(steps * Mask().size());
    }

    const Street& path_;
    const WorldOptions& options_;
    std::vector<Step> steps_;
    geometry::StereoCamera camera_;
};

}  // namespace

std::vector<ConvoyPlace> planConvoy(const Route& route, const WorldOptions& options) {
    if (options.convoyShare <= 0) return {};
    auto places = Planner(route, options).plan();
    if (places.empty()) {
        std::ostringstream o;
        o << "--convoy " << options.convoyShare
          << ": expected a way on which a van fits 7 to 10 m before the camera everywhere; this "
             "one turns too sharply";
        throw std::runtime_error(o.str());
    }
    return places;
}

}  // namespace djpete::simulator
