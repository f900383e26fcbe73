#include <algorithm>
#include <cmath>

#include "car_body.h"
#include "noise.h"

namespace djpete::simulator {
namespace {

CarOutline outlineOf(uint32_t kind) {
    CarOutline o;
    switch (kind) {
        case 0:  // hatchback
            o = {3.95F,
                 1.70F,
                 1.48F,
                 {{-.5F, .36F},
                  {-.497F, .60F},
                  {-.475F, .68F},
                  {-.41F, .91F},
                  {-.36F, .975F},
                  {-.08F, 1.F},
                  {.06F, .975F},
                  {.255F, .675F},
                  {.42F, .60F},
                  {.48F, .52F},
                  {.5F, .36F}}};
            o.rearFoot = -.475F, o.rearHead = -.40F, o.sideRear = -.40F, o.pillar = -.045F,
            o.pillar2 = -.27F, o.belt = .645F;
            break;
        case 1:  // saloon
            o = {4.60F,
                 1.79F,
                 1.44F,
                 {{-.5F, .38F},
                  {-.496F, .62F},
                  {-.47F, .68F},
                  {-.35F, .70F},
                  {-.20F, .945F},
                  {-.13F, .985F},
                  {0.F, 1.F},
                  {.08F, .975F},
                  {.235F, .685F},
                  {.42F, .60F},
                  {.485F, .51F},
                  {.5F, .36F}}};
            o.rearFoot = -.345F, o.rearHead = -.205F, o.sideRear = -.28F, o.pillar = -.055F,
            o.pillar2 = -.225F, o.belt = .66F, o.cowl = .235F;
            break;
        case 2:  // estate
            o = {4.70F,
                 1.80F,
                 1.49F,
                 {{-.5F, .36F},
                  {-.497F, .60F},
                  {-.485F, .68F},
                  {-.435F, .92F},
                  {-.39F, .975F},
                  {-.06F, 1.F},
                  {.07F, .975F},
                  {.235F, .68F},
                  {.42F, .60F},
                  {.485F, .51F},
                  {.5F, .36F}}};
            o.rearFoot = -.485F, o.rearHead = -.43F, o.sideRear = -.42F, o.pillar = -.045F,
            o.pillar2 = -.235F, o.belt = .65F, o.cowl = .235F;
            break;
        case 3:  // SUV
            o = {4.45F,
                 1.86F,
                 1.70F,
                 {{-.5F, .38F},
                  {-.497F, .62F},
                  {-.485F, .68F},
                  {-.44F, .93F},
                  {-.40F, .98F},
                  {-.05F, 1.F},
                  {.07F, .98F},
                  {.225F, .70F},
                  {.43F, .645F},
                  {.485F, .56F},
                  {.5F, .40F}}};
            o.rearFoot = -.485F, o.rearHead = -.435F, o.sideRear = -.41F, o.pillar = -.05F,
            o.pillar2 = -.26F, o.belt = .665F, o.cowl = .225F;
            o.wheelRadius_m = .36F, o.clearance_m = .25F;
            break;
        case kVan:
            o = {4.95F,
                 1.92F,
                 1.98F,
                 {{-.5F, .28F},
                  {-.499F, .60F},
                  {-.494F, .90F},
                  {-.475F, .985F},
                  {-.1F, 1.F},
                  {.18F, .985F},
                  {.235F, .955F},
                  {.385F, .575F},
                  {.465F, .49F},
                  {.493F, .40F},
                  {.5F, .28F}}};
            o.rearFoot = -.497F, o.rearHead = -.49F, o.sideRear = .075F, o.pillar = -1.F,
            o.belt = .555F, o.cowl = .385F;
            o.wheelFront = .335F, o.wheelRear = -.28F, o.wheelRadius_m = .34F, o.lean = .16F;
            o.van = true;
            break;
        case 5:  // city car
            o = {3.45F,
                 1.62F,
                 1.50F,
                 {{-.5F, .36F},
                  {-.497F, .62F},
                  {-.485F, .70F},
                  {-.44F, .93F},
                  {-.40F, .98F},
                  {-.05F, 1.F},
                  {.10F, .975F},
                  {.30F, .67F},
                  {.44F, .60F},
                  {.485F, .52F},
                  {.5F, .36F}}};
            o.rearFoot = -.485F, o.rearHead = -.435F, o.sideRear = -.40F, o.pillar = -.13F,
            o.belt = .64F, o.cowl = .30F;
            o.wheelFront = .34F, o.wheelRear = -.33F, o.wheelRadius_m = .285F;
            break;
        case kPickUp:
            o = {5.20F,
                 1.86F,
                 1.78F,
                 {{-.5F, .36F},
                  {-.498F, .57F},
                  {-.49F, .605F},
                  {-.16F, .605F},
                  {-.15F, .62F},
                  {-.12F, .94F},
                  {-.08F, .985F},
                  {.02F, 1.F},
                  {.09F, .975F},
                  {.215F, .675F},
                  {.43F, .625F},
                  {.488F, .55F},
                  {.5F, .38F}}};
            o.rearFoot = -.147F, o.rearHead = -.118F, o.sideRear = -.105F, o.pillar = .03F,
            o.belt = .635F, o.cowl = .215F;
            o.wheelRadius_m = .38F, o.clearance_m = .28F;
            break;
        case kMinibus:
            o = {5.05F,
                 1.93F,
                 1.99F,
                 {{-.5F, .28F},
                  {-.499F, .60F},
                  {-.49F, .90F},
                  {-.47F, .985F},
                  {-.1F, 1.F},
                  {.18F, .985F},
                  {.235F, .955F},
                  {.375F, .585F},
                  {.465F, .50F},
                  {.493F, .41F},
                  {.5F, .28F}}};
            o.rearFoot = -.497F, o.rearHead = -.48F, o.sideRear = -.455F, o.pillar = .06F,
            o.pillar2 = -.21F, o.belt = .575F, o.cowl = .375F;
            o.wheelFront = .335F, o.wheelRear = -.28F, o.wheelRadius_m = .33F, o.lean = .16F;
            break;
        case 8:  // people carrier
            o = {4.40F,
                 1.83F,
                 1.80F,
                 {{-.5F, .32F},
                  {-.498F, .58F},
                  {-.492F, .66F},
                  {-.465F, .93F},
                  {-.44F, .985F},
                  {-.1F, 1.F},
                  {.09F, .98F},
                  {.14F, .95F},
                  {.315F, .625F},
                  {.44F, .545F},
                  {.49F, .45F},
                  {.5F, .32F}}};
            o.rearFoot = -.49F, o.rearHead = -.462F, o.sideRear = -.43F, o.pillar = .005F,
            o.pillar2 = -.24F, o.belt = .605F, o.cowl = .315F;
            o.wheelFront = .325F, o.wheelRear = -.30F, o.lean = .20F;
            break;
        default:  // tall panel van
            o = {5.75F,
                 2.00F,
                 2.60F,
                 {{-.5F, .22F},
                  {-.499F, .60F},
                  {-.497F, .93F},
                  {-.485F, .99F},
                  {-.1F, 1.F},
                  {.16F, .985F},
                  {.225F, .93F},
                  {.385F, .52F},
                  {.465F, .44F},
                  {.493F, .36F},
                  {.5F, .22F}}};
            o.rearFoot = -.497F, o.rearHead = -.49F, o.sideRear = .105F, o.pillar = -1.F,
            o.belt = .475F, o.cowl = .385F;
            o.wheelFront = .335F, o.wheelRear = -.27F, o.wheelRadius_m = .35F, o.lean = .09F;
            o.van = true;
            break;
    }
    return o;
}

/// Two rounds of corner cutting; ends stay.
std::vector<Vec2f> smoothed(std::vector<Vec2f> line) {
    for (int round = 0; round < 2; ++round) {
        std::vector<Vec2f> out{line.front()};
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            out.emplace_back(0.8F * line[i] + 0.2F * line[i + 1]);
            out.emplace_back(0.2F * line[i] + 0.8F * line[i + 1]);
        }
        out.push_back(line.back());
        line = std::move(out);
    }
    return line;
}

}  // namespace

float CarOutline::topAt(float x) const {
    const auto next = std::lower_bound(top.begin() + 1, top.end() - 1, x,
                                       [](const Vec2f& p, float at) { return p.x() < at; });
    const Vec2f &a = *(next - 1), &b = *next;
    const float f = std::clamp((x - a.x()) / std::max(1e-6F, b.x() - a.x()), 0.F, 1.F);
    return a.y() + f * (b.y() - a.y());
}

float CarOutline::halfWidthAt(float x) const {
    const float front = std::max(0.F, (x - 0.34F) / 0.16F),
                rear = std::max(0.F, (-x - 0.40F) / 0.10F);
    return (0.5F * width_m - 0.015F) * (1.F - 0.17F * front * front * front - 0.07F * rear * rear);
}

float CarOutline::lowAt(float x) const {
    const float end = std::max(0.F, (std::abs(x) - 0.40F) / 0.10F);
    float low = clearance_m + 0.07F * end * end;
    for (float wheel : {wheelRear, wheelFront}) {
        const float dx = (x - wheel) * length_m, square = archRadius_m() * archRadius_m() - dx * dx;
        if (square >= 0) low = std::max(low, wheelRadius_m + std::sqrt(square));
    }
    return low;
}

CarOutline makeOutline(uint32_t kind, uint32_t seed) {
    CarOutline o = outlineOf(kind);
    const float scale = between(hash(seed, 1), 0.95F, 1.05F);
    o.length_m *= scale * between(hash(seed, 2), 0.97F, 1.03F);
    o.width_m *= between(hash(seed, 4), 0.98F, 1.02F);
    o.height_m *= between(hash(seed, 3), 0.975F, 1.025F);
    o.wheelRadius_m *= between(hash(seed, 5), 0.96F, 1.05F);
    o.belt += between(hash(seed, 6), -0.012F, 0.012F);
    for (std::size_t i = 2; i + 2 < o.top.size(); ++i)
        o.top[i].y() += between(hash(seed, 7, static_cast<uint32_t>(i)), -0.006F, 0.006F);
    o.top = smoothed(o.top);
    float highest = 0;
    for (const auto& p : o.top) highest = std::max(highest, p.y());
    for (auto& p : o.top) p.y() /= highest;
    return o;
}

}  // namespace djpete::simulator
