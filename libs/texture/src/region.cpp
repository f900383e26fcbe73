#include "djpete/texture/region.h"

#include <cmath>
#include <sstream>

#include "djpete/obs/errors.h"

namespace djpete::texture {

namespace {

using geometry::Vec3;
using obs::InputError;

[[noreturn]] void bad(const std::string& text, const std::string& expected) {
    throw InputError("'" + text + "': expected " + expected);
}

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, at);) out.push_back(part);
    return out;
}

double number(const std::string& word, const std::string& text, const std::string& expected) {
    std::size_t used = 0;
    double value = 0;
    try {
        value = std::stod(word, &used);
    } catch (const std::exception&) {
        bad(text, expected);
    }
    if (word.find_first_not_of(" \t", used) != std::string::npos || !std::isfinite(value)) {
        bad(text, expected);
    }
    return value;
}

/// "x0:x1,y0:y1,z0:z1"
std::array<std::array<double, 2>, 3> ranges(const std::string& text, const std::string& expected) {
    const auto parts = split(text, ',');
    if (parts.size() != 3) bad(text, expected);
    std::array<std::array<double, 2>, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto ends = split(parts[i], ':');
        if (ends.size() != 2) bad(text, expected);
        for (std::size_t k = 0; k < 2; ++k) out[i][k] = number(ends[k], text, expected);
        if (out[i][0] > out[i][1]) bad(text, expected + ", the smaller number first");
    }
    return out;
}

template <class Values>
bool within(const Values& values, const std::array<std::array<double, 2>, 3>& limits) {
    for (std::size_t i = 0; i < 3; ++i) {
        const auto v = static_cast<double>(values[i]);
        if (v < limits[i][0] || v > limits[i][1]) return false;
    }
    return true;
}

Vec3 toVector(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
    return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

}  // namespace

std::vector<double> parseNumbers(const std::string& text, std::size_t count,
                                 const std::string& expected) {
    const auto parts = split(text, ',');
    if (parts.size() != count || text.empty() || text.back() == ',') bad(text, expected);
    std::vector<double> out;
    for (const auto& part : parts) out.push_back(number(part, text, expected));
    return out;
}

std::array<float, 3> parseColour(const std::string& text) {
    const std::string expected = "red,green,blue from 0 to 255, e.g. 200,30,30";
    std::array<float, 3> out{};
    std::size_t c = 0;
    for (const double value : parseNumbers(text, 3, expected)) {
        if (value < 0 || value > 255) bad(text, expected);
        out[c++] = static_cast<float>(value);
    }
    return out;
}

Region Region::parse(const std::string& text) {
    Region region;
    for (const auto& part : split(text, ';')) {
        const std::string condition = trimmed(part);
        const auto space = condition.find(' ');
        const std::string word = condition.substr(0, space);
        const std::string rest =
            space == std::string::npos ? "" : trimmed(condition.substr(space + 1));
        if (word == "box") {
            const auto limits = ranges(rest, "box x0:x1,y0:y1,z0:z1 in metres");
            region.conditions_.push_back([limits](const ObjectModel& m, std::size_t i) {
                return within(m.point(i), limits);
            });
        } else if (word == "sphere") {
            const auto v = parseNumbers(rest, 4, "sphere x,y,z,r in metres");
            if (v[3] <= 0) bad(rest, "sphere x,y,z,r with r above 0");
            region.conditions_.push_back([v](const ObjectModel& m, std::size_t i) {
                return (toVector(m.point(i)) - Vec3(v[0], v[1], v[2])).norm() <= v[3];
            });
        } else if (word == "normal") {
            const auto v = parseNumbers(rest, 4, "normal dx,dy,dz,degrees");
            const Vec3 direction(v[0], v[1], v[2]);
            if (direction.norm() < 1e-9) bad(rest, "normal dx,dy,dz,degrees with a direction");
            const double least = std::cos(v[3] * M_PI / 180);
            const Vec3 unit = direction.normalized();
            region.conditions_.push_back([unit, least](const ObjectModel& m, std::size_t i) {
                return toVector(m.normals[i]).dot(unit) >= least;
            });
        } else if (word == "colour") {
            const auto limits = ranges(rest, "colour r0:r1,g0:g1,b0:b1 from 0 to 255");
            region.conditions_.push_back([limits](const ObjectModel& m, std::size_t i) {
                return m.colours[i].count > 0 && within(m.colours[i].mean, limits);
            });
        } else {
            bad(condition, "box, sphere, normal or colour with its numbers");
        }
    }
    return region;
}

bool Region::contains(const ObjectModel& model, std::size_t point) const {
    for (const auto& condition : conditions_) {
        if (!condition(model, point)) return false;
    }
    return true;
}

}  // namespace djpete::texture
