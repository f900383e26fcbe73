#include "djpete/scans/options.h"

#include "djpete/obs/errors.h"
#include "djpete/obs/option_list.h"

namespace djpete::scans {

namespace {

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

}  // namespace

void ScanOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                     const std::string& section) {
    visit(obs::OptionLoader(source, section), *this);
    if (!(minRange_m < maxRange_m)) {
        throw obs::InputError("section [" + section +
                              "]: min_range_m must be smaller than max_range_m");
    }
}

void ScanOptions::saveToConfigFile(mrpt::config::CConfigFileBase& target,
                                   const std::string& section) const {
    visit(obs::OptionSaver(target, section), *this);
}

}  // namespace djpete::scans
