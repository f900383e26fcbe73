#include <iomanip>
#include <sstream>

#include "djpete/calibration/calibration_check.h"
#include "verdicts.h"

namespace djpete::calibration {

namespace {

constexpr double kDeg = 180 / 3.14159265358979323846;

/// From which deviation a number is worth a word, in its own unit.
constexpr double kRow_px = 0.1, kSlope_px = 0.2, kOffset_px = 0.1, kScale = 2e-3,
                 kTilt_rad = 0.1 / kDeg, kShift_m = 0.03;

std::string number(const Estimate& e, double unit, int digits) {
    if (!e.known) return "unknown";
    std::ostringstream o;
    o << std::fixed << std::setprecision(digits) << e.value * unit << " +- " << e.sigma * unit;
    return o.str();
}

std::string joined(const std::string& soFar, const std::string& more) {
    return soFar.empty() ? more : soFar + "; " + more;
}

std::string rowVerdict(const RowCheck& c) {
    if (!c.offset_px.known) return "not enough keyframes with a right image to tell";
    std::string out;
    if (c.offset_px.deviates(0, kRow_px)) out = "the right image's rows are off";
    if (c.perColumn_px.deviates(0, kSlope_px)) out = joined(out, "the right camera is rolled");
    if (c.perRow_px.deviates(0, kSlope_px)) {
        out = joined(out, "the two cameras differ in focal length");
    }
    return out.empty() ? "rows are aligned" : out;
}

std::string disparityVerdict(const DisparityCheck& c) {
    if (!c.scale.known) return "not enough keyframes with scans to tell";
    std::string out;
    if (c.offset_px.deviates(0, kOffset_px)) out = "disparities carry an offset";
    if (c.scale.deviates(1, kScale)) {
        out = joined(out, c.scale.value < 1 ? "the stated baseline (or focal length) is too long"
                                            : "the stated baseline (or focal length) is too short");
    }
    return out.empty() ? "disparities agree with the scans" : out;
}

std::string lidarVerdict(const LidarCameraCheck& c) {
    if (!c.tiltX_rad.known) return "not enough keyframes with scans to tell";
    std::string out;
    const bool tilted = c.tiltX_rad.deviates(0, kTilt_rad) || c.tiltY_rad.deviates(0, kTilt_rad) ||
                        c.tiltZ_rad.deviates(0, kTilt_rad);
    const bool shifted = c.shiftX_m.deviates(0, kShift_m) || c.shiftY_m.deviates(0, kShift_m) ||
                         c.shiftZ_m.deviates(0, kShift_m);
    if (tilted) out = "the camera is turned against the scanner";
    if (shifted) out = joined(out, "the camera is shifted against the scanner");
    return out.empty() ? "camera and scanner fit" : out;
}

}  // namespace

void judge(CalibrationReport& report) {
    report.rows.verdict = rowVerdict(report.rows);
    report.disparity.verdict = disparityVerdict(report.disparity);
    report.lidar.verdict = lidarVerdict(report.lidar);
}

std::string toText(const CalibrationReport& r) {
    std::ostringstream o;
    o << "rows of the right image (" << r.rows.measurements << " corners, " << r.rows.frames
      << " keyframes): " << r.rows.verdict << "\n  offset, px                     "
      << number(r.rows.offset_px, 1, 3) << "\n  per focal length of columns, px "
      << number(r.rows.perColumn_px, 1, 3) << "\n  per focal length of rows, px    "
      << number(r.rows.perRow_px, 1, 3) << "\ndisparity against the scans ("
      << r.disparity.measurements << " corners, " << r.disparity.frames
      << " keyframes): " << r.disparity.verdict << "\n  offset, px                     "
      << number(r.disparity.offset_px, 1, 3) << "\n  scale                          "
      << number(r.disparity.scale, 1, 5) << "\ncamera against scanner: " << r.lidar.verdict
      << "\n  pitch (about x, right), deg    " << number(r.lidar.tiltX_rad, kDeg, 3)
      << "\n  yaw (about y, down), deg       " << number(r.lidar.tiltY_rad, kDeg, 3)
      << "\n  roll (about z, forward), deg   " << number(r.lidar.tiltZ_rad, kDeg, 3)
      << "\n  shift right, m                 " << number(r.lidar.shiftX_m, 1, 3)
      << "\n  shift down, m                  " << number(r.lidar.shiftY_m, 1, 3)
      << "\n  shift forward, m               " << number(r.lidar.shiftZ_m, 1, 3) << "\n";
    return o.str();
}

}  // namespace djpete::calibration
