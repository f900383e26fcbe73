#include "option_file.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "number_rows.h"

namespace djpete::simulator {

namespace {

/// The way of the drive: the name of a route, or the number of given poses and a digest of them.
std::string wayOf(const WorldOptions& o) {
    if (o.T_first_cam.empty()) return o.route == RouteKind::Blocks ? "blocks" : "street";
    uint64_t digest = 14695981039346656037ULL;  // FNV-1a
    for (const auto& T : o.T_first_cam) {
        for (const char c : poseRow(T)) {
            digest ^= static_cast<unsigned char>(c);
            digest *= 1099511628211ULL;
        }
    }
    return std::to_string(o.T_first_cam.size()) + "-poses-" + std::to_string(digest);
}

}  // namespace

std::string optionText(const DriveOptions& o) {
    std::ostringstream out;
    const auto number = [&](const char* name, double value) {
        out << name << numberRow({value}, " %.10g") << "\n";
    };
    out << "frames " << o.begin << ":" << o.end << "\n";
    out << "size " << o.width_px << "x" << o.height_px << "\n";
    out << "seed " << o.world.seed << "\n";
    out << "way " << wayOf(o.world) << "\n";
    number("step", o.world.step_m);
    number("period", o.world.period_s);
    out << "scans " << (!o.scans ? "none" : o.lidar.raw ? "raw" : "compensated") << "\n";
    number("lidar-azimuth-step-deg", o.lidar.azimuthStep_deg);
    number("lidar-range-noise-m", o.lidar.rangeNoise_m);
    number("lidar-range-noise-per-metre", o.lidar.rangeNoisePerMetre);
    number("lidar-beam-bias-m", o.lidar.beamBias_m);
    number("lidar-max-range-m", o.lidar.maxRange_m);
    out << "colour " << (o.colour ? "yes" : "no") << "\n";
    number("label-range-m", o.labels.maxRange_m);
    out << "label-pixels " << o.labels.minVisible_px << "\n";
    number("object-range-m", o.objectRange_m);
    number("detection-sigma-m", o.detector.sigma_m);
    number("detection-sigma-rad", o.detector.sigma_rad);
    number("detection-miss", o.detector.missRate);
    number("oxts-sigma-m", o.oxts.position_m);
    number("oxts-sigma-rad", o.oxts.angle_rad);
    number("oxts-sigma-mps", o.oxts.velocity_mps);
    number("oxts-sigma-mps2", o.oxts.acceleration_mps2);
    number("oxts-sigma-radps", o.oxts.turnRate_radps);
    out << "depth";
    for (const auto& range : o.depth) out << " " << range.begin << ":" << range.end;
    out << "\nfaults";
    for (const auto& fault : o.faults) {
        for (const auto& name : faultNames()) {
            if (name.kind == fault.kind)
                out << " " << name.name << "@" << fault.begin << ":" << fault.end;
        }
    }
    out << "\n";
    return out.str();
}

bool wasBegunWith(const DriveOptions& options, const std::filesystem::path& folder) {
    const auto file = folder / "drive_options.txt";
    std::ifstream before(file);
    if (!before) return false;
    std::istringstream now(optionText(options));
    std::string lineNow, lineBefore;
    while (std::getline(now, lineNow)) {
        if (!std::getline(before, lineBefore)) lineBefore = "nothing";
        if (lineNow != lineBefore) {
            throw std::runtime_error(file.string() + ": the drive was begun with '" + lineBefore +
                                     "', not '" + lineNow +
                                     "'; to resume it, give the options it was begun with");
        }
    }
    return true;
}

}  // namespace djpete::simulator
