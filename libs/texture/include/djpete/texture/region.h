/// The part of an object that an edit is for.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "djpete/texture/object_model.h"

namespace djpete::texture {

/// Conditions that a point must meet, all of them; none: every point. As text, separated by ';':
///
///     box x0:x1,y0:y1,z0:z1          metres in frame obj (x front, y left, z up, 0 the centre)
///     sphere x,y,z,r                 metres
///     normal dx,dy,dz,degrees        normals within so many degrees of a direction
///     colour r0:r1,g0:g1,b0:b1       0..255
class Region {
  public:
    /// Throws obs::InputError, quoting the condition and saying what was expected.
    static Region parse(const std::string& text);

    bool contains(const ObjectModel& model, std::size_t point) const;
    bool everywhere() const { return conditions_.empty(); }

  private:
    using Condition = std::function<bool(const ObjectModel&, std::size_t)>;
    std::vector<Condition> conditions_;
};

/// "1,2.5,-3": exactly `count` finite numbers; throws obs::InputError quoting the text and saying
/// that `expected` was expected.
std::vector<double> parseNumbers(const std::string& text, std::size_t count,
                                 const std::string& expected);

/// "200,30,30": red, green, blue, 0 to 255.
std::array<float, 3> parseColour(const std::string& text);

}  // namespace djpete::texture
