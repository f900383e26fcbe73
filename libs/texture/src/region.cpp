#include "djpete/texture/region.h"

#include <array>
#include <cmath>
#include <limits>

#include "parameters.h"
#include "vectors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;
using Term = std::function<bool(const ObjectModel&, std::size_t)>;

constexpr const char* kTerms =
    "'box x0:x1,y0:y1,z0:z1', 'sphere x,y,z,r', 'normal dx,dy,dz,max_deg' or 'colour "
    "r0:r1,g0:g1,b0:b1', joined by '&'";

struct Ranges {
    std::array<double, 3> low{}, high{};

    bool contains(const std::array<float, 3>& v) const {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto value = static_cast<double>(v[i]);
            if (value < low[i] || value > high[i]) return false;
        }
        return true;
    }
};

/// Three of "low:high"; an end that is left out has no limit.
Ranges rangesOf(const std::string& text, const std::string& term, const std::string& expected) {
    const std::string what = "region '" + term + "'";
    const auto parts = pieces(text, ',');
    if (parts.size() != 3) throwExpected(what, expected, text);
    Ranges out;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto ends = pieces(parts[i], ':');
        if (ends.size() != 2) throwExpected(what, expected, text);
        constexpr double kNoLimit = std::numeric_limits<double>::infinity();
        out.low[i] = ends[0].empty() ? -kNoLimit : numberOf(ends[0], what, expected);
        out.high[i] = ends[1].empty() ? kNoLimit : numberOf(ends[1], what, expected);
        if (out.low[i] > out.high[i]) {
            throwExpected(what, expected + " with the lower end first", text);
        }
    }
    return out;
}

Term boxTerm(const std::string& text, const std::string& term) {
    const Ranges box = rangesOf(text, term, "box x0:x1,y0:y1,z0:z1 in metres");
    return [box](const ObjectModel& m, std::size_t i) { return box.contains(m.point(i)); };
}

Term sphereTerm(const std::string& text, const std::string& term) {
    const std::string expected = "sphere x,y,z,r in metres with r above 0";
    const auto v = numbersOf(text, 4, "region '" + term + "'", expected);
    if (!(v[3] > 0)) throwExpected("region '" + term + "'", expected, text);
    const Vec3 centre(v[0], v[1], v[2]);
    const double radius = v[3];
    return [centre, radius](const ObjectModel& m, std::size_t i) {
        return (vec3(m.point(i)) - centre).norm() <= radius;
    };
}

Term normalTerm(const std::string& text, const std::string& term) {
    const std::string expected =
        "normal dx,dy,dz,max_deg with a direction that is not 0 and an angle of 0..180 degrees";
    const auto v = numbersOf(text, 4, "region '" + term + "'", expected);
    const Vec3 direction(v[0], v[1], v[2]);
    if (!(direction.norm() > 1e-9) || v[3] < 0 || v[3] > 180) {
        throwExpected("region '" + term + "'", expected, text);
    }
    const Vec3 unit = direction.normalized();
    const double least = std::cos(v[3] * M_PI / 180) - 1e-6;
    return [unit, least](const ObjectModel& m, std::size_t i) {
        return vec3(m.normals[i]).dot(unit) >= least;
    };
}

Term colourTerm(const std::string& text, const std::string& term) {
    const Ranges range = rangesOf(text, term, "colour r0:r1,g0:g1,b0:b1 of 0..255");
    return [range](const ObjectModel& m, std::size_t i) {
        return m.colours[i].count > 0 && range.contains(m.colours[i].mean);
    };
}

Term termOf(const std::string& term) {
    const auto blank = term.find_first_of(" \t");
    const std::string name = term.substr(0, blank);
    const std::string rest = blank == std::string::npos ? "" : trimmed(term.substr(blank));
    if (name == "not") {
        const Term inner = termOf(rest);
        return [inner](const ObjectModel& m, std::size_t i) { return !inner(m, i); };
    }
    if (name == "box") return boxTerm(rest, term);
    if (name == "sphere") return sphereTerm(rest, term);
    if (name == "normal") return normalTerm(rest, term);
    if (name == "colour" || name == "color") return colourTerm(rest, term);
    throwExpected("region", kTerms, term);
}

}  // namespace

Region::Region(const std::string& text) {
    if (trimmed(text).empty()) return;
    for (const auto& term : pieces(text, '&')) terms_.push_back(termOf(term));
}

bool Region::contains(const ObjectModel& model, std::size_t point) const {
    for (const Term& term : terms_) {
        if (!term(model, point)) return false;
    }
    return true;
}

}  // namespace djpete::texture
