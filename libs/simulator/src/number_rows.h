/// Numbers as text.
#pragma once

#include <string>
#include <vector>

#include "djpete/geometry/se3.h"

namespace djpete::simulator {

/// Each number in this printf format, one after the other.
std::string numberRow(const std::vector<double>& numbers, const char* format);
/// The first three rows of the matrix, 12 numbers between blanks.
std::string poseRow(const geometry::SE3& T);

}  // namespace djpete::simulator
