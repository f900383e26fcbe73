/// All INI keys of this room: each option is named once, for reading and for writing.
#include "djpete/obs/option_list.h"
#include "djpete/places/place_database.h"
#include "djpete/places/view_match.h"

namespace djpete::places {

namespace {

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
        visit(obs::OptionLoader(source, section), *this);                         \
    }                                                                             \
    void Options::saveToConfigFile(mrpt::config::CConfigFileBase& target,         \
                                   const std::string& section) const {            \
        visit(obs::OptionSaver(target, section), *this);                          \
    }
DJPETE_PLACES_OPTIONS(DatabaseOptions, visitDatabase)
DJPETE_PLACES_OPTIONS(MatchOptions, visitMatch)
#undef DJPETE_PLACES_OPTIONS

}  // namespace djpete::places
