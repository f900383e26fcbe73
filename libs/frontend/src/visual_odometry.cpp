#include "djpete/frontend/visual_odometry.h"

namespace djpete::frontend {}  // namespace djpete::frontend
