#include <algorithm>
#include <array>
#include <cmath>

#include "noise.h"
#include "person_body.h"

namespace djpete::simulator {
namespace {

constexpr uint32_t kLimbSides = 9, kTrunkSides = 14;

Vec3f clothColour(uint32_t h, bool dull) {
    static const std::array<Vec3f, 16> kColours{
        Vec3f(0.02F, 0.02F, 0.025F), Vec3f(0.03F, 0.05F, 0.12F), Vec3f(0.09F, 0.09F, 0.10F),
        Vec3f(0.22F, 0.19F, 0.14F),  Vec3f(0.06F, 0.10F, 0.20F), Vec3f(0.08F, 0.07F, 0.04F),
        Vec3f(0.25F, 0.25F, 0.26F),  Vec3f(0.66F, 0.65F, 0.61F), Vec3f(0.38F, 0.03F, 0.03F),
        Vec3f(0.05F, 0.22F, 0.12F),  Vec3f(0.10F, 0.25F, 0.48F), Vec3f(0.62F, 0.40F, 0.06F),
        Vec3f(0.50F, 0.16F, 0.05F),  Vec3f(0.45F, 0.14F, 0.22F), Vec3f(0.20F, 0.10F, 0.25F),
        Vec3f(0.55F, 0.50F, 0.40F)};
    return between(hash(h, 1U), 0.8F, 1.15F) * kColours.at(hash(h, 2U) % (dull ? 7U : 16U));
}

/// An ellipse across the trunk: depth rx along `ahead`, half width ry.
Section across(const Vec3f& centre, const Vec3f& ahead, float rx, float ry) {
    return {centre, rx * ahead, ry * Vec3f::UnitY()};
}

}  // namespace

Figure makeFigure(Mesh& mesh, uint32_t seed) {
    const auto chance = [seed](uint32_t what) { return unit(hash(seed, 600U, what)); };
    Figure f;
    f.seed = seed;
    const bool woman = chance(1) < 0.5F;
    f.height_m = woman ? 1.655F + 0.062F * gaussian(hash(seed, 601U))
                       : 1.785F + 0.068F * gaussian(hash(seed, 601U));
    f.girth = 0.88F + 0.38F * chance(2) * chance(3);
    f.longHair = woman ? chance(4) < 0.65F : chance(4) < 0.08F;
    f.hat = chance(5) < 0.15F;
    f.skirt = woman && chance(6) < 0.25F;
    f.coat = !f.skirt && chance(7) < 0.28F;
    f.shortSleeves = !f.coat && chance(8) < 0.4F;
    f.backpack = chance(9) < 0.3F;
    f.handbag = !f.backpack && chance(10) < (woman ? 0.5F : 0.2F);
    static const std::array<Vec3f, 5> kSkins{
        Vec3f(0.52F, 0.34F, 0.25F), Vec3f(0.46F, 0.28F, 0.19F), Vec3f(0.33F, 0.19F, 0.12F),
        Vec3f(0.17F, 0.09F, 0.055F), Vec3f(0.57F, 0.39F, 0.31F)};
    static const std::array<Vec3f, 6> kHairs{
        Vec3f(0.018F, 0.014F, 0.012F), Vec3f(0.05F, 0.03F, 0.018F), Vec3f(0.11F, 0.06F, 0.03F),
        Vec3f(0.32F, 0.23F, 0.11F),    Vec3f(0.36F, 0.35F, 0.34F),  Vec3f(0.20F, 0.07F, 0.025F)};
    const Vec3f skin = kSkins.at(hash(seed, 602U) % kSkins.size());
    f.skin = mesh.addFinish(Material::Skin, skin, 0);
    f.face = mesh.addFinish(Material::Skin, skin, hash(seed, 603U) | 1U);
    f.hair = mesh.addFinish(
        Material::Hair,
        f.hat ? clothColour(hash(seed, 604U), false) : kHairs.at(hash(seed, 605U) % kHairs.size()),
        seed);
    f.top = mesh.addFinish(Material::Cloth, clothColour(hash(seed, 606U), false),
                           hash(seed, 607U) & ~3U);
    f.sleeve =
        mesh.addFinish(Material::Cloth, mesh.finishes[f.top].tint, (hash(seed, 607U) & ~3U) | 2U);
    // Trousers carry no prints, sleeves no pictures; see personSurface.
    f.trousers = mesh.addFinish(Material::Cloth, clothColour(hash(seed, 608U), !f.skirt),
                                hash(seed, 609U) | 1U);
    const float shoe = chance(11);
    f.shoe = mesh.addFinish(Material::Shoe,
                            shoe < 0.6F ? Vec3f(Vec3f::Constant(0.03F))
                                        : (shoe < 0.85F ? Vec3f(Vec3f::Constant(0.55F))
                                                        : clothColour(hash(seed, 610U), false)),
                            seed);
    f.bag = mesh.addFinish(Material::Cloth, clothColour(hash(seed, 611U), false),
                           hash(seed, 612U) | 2U);
    return f;
}

Vec3f onTrunk(const Figure& f, const Vec3f& hips, float lean, float up, float left) {
    const Vec3f spine(std::sin(lean), 0, std::cos(lean));
    return hips + up * f.height_m * spine + Vec3f(0, left, 0);
}

void addTrunk(Mesh& mesh, const Figure& f, const Vec3f& hips, float lean) {
    const Vec3f ahead(std::cos(lean), 0, -std::sin(lean));
    const float h = f.height_m, w = h * f.girth;
    std::vector<Section> sections;
    const auto add = [&](float up, float rx, float ry, float forward = 0.F) {
        sections.push_back(
            across(onTrunk(f, hips, lean, up, 0) + forward * h * ahead, ahead, rx * w, ry * w));
    };
    add(-0.065F, 0, 0);
    add(-0.055F, 0.045F, 0.065F);
    add(-0.02F, 0.066F, 0.094F, -0.006F);
    add(0.02F, 0.066F, 0.094F, -0.006F);
    add(0.06F, 0.055F, 0.080F);
    addLoft(mesh, sections, kTrunkSides, f.trousers);
    sections.clear();
    const float belly = 0.04F * (f.girth - 0.88F);
    const float hem = f.coat ? -0.20F : 0.0F;
    add(hem, 0, 0);
    add(hem + 0.002F, f.coat ? 0.098F : 0.074F, f.coat ? 0.120F : 0.101F, -0.006F);
    if (f.coat) add(-0.02F, 0.082F, 0.110F, -0.006F);
    add(0.04F, f.coat ? 0.078F : 0.070F, f.coat ? 0.104F : 0.097F, -0.003F + belly);
    add(0.095F, 0.062F + belly, 0.090F, belly);
    add(0.19F, 0.070F, 0.104F);
    add(0.255F, 0.064F, 0.116F);
    add(0.290F, 0.050F, 0.100F);
    add(0.312F, 0.034F, 0.050F);
    add(0.322F, 0, 0);
    addLoft(mesh, sections, kTrunkSides, f.top, hem * h);
    if (f.skirt) {
        sections.clear();
        add(-0.20F, 0, 0);
        add(-0.198F, 0.098F, 0.125F);
        add(-0.08F, 0.085F, 0.112F);
        add(0.0F, 0.070F, 0.098F);
        add(0.05F, 0.055F, 0.080F);
        addLoft(mesh, sections, kTrunkSides, f.trousers);
    }
    if (f.backpack) {
        sections.clear();
        add(0.04F, 0, 0, -0.105F);
        add(0.05F, 0.045F, 0.075F, -0.105F);
        add(0.16F, 0.050F, 0.082F, -0.108F);
        add(0.25F, 0.038F, 0.074F, -0.098F);
        add(0.28F, 0, 0, -0.09F);
        addLoft(mesh, sections, 10, f.bag);
    }
    if (f.handbag) {
        const float side = unit(hash(f.seed, 613U)) < 0.5F ? 1.F : -1.F;
        const Vec3f at = onTrunk(f, hips, lean, -0.06F, side * 0.145F * w);
        mesh.addBox(at - Vec3f(0.01F, 0, 0), Vec3f(0.30F, 0.09F, 0.22F), Vec3f::UnitX(), f.bag);
        mesh.addRod(at + Vec3f(0, 0, 0.2F), onTrunk(f, hips, lean, 0.29F, side * 0.085F * w),
                    0.012F, 0.012F, 5, false, f.bag);
    }
}

void addHead(Mesh& mesh, const Figure& f, const Vec3f& neck, float nod, bool helmet) {
    const float h = f.height_m;
    const Vec3f up(std::sin(nod), 0, std::cos(nod)), ahead(std::cos(nod), 0, -std::sin(nod));
    addCapsule(mesh, neck - 0.01F * h * up, neck + 0.04F * h * up, 0.034F * h, 0.032F * h, ahead, 8,
               f.skin);
    const auto egg = [&](float from, float grow, float back, float raise, uint32_t finish) {
        std::vector<Section> s;
        constexpr int kSteps = 8;
        for (int i = 0; i <= kSteps; ++i) {
            const float a = from + (1.5708F - from) * static_cast<float>(i) / kSteps;
            const float r = i == kSteps ? 0.F : std::cos(a), jaw = a < 0 ? 1.F + 0.12F * a : 1.F;
            const Vec3f c = neck + h * ((0.082F + raise + 0.068F * grow * std::sin(a)) * up +
                                        (0.010F - back) * ahead);
            s.push_back(across(c, ahead, 0.056F * h * grow * r, 0.045F * h * grow * r * jaw));
        }
        if (from <= -1.5F) s.front().a = s.front().b = Vec3f::Zero();
        addLoft(mesh, s, 14, finish);
    };
    egg(-1.5708F, 1.F, 0.F, 0.F, f.face);
    // Hair is a larger egg further back and up, out of which the face looks.
    if (helmet || f.hat)
        egg(0.30F, helmet ? 1.25F : 1.12F, helmet ? 0.004F : 0.006F, 0.F, f.hair);
    else
        egg(-0.45F, 1.08F, 0.014F, 0.012F, f.hair);
    if (f.longHair) {
        std::vector<Section> s;
        static constexpr float kFall[5][2] = {
            {-0.025F, 0.F}, {-0.022F, 0.55F}, {0.01F, 0.80F}, {0.06F, 1.F}, {0.115F, 0.98F}};
        for (const auto& k : kFall)
            s.push_back(across(neck + h * (k[0] * up - 0.018F * ahead), ahead, 0.044F * h * k[1],
                               0.049F * h * k[1]));
        addLoft(mesh, s, 10, f.hair);
    }
    if (f.hat && !helmet) {  // a brim
        const Vec3f c = neck + h * (0.108F * up + 0.055F * ahead);
        addLoft(mesh,
                {across(c, ahead, 0, 0), across(c, ahead, 0.05F * h, 0.045F * h),
                 across(c + 0.008F * up, ahead, 0.05F * h, 0.045F * h),
                 across(c + 0.009F * up, ahead, 0, 0)},
                10, f.hair);
    }
}

void addArm(Mesh& mesh, const Figure& f, const Vec3f& shoulder, const Vec3f& elbow,
            const Vec3f& hand) {
    const float w = f.height_m * (0.6F + 0.4F * f.girth) * (f.coat ? 1.2F : 1.F);
    const Vec3f x = Vec3f::UnitX();
    addCapsule(mesh, shoulder, elbow, 0.031F * w, 0.025F * w, x, kLimbSides, f.sleeve);
    const Vec3f wrist = elbow + 0.94F * (hand - elbow);
    addCapsule(mesh, elbow, wrist, 0.0235F * w, 0.017F * w, x, kLimbSides,
               f.shortSleeves ? f.skin : f.sleeve);
    addCapsule(mesh, hand, hand + 0.035F * f.height_m * (hand - elbow).normalized(),
               0.017F * f.height_m, 0.012F * f.height_m, x, 7, f.skin);
}

void addLeg(Mesh& mesh, const Figure& f, const Vec3f& hip, const Vec3f& knee, const Vec3f& ankle,
            const Vec3f& toe) {
    const float h = f.height_m, w = h * (0.5F + 0.5F * f.girth);
    const Vec3f x = Vec3f::UnitX();
    const uint32_t cloth = f.skirt ? f.skin : f.trousers;
    addCapsule(mesh, hip, knee, 0.049F * w, 0.036F * w, x, kLimbSides, cloth);
    const float cuff = f.skirt ? 0.024F : 0.032F;
    addCapsule(mesh, knee, ankle, 0.036F * w, cuff * w, x, kLimbSides, cloth);
    const Vec3f up = toe.cross(Vec3f::UnitY()).z() < 0 ? Vec3f(-toe.cross(Vec3f::UnitY()))
                                                       : Vec3f(toe.cross(Vec3f::UnitY()));
    const Vec3f sole = ankle - 0.022F * h * up;
    addCapsule(mesh, sole - 0.022F * h * toe, sole + 0.088F * h * toe - 0.004F * h * up, 0.024F * h,
               0.020F * h, up, kLimbSides, f.shoe);
}

}  // namespace djpete::simulator
