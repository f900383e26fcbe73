/// What the numbers of a report mean, in words.
#pragma once

#include "djpete/calibration/calibration_check.h"

namespace djpete::calibration {

/// Fills the verdicts from the estimates.
void judge(CalibrationReport& report);

}  // namespace djpete::calibration
