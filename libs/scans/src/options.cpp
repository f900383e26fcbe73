#include "djpete/scans/options.h"

#include <mrpt/config/CConfigFileBase.h>

#include <cmath>

#include "djpete/obs/errors.h"

namespace djpete::scans {

namespace {

constexpr double kDegree = M_PI / 180;

/// Calls v for every option: the one list that loading and saving share.
template <class Visitor, class Options>
void visit(Visitor&& v, Options& o) {
    v.flag("enabled", o.enabled, "false: scans give depth to features only");
    v.number("spin_period_s", o.spinPeriod_s, 0, 10,
             "Of a scanner that turns while driving, stamped when it looks ahead; 0: points of one "
             "instant");
    v.number("min_range_m", o.minRange_m, 0, 1e3, "Nearer points hit the own vehicle");
    v.number("max_range_m", o.maxRange_m, 1, 1e3, "Farther ones are too sparse");
    v.number("map_spacing_m", o.mapSpacing_m, 0.01, 10, "One point per such cube builds planes");
    v.number("match_spacing_m", o.matchSpacing_m, 0.01, 10, "... is matched with them");
    v.number("plane_size_m", o.planeSize_m, 0.1, 10, "Cube whose points form one plane");
    v.count("plane_points", o.planePoints, 4, 1000, "That make a plane at least");
    v.number("plane_thickness_m", o.planeThickness_m, 1e-3, 1, "1-sigma across it at most");
    v.number("map_length_m", o.mapLength_m, 1, 1e4, "Points stay in the local map for this way");
    v.count("map_keyframes", o.mapKeyframes, 1, 1000, "... and for so many keyframes");
    v.number("range_sigma_m", o.rangeSigma_m, 1e-3, 1, "Standard deviation of a range");
    v.number("first_kernel_m", o.firstKernel_m, 0.01, 10,
             "Width of Geman and McClure's kernel at the start; it adapts");
    v.count("iterations", o.iterations, 1, 100, "At most");
    v.count("min_matched", o.minMatched, 10, 1000000, "Points on planes; fewer are no match");
    v.number("min_matched_ratio", o.minMatchedRatio, 0, 1, "... as a share of all");
    v.number("alike_size_m", o.alikeSize_m, 0.1, 100, "Points of one such cube may err alike");
    v.number("floor_m", o.floor_m, 1e-6, 10, "1-sigma added to a motion between keyframes");
    v.degrees("floor_deg", o.floor_rad, 1e-6, 10, "... of rotation");
}

class Loader {
  public:
    Loader(const mrpt::config::CConfigFileBase& source, const std::string& section)
        : source_(source), section_(section) {}

    void flag(const char* key, bool& value, const char*) {
        value = source_.read_bool(section_, key, value);
    }
    void count(const char* key, unsigned& value, int smallest, int largest, const char*) {
        const int read = source_.read_int(section_, key, static_cast<int>(value));
        require(read >= smallest && read <= largest, key, smallest, largest);
        value = static_cast<unsigned>(read);
    }
    void number(const char* key, double& value, double smallest, double largest, const char*) {
        value = source_.read_double(section_, key, value);
        require(value >= smallest && value <= largest, key, smallest, largest);
    }
    void degrees(const char* key, double& value_rad, double smallest, double largest, const char*) {
        const double degrees = source_.read_double(section_, key, value_rad / kDegree);
        require(degrees >= smallest && degrees <= largest, key, smallest, largest);
        value_rad = kDegree * degrees;
    }

  private:
    template <class T>
    void require(bool good, const char* key, T smallest, T largest) const {
        if (good) return;
        throw obs::InputError("section [" + section_ + "]: " + key + " must be a number from " +
                              std::to_string(smallest) + " to " + std::to_string(largest));
    }
    const mrpt::config::CConfigFileBase& source_;
    const std::string& section_;
};

class Saver {
  public:
    Saver(mrpt::config::CConfigFileBase& target, const std::string& section)
        : target_(target), section_(section) {}

    void flag(const char* key, bool value, const char* comment) { write(key, value, comment); }
    void count(const char* key, unsigned value, int, int, const char* comment) {
        write(key, value, comment);
    }
    void number(const char* key, double value, double, double, const char* comment) {
        write(key, value, comment);
    }
    void degrees(const char* key, double value_rad, double, double, const char* comment) {
        write(key, value_rad / kDegree, comment);
    }

  private:
    template <class T>
    void write(const char* key, T value, const char* comment) {
        target_.write(section_, key, value, 0, 0, comment);
    }
    mrpt::config::CConfigFileBase& target_;
    const std::string& section_;
};

}  // namespace

void ScanOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                     const std::string& section) {
    visit(Loader(source, section), *this);
    if (!(minRange_m < maxRange_m)) {
        throw obs::InputError("section [" + section +
                              "]: min_range_m must be smaller than max_range_m");
    }
}

void ScanOptions::saveToConfigFile(mrpt::config::CConfigFileBase& target,
                                   const std::string& section) const {
    visit(Saver(target, section), *this);
}

}  // namespace djpete::scans
