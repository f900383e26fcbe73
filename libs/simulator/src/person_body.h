/// People on foot and on bicycles.
#pragma once

#include "car_body.h"
#include "limbs.h"

namespace djpete::simulator {

/// Measures and clothes of an adult, drawn from a seed.
struct Figure {
    uint32_t seed = 0;
    float height_m = 1.7F, girth = 1;  ///< 1: of ordinary width
    bool longHair = false, hat = false, skirt = false, coat = false, shortSleeves = false;
    bool backpack = false, handbag = false;
    // Finishes of the mesh it is added to.
    uint32_t skin = 0, face = 0, hair = 0, top = 0, sleeve = 0, trousers = 0, shoe = 0, bag = 0;
};
Figure makeFigure(Mesh& mesh, uint32_t seed);

/// Trunk from the hips' middle upwards, leaning ahead by `lean_rad`, with bags.
void addTrunk(Mesh& mesh, const Figure& f, const Vec3f& hips, float lean_rad);
void addHead(Mesh& mesh, const Figure& f, const Vec3f& neck, float nod_rad, bool helmet);
void addArm(Mesh& mesh, const Figure& f, const Vec3f& shoulder, const Vec3f& elbow,
            const Vec3f& hand);
/// `toe`: unit direction of the foot.
void addLeg(Mesh& mesh, const Figure& f, const Vec3f& hip, const Vec3f& knee, const Vec3f& ankle,
            const Vec3f& toe);
/// A point of the trunk: `up` along the spine from the hips (over the height), `left` in metres.
Vec3f onTrunk(const Figure& f, const Vec3f& hips, float lean_rad, float up, float left);

/// `phases` shapes evenly over a double step (pedestrian) or a turn of the cranks (cyclist). The
/// box holds all shapes and is the same for each; its bottom is the ground.
std::vector<CarBody> makePersonShapes(uint32_t seed, uint32_t phases);
std::vector<CarBody> makeCyclistShapes(uint32_t seed, uint32_t phases);

/// Centres meshes with the ground at z = 0 in the box around all of them.
std::vector<CarBody> centreInCommonBox(std::vector<Mesh> meshes);

}  // namespace djpete::simulator
