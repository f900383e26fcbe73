/// Lorries with a box body.
#pragma once

#include "car_body.h"

namespace djpete::simulator {

/// A cab with a box behind it, 6.5-8.5 m long and 2.9-3.4 m high. The outline is the cab's.
CarBody makeTruckBody(uint32_t seed);

}  // namespace djpete::simulator
