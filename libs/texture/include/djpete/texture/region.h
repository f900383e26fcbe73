/// A part of an object, told in words.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "djpete/texture/object_model.h"

namespace djpete::texture {

/// Points that fulfil all terms of a text like "box 0:2,-1:1,-1:1 & not normal 0,0,1,30":
///   box x0:x1,y0:y1,z0:z1         metres in frame obj; an end left out has no limit
///   sphere x,y,z,r                metres in frame obj
///   normal dx,dy,dz,max_deg       normals within an angle of a direction of frame obj
///   colour r0:r1,g0:g1,b0:b1      0..255; points without a colour are in none
/// "not" before a term turns it round; an empty text is everything.
class Region {
  public:
    Region() = default;
    /// Throws obs::InputError with one sentence that says what was expected.
    explicit Region(const std::string& text);

    bool everything() const { return terms_.empty(); }
    bool contains(const ObjectModel& model, std::size_t point) const;

  private:
    using Term = std::function<bool(const ObjectModel&, std::size_t)>;
    std::vector<Term> terms_;
};

}  // namespace djpete::texture
