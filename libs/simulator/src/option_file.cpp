#include "option_file.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "number_rows.h"

namespace djpete::simulator {

std::string optionText(const DriveOptions& o) {
    std::ostringstream out;
    const auto number = [&](const char* name, double value) {
        out << name << numberRow({value}, " %.10g") << "\n";
    };
    out << "frames " << o.begin << ":" << o.end << "\n";
    out << "size " << o.width_px << "x" << o.height_px << "\n";
    out << "seed " << o.world.seed << "\n";
    if (!o.world.T_first_cam.empty()) {
        // The poses by their number, the length of the way, and where it ends.
        double way = 0;
        for (std::size_t i = 1; i < o.world.T_first_cam.size(); ++i)
            way += (o.world.T_first_cam[i].translation() - o.world.T_first_cam[i - 1].translation())
                       .norm();
        const auto& end = o.world.T_first_cam.back().translation();
        out << "route poses " << o.world.T_first_cam.size()
            << numberRow({way, end.x(), end.y(), end.z()}, " %.10g") << "\n";
    } else {
        out << "route " << (o.world.route == RouteKind::Blocks ? "blocks" : "street") << "\n";
    }
    number("step", o.world.step_m);
    number("period", o.world.period_s);
    out << "traffic-seed " << o.world.trafficSeed << "\n";
    number("lane-offset-m", o.world.laneOffset_m);
    number("sun-turn-rad", o.world.sunTurn_rad);
    number("convoy", o.world.convoyShare);
    number("fog-m", o.world.visibility_m);
    out << "plain " << (o.world.plain ? "yes" : "no") << "\n";
    out << "scans " << (!o.scans ? "none" : o.lidar.raw ? "raw" : "compensated") << "\n";
    number("lidar-azimuth-step-deg", o.lidar.azimuthStep_deg);
    number("lidar-range-noise-m", o.lidar.rangeNoise_m);
    number("lidar-range-noise-per-metre", o.lidar.rangeNoisePerMetre);
    number("lidar-beam-bias-m", o.lidar.beamBias_m);
    number("lidar-max-range-m", o.lidar.maxRange_m);
    out << "colour " << (o.colour ? "yes" : "no") << "\n";
    number("label-range-m", o.labels.maxRange_m);
    out << "label-pixels " << o.labels.minVisible_px << "\n";
    out << "label-ids " << o.labels.maxTrackId << "\n";
    number("object-range-m", o.objectRange_m);
    number("detection-sigma-m", o.detector.sigma_m);
    number("detection-sigma-rad", o.detector.sigma_rad);
    number("detection-miss", o.detector.missRate);
    number("detection-false", o.detector.falseShare);
    number("oxts-sigma-m", o.oxts.position_m);
    number("oxts-sigma-rad", o.oxts.angle_rad);
    number("oxts-sigma-mps", o.oxts.velocity_mps);
    number("oxts-sigma-mps2", o.oxts.acceleration_mps2);
    number("oxts-sigma-radps", o.oxts.turnRate_radps);
    number("mesh-texel-m", o.meshTexel_m);
    out << "depth";
    for (const auto& range : o.depth) out << " " << range.begin << ":" << range.end;
    out << "\nfaults";
    for (const auto& fault : o.faults)
        out << " " << wordOf(fault) << "@" << fault.begin << ":" << fault.end;
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
