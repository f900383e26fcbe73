#include "albedo.h"

#include <algorithm>
#include <cmath>

#include "paint.h"
#include "parallel_objects.h"
#include "point_grid.h"
#include "vectors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;

constexpr std::size_t kSunObjects = 24, kSunPoints = 120, kSunCandidates = 40;
constexpr std::size_t kPaintPoints = 400, kPaintCandidates = 150, kLeastPoints = 100;
constexpr std::size_t kNeighbours = 1500;  // of an object, for the brightness around a point
constexpr double kAround_m = 0.5, kAlike_cos = 0.5, kBrightQuantile = 0.8;
constexpr double kDarkShare = 0.5;    // of the brightness around, below which parts are dark
constexpr double kDarkPaint = 0.08;   // albedo of paints beside which dark parts do not show
constexpr double kNotPaint = 0.065;   // misfit: certainly no paint
constexpr double kStillPaint = 0.09;  // misfit, with gleam and half shadow allowed
constexpr double kDarkAlbedo = 0.03;  // of glass (what is behind it), rubber and grilles
constexpr double kMostAlbedo = 0.75, kLeastAlbedo = 0.005;
constexpr double kSunAround_m = 1;      // panes are about as wide
constexpr double kSunnyPlace = 0.12;    // of the surface around is paint in the sun
constexpr double kPlainlyPaint = 0.05;  // misfit
constexpr double kBelt = 0.52, kRoof = 0.97,
                 kRoof_cos = 0.85;  // panes are between, share of height
constexpr double kGleamCost = 0.2, kHalfShadowCost = 0.01;

bool isSeen(const ObjectModel& m, std::size_t i) {
    return m.colours[i].count > 0 && (m.flags[i] & flag::kInferredColour) == 0;
}

/// Mean place of the cameras that saw the point.
Vec3 cameraOf(const LitObject& object, std::size_t i) {
    Vec3 sum(0, 0, 0);
    double count = 0;
    for (std::size_t k = 0; k < object.cameras_obj.size(); ++k) {
        if ((object.model->seenIn[i] >> k & 1U) == 0) continue;
        sum += object.cameras_obj[k];
        count += 1;
    }
    if (count == 0) return vec3(object.model->point(i)) + vec3(object.model->normals[i]);
    return sum / count;
}

LitPoint litPoint(const LitObject& object, const Daylight& day, double gamma, double scale,
                  std::size_t i) {
    const ObjectModel& m = *object.model;
    const Vec3 normal = object.R_world_obj * vec3(m.normals[i]);
    const Vec3 towards = object.R_world_obj * (cameraOf(object, i) - vec3(m.point(i))).normalized();
    LitPoint out;
    out.light = illuminationOf(day, normal, towards);
    out.seen = lightOf(m.colours[i].mean, gamma);
    constexpr double kNearlyClipped = 0.96;
    for (double& c : out.seen) {
        c = c >= kNearlyClipped * object.clipped ? 1 : std::min(1.0, c / scale);
    }
    return out;
}

/// Every n-th seen point, at most about `most`.
std::vector<LitPoint> someOf(const LitObject& object, const Daylight& day, double gamma,
                             std::size_t most) {
    const ObjectModel& m = *object.model;
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (isSeen(m, i)) seen.push_back(i);
    }
    const double scale = localScale(day, object.ring);
    std::vector<LitPoint> out;
    const std::size_t step = std::max<std::size_t>(1, seen.size() / most);
    for (std::size_t k = 0; k < seen.size(); k += step) {
        out.push_back(litPoint(object, day, gamma, scale, seen[k]));
    }
    return out;
}

Vec3 sunAt(double azimuth_deg, double elevation_deg) {
    const double a = azimuth_deg * M_PI / 180, e = elevation_deg * M_PI / 180;
    return {std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e)};
}

/// Sum over objects of how well one paint each explains their points.
double scoreOfSun(const std::vector<LitObject*>& objects, const Daylight& day, double gamma) {
    double sum = 0;
    for (const LitObject* object : objects) {
        const auto points = someOf(*object, day, gamma, kSunPoints);
        const auto paint = findPaint(points, chanceOfSun(day, object->ring), kSunCandidates);
        if (paint) sum += paint->score;
    }
    return sum;
}

/// Objects with most points; they decide where the sun stands.
std::vector<LitObject*> largest(std::vector<LitObject>& objects) {
    std::vector<LitObject*> out;
    for (LitObject& object : objects) out.push_back(&object);
    std::stable_sort(out.begin(), out.end(), [](const LitObject* a, const LitObject* b) {
        return a->model->size() > b->model->size();
    });
    if (out.size() > kSunObjects) out.resize(kSunObjects);
    return out;
}

void findSun(std::vector<LitObject>& objects, double gamma, unsigned threads, Daylight& day) {
    const auto deciding = largest(objects);
    double bestAzimuth = 0, bestElevation = 45;
    const auto search = [&](const std::vector<std::array<double, 2>>& directions) {
        std::vector<double> scores(directions.size());
        forEachIndex(directions.size(), threads, [&](std::size_t k) {
            Daylight tried = day;
            tried.sun_world = sunAt(directions[k][0], directions[k][1]);
            scores[k] = scoreOfSun(deciding, tried, gamma);
        });
        const auto best = std::max_element(scores.begin(), scores.end()) - scores.begin();
        bestAzimuth = directions[static_cast<std::size_t>(best)][0];
        bestElevation = directions[static_cast<std::size_t>(best)][1];
    };
    std::vector<std::array<double, 2>> coarse, fine;
    for (double azimuth = 0; azimuth < 360; azimuth += 22.5) {
        for (const double elevation : {25.0, 45.0, 65.0}) coarse.push_back({azimuth, elevation});
    }
    search(coarse);
    for (const double turn : {-11.0, 0.0, 11.0}) {
        for (const double rise : {-10.0, 0.0, 10.0}) {
            fine.push_back({bestAzimuth + turn, bestElevation + rise});
        }
    }
    search(fine);
    day.sun_world = sunAt(bestAzimuth, bestElevation);
}

/// What is around a point on surfaces that face alike.
struct Around {
    double brightness = 1;    ///< of the point beside what is bright around it
    bool sunnyPlace = false;  ///< some of it is paint in the sun
};

std::vector<Around> surroundings(const ObjectModel& m, const std::vector<LitPoint>& points,
                                 const Light& paint) {
    const std::size_t step = std::max<std::size_t>(1, m.size() / kNeighbours);
    const auto used = [&](uint32_t i) { return i % step == 0 && isSeen(m, i); };
    std::vector<bool> sunlit(m.size(), false);
    for (uint32_t i = 0; i < m.size(); ++i) {
        sunlit[i] =
            used(i) && points[i].light.facesSun && misfit(points[i], paint, 1, 0) < kPlainlyPaint;
    }
    const PointGrid grid(m, kAround_m, used);
    std::vector<Around> out(m.size());
    std::vector<double> around;
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (!isSeen(m, i)) continue;
        around.clear();
        double sunny = 0, facing = 0;
        const Vec3 normal = vec3(m.normals[i]);
        grid.forWithin(vec3(m.point(i)), kSunAround_m, [&](uint32_t k, double distance2) {
            if (vec3(m.normals[k]).dot(normal) <= kAlike_cos) return;
            facing += points[k].light.facesSun ? 1 : 0;
            sunny += sunlit[k] ? 1 : 0;
            if (distance2 <= kAround_m * kAround_m) around.push_back(meanOf(points[k].seen));
        });
        out[i].sunnyPlace = points[i].light.facesSun && sunny > kSunnyPlace * facing;
        if (around.empty()) continue;
        const auto at = around.begin() + static_cast<std::ptrdiff_t>(
                                             kBrightQuantile * static_cast<double>(around.size()));
        std::nth_element(around.begin(), at, around.end());
        out[i].brightness = meanOf(points[i].seen) / std::max(1e-4, *at);
    }
    return out;
}

/// Where motor vehicles have panes: above the belt line, not on the roof.
bool maybePane(const ObjectModel& m, std::size_t i) {
    const bool motor = m.objectClass == obs::ObjectClass::Car ||
                       m.objectClass == obs::ObjectClass::Van ||
                       m.objectClass == obs::ObjectClass::Truck;
    const double height = static_cast<double>(m.point(i)[2]) / m.size_m.z() + 0.5;
    return motor && height > kBelt && height < kRoof &&
           static_cast<double>(m.normals[i][2]) < kRoof_cos;
}

/// The share of sun with which the paint comes nearest to what is seen, and how near.
struct PaintFit {
    double shareOfSun = 0, misfit = 1e9, plainMisfit = 1e9;
};

PaintFit fitPaint(const LitPoint& point, const Light& paint, double leastSun) {
    PaintFit out;
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        if (share < leastSun) continue;
        const bool half = share > 0 && share < 1;
        for (const double gleam : {-0.03, 0.0, 0.03, 0.06, 0.1}) {
            const double light = gleam * meanOf(point.light.inShade);
            const double off = misfit(point, paint, share, light);
            if (gleam == 0 && !half) out.plainMisfit = std::min(out.plainMisfit, off);
            const double cost = std::max(0.0, gleam) * kGleamCost + (half ? kHalfShadowCost : 0);
            if (off + cost >= out.misfit) continue;
            out.misfit = off + cost;
            out.shareOfSun = share;
        }
    }
    return out;
}

Light ownAlbedo(const LitPoint& point, double shareOfSun) {
    Light out{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double arriving =
            point.light.inShade[c] + shareOfSun * (point.light.inSun[c] - point.light.inShade[c]);
        out[c] = std::clamp((point.seen[c] - point.light.mirrored[c]) / arriving, kLeastAlbedo,
                            kMostAlbedo);
    }
    return out;
}

/// IEC 61966-2-1.
uint8_t srgbByte(double linear) {
    const double coded =
        linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return static_cast<uint8_t>(std::lround(255 * std::clamp(coded, 0.0, 1.0)));
}

void estimate(LitObject& object, const Daylight& day, double gamma) {
    ObjectModel& m = *object.model;
    m.albedo.assign(m.size(), ObjectModel::kUnknownAlbedo);
    for (uint8_t& f : m.flags) f = static_cast<uint8_t>(f & ~flag::kDarkPart);
    const double sun = chanceOfSun(day, object.ring);
    const auto some = someOf(object, day, gamma, kPaintPoints);
    if (some.size() < kLeastPoints) return;
    const Light paint = refinedPaint(some, sun, *findPaint(some, sun, kPaintCandidates)).albedo;
    const double scale = localScale(day, object.ring);
    std::vector<LitPoint> points(m.size());
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (isSeen(m, i)) points[i] = litPoint(object, day, gamma, scale, i);
    }
    const auto around = surroundings(m, points, paint);
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (!isSeen(m, i)) continue;
        const bool pane = maybePane(m, i);
        const PaintFit fit = fitPaint(points[i], paint, pane && around[i].sunnyPlace ? 0.5 : 0);
        Light own = ownAlbedo(points[i], fit.shareOfSun);
        const bool besidePaint = meanOf(paint) > kDarkPaint && around[i].brightness < kDarkShare &&
                                 fit.plainMisfit > kNotPaint;
        if (!besidePaint && fit.misfit < kStillPaint) {
            own = paint;
        } else if (besidePaint || pane || meanOf(own) < 0.5 * meanOf(paint)) {
            m.flags[i] |= flag::kDarkPart;
            for (double& c : own) c = std::min(c, kDarkAlbedo);
        }
        for (std::size_t c = 0; c < 3; ++c) m.albedo[i][c] = srgbByte(own[c]);
    }
}

}  // namespace

void estimateAlbedos(std::vector<LitObject>& objects, double gamma, unsigned threads) {
    std::vector<GroundRing> rings;
    for (const LitObject& object : objects) rings.push_back(object.ring);
    auto day = groundLevels(rings);
    if (!day) return;
    if (day->sun) findSun(objects, gamma, threads, *day);
    forEachIndex(objects.size(), threads,
                 [&](std::size_t k) { estimate(objects[k], *day, gamma); });
}

}  // namespace djpete::texture
