/// A text file whose failures name it, and numbers that survive the trip.
#pragma once

#include <mrpt/core/Clock.h>

#include <array>
#include <fstream>
#include <string>

#include "djpete/geometry/se3.h"

namespace djpete::io {

/// Throws obs::InputError naming the file when it cannot be opened or written completely.
class TextFile {
  public:
    explicit TextFile(const std::string& file, bool binary = false);
    void text(const std::string& s) { stream_ << s; }
    /// `before` (unless '\0'), then the number with 12 significant digits.
    void number(double value, char before = '\0');
    /// UNIX time in seconds with 7 decimals (the clock's own resolution).
    void seconds(mrpt::Clock::time_point stamp);
    std::ostream& stream() { return stream_; }
    void close();

  private:
    std::string file_;
    std::ofstream stream_;
};

/// x y z qx qy qz qw, qw >= 0.
std::array<double, 7> poseNumbers(const geometry::SE3& T_a_b);

[[noreturn]] void throwUnwritable(const std::string& file);

}  // namespace djpete::io
