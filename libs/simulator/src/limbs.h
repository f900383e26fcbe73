/// Rounded parts of people.
#pragma once

#include "mesh.h"

namespace djpete::simulator {

/// An ellipse in space: its middle and two half axes.
struct Section {
    Vec3f centre, a, b;
};

/// A smooth skin around sections, seen from outside. The direction of travel is a x b. u runs
/// around it with 0 at `a` (metres, from -half to half of the girth), v along it from `v0`. Ends
/// are left open unless their half axes are zero.
void addLoft(Mesh& mesh, const std::vector<Section>& sections, uint32_t sides, uint32_t finish,
             float v0 = 0);

/// A rod with round ends that reach a radius beyond `from` and `to`. u is 0 at `front`'s side.
void addCapsule(Mesh& mesh, const Vec3f& from, const Vec3f& to, float radiusFrom, float radiusTo,
                const Vec3f& front, uint32_t sides, uint32_t finish);

/// The middle joint of a limb of two bones between `from` and `to`, bent towards `towards`.
Vec3f middleJoint(const Vec3f& from, const Vec3f& to, float first, float second,
                  const Vec3f& towards);

}  // namespace djpete::simulator
