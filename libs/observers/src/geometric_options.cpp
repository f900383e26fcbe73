#include "djpete/observers/geometric_observer.h"

namespace djpete::observers {

namespace {

/// Calls visit(key, member, comment) for every option.
template <class Options, class Visitor>
void forEachKey(Options& o, const Visitor& visit) {
    visit("range_max_m", o.rangeMax_m, "m; farther returns are too few per car to fit a box");
    visit("range_min_m", o.rangeMin_m, "m; nearer returns are the own vehicle");
    visit("ground_slope_max_deg", o.groundSlopeMax_deg,
          "deg; steepest ground against the vehicle's x-y plane");
    visit("ground_clearance_m", o.groundClearance_m,
          "m; an obstacle point is at least this high over the ground");
    visit("cell_m", o.cell_m, "m; cell of the ground plan in which clusters are joined");
    visit("tolerance_near_m", o.toleranceNear_m,
          "m; gap that joins two cells, tightest level, at range 0");
    visit("tolerance_per_range", o.tolerancePerRange, "m per m; growth of that gap with range");
    visit("tolerance_levels", o.toleranceLevels,
          "levels tried, each twice as tolerant; the best fit wins");
    visit("min_points", o.minPoints, "fewer returns cannot fix a box");
    visit("length_min_m", o.lengthMin_m, "m; shortest car");
    visit("length_max_m", o.lengthMax_m, "m; longest car or van");
    visit("length_prior_m", o.lengthPrior_m, "m; length given to a car seen only in part");
    visit("width_min_m", o.widthMin_m, "m; narrowest car");
    visit("width_max_m", o.widthMax_m, "m; widest car or van");
    visit("width_prior_m", o.widthPrior_m,
          "m; width given to a car seen only in part, without mirrors");
    visit("height_min_m", o.heightMin_m, "m; lowest car over the local ground");
    visit("height_max_m", o.heightMax_m, "m; highest van over the local ground");
    visit("van_height_m", o.vanHeight_m, "m; higher than this is called Van");
    visit("score_min", o.scoreMin, "0..1; worse candidates are not reported");
    visit("overlap_max", o.overlapMax,
          "0..1; ground-plan overlap (of the smaller box) of two reported boxes");
    visit("mask_dilation_m", o.maskDilation_m,
          "m; mask: reach of one return on the object, closes scan lines");
}

}  // namespace

void GeometricObserverOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                                  const std::string& section) {
    forEachKey(*this, [&](const char* key, auto& value, const char*) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, int>) {
            value = source.read_int(section, key, value);
        } else {
            value = source.read_double(section, key, value);
        }
    });
}

void GeometricObserverOptions::saveToConfigFile(mrpt::config::CConfigFileBase& target,
                                                const std::string& section) const {
    forEachKey(*this, [&](const char* key, const auto& value, const char* comment) {
        target.write(section, key, value, -1, -1, comment);  // padding would become part of the key
    });
}

void GeometricObserverOptions::dumpToTextStream(std::ostream& out) const {
    out << "[GeometricObserver]\n";
    forEachKey(*this, [&](const char* key, const auto& value, const char* comment) {
        out << key << " = " << value << "  # " << comment << "\n";
    });
}

}  // namespace djpete::observers
