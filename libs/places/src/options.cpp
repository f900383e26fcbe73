/// All INI keys of this room: each option is named once, for reading and for writing.
#include <mrpt/config/CConfigFileBase.h>

#include <cmath>
#include <string>

#include "djpete/obs/errors.h"
#include "djpete/places/place_database.h"
#include "djpete/places/view_match.h"

namespace djpete::places {

namespace {

constexpr double kDegree = M_PI / 180;

class Loader {
  public:
    Loader(const mrpt::config::CConfigFileBase& source, const std::string& section)
        : source_(source), section_(section) {}

    void count(const char* key, unsigned& value, int smallest, int largest, const char*) {
        const int read = source_.read_int(section_, key, static_cast<int>(value));
        require(
            read >= smallest && read <= largest, key,
            "a whole number from " + std::to_string(smallest) + " to " + std::to_string(largest));
        value = static_cast<unsigned>(read);
    }
    void number(const char* key, double& value, double smallest, double largest, const char*) {
        value = source_.read_double(section_, key, value);
        require(std::isfinite(value) && value >= smallest && value <= largest, key,
                "a number from " + std::to_string(smallest) + " to " + std::to_string(largest));
    }
    void degrees(const char* key, double& value_rad, double smallest, double largest,
                 const char* comment) {
        double value_deg = value_rad / kDegree;
        number(key, value_deg, smallest, largest, comment);
        value_rad = kDegree * value_deg;
    }

  private:
    void require(bool good, const char* key, const std::string& expected) const {
        if (good) return;
        throw obs::InputError("section [" + section_ + "]: " + key + " must be " + expected);
    }
    const mrpt::config::CConfigFileBase& source_;
    const std::string& section_;
};

class Saver {
  public:
    Saver(mrpt::config::CConfigFileBase& target, const std::string& section)
        : target_(target), section_(section) {}

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
        target_.write(section_, key, value, mrpt::config::MRPT_SAVE_NAME_PADDING(),
                      mrpt::config::MRPT_SAVE_VALUE_PADDING(), comment);
    }
    mrpt::config::CConfigFileBase& target_;
    const std::string& section_;
};

constexpr int kMany = 1000000;

template <class Visitor, class Options>
void visitDatabase(Visitor&& v, Options& o) {
    v.count("tables", o.tables, 1, 16, "Hash tables; 8 bytes per corner each");
    v.count("key_bits", o.keyBits, 8, 20, "Bits of the descriptor that make a key");
    v.count("max_hamming", o.maxHamming, 0, 256, "Differing bits of corners that vote");
    v.count("max_list_length", o.maxListLength, 1, kMany,
            "Longer lists are not read: they tell little");
    v.count("neighbours", o.neighbours, 0, kMany, "Keyframes before and after that are one place");
    v.count("min_corners", o.minCorners, 1, kMany, "Views with fewer are not searched for");
}

template <class Visitor, class Options>
void visitMatch(Visitor&& v, Options& o) {
    v.count("max_hamming", o.maxHamming, 0, 256, "Differing bits of a pair of corners");
    v.number("max_ratio", o.maxRatio, 0, 1, "Of differing bits to those of the second best");
    v.number("sigma_px", o.sigma_px, 1e-3, 100, "1-sigma of a corner found anew, in both images");
    v.number("max_chi2", o.maxChi2, 0, 1e6, "Squared whitened error of an agreeing pair, 2-3 dof");
    v.count("max_samples", o.maxSamples, 1, kMany, "Samples of three pairs at most");
    v.count("min_inliers", o.minInliers, 8, kMany, "Pairs that must agree");
    v.number("min_share", o.minShare, 0, 1, "Of the corners to be seen again that must agree");
    v.number("search_radius_px", o.searchRadius_px, 1, 1e4, "About a pixel predicted by a guess");
    v.number("max_sigma_m", o.maxSigma_m, 0, 1e3, "A solution known worse is badly spread");
    v.degrees("max_sigma_deg", o.maxSigma_rad, 0, 180, "... and of its rotation");
    v.number("dependence", o.dependence, 1, 1e6, "Of pairs; divides the information of the pose");
    v.count("min_cells", o.minCells, 1, 32, "Of an 8 x 4 grid in which agreeing pairs lie");
}

}  // namespace

#define DJPETE_PLACES_OPTIONS(Options, visit)                                     \
    void Options::loadFromConfigFile(const mrpt::config::CConfigFileBase& source, \
                                     const std::string& section) {                \
        visit(Loader(source, section), *this);                                    \
    }                                                                             \
    void Options::saveToConfigFile(mrpt::config::CConfigFileBase& target,         \
                                   const std::string& section) const {            \
        visit(Saver(target, section), *this);                                     \
    }
DJPETE_PLACES_OPTIONS(DatabaseOptions, visitDatabase)
DJPETE_PLACES_OPTIONS(MatchOptions, visitMatch)
#undef DJPETE_PLACES_OPTIONS

}  // namespace djpete::places
