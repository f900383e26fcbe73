/// What makes a car an individual.
#pragma once

#include "mesh.h"

namespace djpete::simulator {

/// Colours (linear albedo), wear and markings of one vehicle, all drawn from its seed.
struct CarLook {
    uint32_t seed = 0;
    Vec3f paint = Vec3f::Zero(), roof = Vec3f::Zero(), ink = Vec3f::Zero();  ///< ink: of markings
    bool metallic = false;
    float dirt = 0;  ///< 0 clean .. 1 neglected
    bool plasticArches = false, moulding = false, darkGlass = false, chrome = false;
    uint32_t hub = 0;   ///< style of the wheels, < 6
    uint32_t lamp = 0;  ///< shape of the lights, < 3
    enum class Marking : uint8_t { None, RacingStripes, SideStripe, DoorLogo, Flank, Letters };
    Marking marking = Marking::None;
    bool rack = false;  ///< rails on the roof
    int oddPanel = -1;  ///< 0: bonnet, 1: front door in another colour; -1: none
};

/// `commercial`: vans and trucks, mostly white and often lettered.
CarLook makeLook(uint32_t seed, bool commercial);

/// Paint as often as it is seen on streets: white, grey, black and silver first.
Vec3f carPaint(uint32_t seed);

/// From letter to letter, over their height.
constexpr float kLetterPitch = 0.72F;
/// 1 where a row of letters has ink: `x` along the row and `z` up from its middle, in units of the
/// letters' height. Letters are 3 x 5 blocks; `seed` picks them.
bool letterAt(float x, float z, uint32_t seed);

}  // namespace djpete::simulator
