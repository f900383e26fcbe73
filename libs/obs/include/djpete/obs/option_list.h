/// One list of options, for reading and for writing: a function visit(v, options) that names each
/// option once, called with an OptionLoader or an OptionSaver.
#pragma once

#include <mrpt/config/CConfigFileBase.h>

#include <limits>
#include <string>
#include <vector>

namespace djpete::obs {

/// Reads each option it is shown; one that the section lacks keeps its value. Throws InputError
/// naming section and key if a value is not finite or out of its range.
class OptionLoader {
  public:
    static constexpr double kAnyLarger = std::numeric_limits<double>::infinity();

    OptionLoader(const mrpt::config::CConfigFileBase& source, const std::string& section)
        : source_(source), section_(section) {}

    void flag(const char* key, bool& value, const char* comment);
    void count(const char* key, unsigned& value, int smallest, const char* comment) {
        count(key, value, smallest, std::numeric_limits<int>::max(), comment);
    }
    void count(const char* key, unsigned& value, int smallest, int largest, const char* comment);
    void number(const char* key, double& value, double smallest, const char* comment) {
        number(key, value, smallest, kAnyLarger, comment);
    }
    void number(const char* key, double& value, double smallest, double largest,
                const char* comment);
    /// One of `names`; the option is its index as an enumeration.
    template <class Enum>
    void choice(const char* key, Enum& value, const std::vector<std::string>& names, const char*) {
        value = static_cast<Enum>(indexOf(key, static_cast<std::size_t>(value), names));
    }
    /// The INI holds degrees, and so do the limits; the option holds radians.
    void degrees(const char* key, double& value_rad, const char* comment) {
        degrees(key, value_rad, 0, kAnyLarger, comment);
    }
    void degrees(const char* key, double& value_rad, double smallest, double largest,
                 const char* comment);

  private:
    std::size_t indexOf(const char* key, std::size_t value,
                        const std::vector<std::string>& names) const;
    void require(double value, double smallest, double largest, const char* key) const;

    const mrpt::config::CConfigFileBase& source_;
    const std::string& section_;
};

/// Writes each option it is shown, with its comment.
class OptionSaver {
  public:
    OptionSaver(mrpt::config::CConfigFileBase& target, const std::string& section)
        : target_(target), section_(section) {}

    void flag(const char* key, bool value, const char* comment) { write(key, value, comment); }
    void count(const char* key, unsigned value, int, const char* comment) {
        write(key, value, comment);
    }
    void count(const char* key, unsigned value, int, int, const char* comment) {
        write(key, value, comment);
    }
    void number(const char* key, double value, double, const char* comment) {
        write(key, value, comment);
    }
    void number(const char* key, double value, double, double, const char* comment) {
        write(key, value, comment);
    }
    template <class Enum>
    void choice(const char* key, Enum value, const std::vector<std::string>& names,
                const char* comment) {
        write(key, names.at(static_cast<std::size_t>(value)), comment);
    }
    void degrees(const char* key, double value_rad, const char* comment);
    void degrees(const char* key, double value_rad, double, double, const char* comment) {
        degrees(key, value_rad, comment);
    }

  private:
    template <class T>
    void write(const char* key, T value, const char* comment) {
        // MRPT's padding would become part of the key.
        target_.write(section_, key, value, 0, 0, comment);
    }
    mrpt::config::CConfigFileBase& target_;
    const std::string& section_;
};

}  // namespace djpete::obs
