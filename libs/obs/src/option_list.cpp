#include "djpete/obs/option_list.h"

#include <cmath>
#include <sstream>

#include "djpete/obs/errors.h"

namespace djpete::obs {

namespace {
constexpr double kDegree = M_PI / 180;
}

void OptionLoader::flag(const char* key, bool& value, const char*) {
    value = source_.read_bool(section_, key, value);
}

void OptionLoader::count(const char* key, unsigned& value, int smallest, int largest, const char*) {
    const int read = source_.read_int(section_, key, static_cast<int>(value));
    require(read, smallest,
            largest == std::numeric_limits<int>::max() ? kAnyLarger : static_cast<double>(largest),
            key);
    value = static_cast<unsigned>(read);
}

void OptionLoader::number(const char* key, double& value, double smallest, double largest,
                          const char*) {
    value = source_.read_double(section_, key, value);
    require(value, smallest, largest, key);
}

void OptionLoader::degrees(const char* key, double& value_rad, double smallest, double largest,
                           const char*) {
    const double value_deg = source_.read_double(section_, key, value_rad / kDegree);
    require(value_deg, smallest, largest, key);
    value_rad = kDegree * value_deg;
}

std::size_t OptionLoader::indexOf(const char* key, std::size_t value,
                                  const std::vector<std::string>& names) const {
    const std::string name = source_.read_string(section_, key, names.at(value));
    std::string expected;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == name) return i;
        expected += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
    }
    throw InputError("section [" + section_ + "]: " + key + " is '" + name + "'; expected " +
                     expected);
}

void OptionLoader::require(double value, double smallest, double largest, const char* key) const {
    if (std::isfinite(value) && value >= smallest && value <= largest) return;
    std::ostringstream text;
    text << "section [" << section_ << "]: " << key << " must be a number ";
    if (largest == kAnyLarger) {
        text << "that is at least " << smallest;
    } else {
        text << "from " << smallest << " to " << largest;
    }
    throw InputError(text.str());
}

void OptionSaver::degrees(const char* key, double value_rad, const char* comment) {
    write(key, value_rad / kDegree, comment);
}

}  // namespace djpete::obs
