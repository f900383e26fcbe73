#include "djpete/obs/calibration.h"

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/img/TStereoCamera.h>

#include <sstream>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"

namespace djpete::obs {

namespace {

using geometry::SE3;

/// Rows of the 3x4 matrix, 17 digits: exact, unlike yaw-pitch-roll in degrees.
std::string poseText(const SE3& T) {
    std::ostringstream out;
    out.precision(17);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) out << T.rotation()(r, c) << ' ';
        out << T.translation()[r] << (r < 2 ? " " : "");
    }
    return out.str();
}

SE3 poseFromText(const std::string& text, const std::string& where) {
    std::istringstream in(text);
    geometry::Mat3 R;
    geometry::Vec3 t;
    for (int r = 0; r < 3; ++r) in >> R(r, 0) >> R(r, 1) >> R(r, 2) >> t[r];
    if (!in)
        throw InputError(where + ": expected the 12 numbers of a 3x4 matrix, got '" + text + "'");
    return SE3(R, t);
}

void writeCamera(mrpt::config::CConfigFileMemory& cfg, const std::string& prefix,
                 const RigCamera& cam) {
    mrpt::img::TStereoCamera s;
    s.leftCamera.ncols = static_cast<uint32_t>(cam.model.width_px);
    s.leftCamera.nrows = static_cast<uint32_t>(cam.model.height_px);
    s.leftCamera.setIntrinsicParamsFromValues(cam.model.fx, cam.model.fy, cam.model.cx,
                                              cam.model.cy);
    s.rightCamera = s.leftCamera;
    s.rightCameraPose.x = cam.model.baseline_m;
    s.saveToConfigFile(prefix, cfg);
    cfg.write(prefix + "_ON_VEHICLE", "matrix", poseText(cam.T_vehicle_cam));
    // MRPT writes six digits; what we compute with is exact.
    std::ostringstream exact;
    exact.precision(17);
    exact << cam.model.fx << ' ' << cam.model.fy << ' ' << cam.model.cx << ' ' << cam.model.cy
          << ' ' << cam.model.baseline_m << ' ' << cam.model.width_px << ' ' << cam.model.height_px;
    cfg.write(prefix + "_ON_VEHICLE", "fx_fy_cx_cy_baseline_width_height", exact.str());
}

std::optional<RigCamera> readCamera(const mrpt::config::CConfigFileMemory& cfg,
                                    const std::string& prefix, const std::string& origin) {
    const std::string section = prefix + "_ON_VEHICLE";
    if (!cfg.sectionExists(section)) return std::nullopt;
    const std::string where = origin + ": calibration section [" + section + "]";
    RigCamera cam;
    cam.T_vehicle_cam = poseFromText(cfg.read_string(section, "matrix", ""), where);
    const std::string numbers = cfg.read_string(section, "fx_fy_cx_cy_baseline_width_height", "");
    std::istringstream in(numbers);
    auto& m = cam.model;
    in >> m.fx >> m.fy >> m.cx >> m.cy >> m.baseline_m >> m.width_px >> m.height_px;
    if (!in || !m.valid()) {
        throw InputError(where +
                         ": expected 'fx fy cx cy baseline width height' with positive fx, fy, " +
                         "got '" + numbers + "'");
    }
    return cam;
}

}  // namespace

const RigCamera& DriveInfo::mainCamera(const std::string& origin) const {
    if (gray) return *gray;
    if (color) return *color;
    throw InputError(origin + ": no camera calibration; expected a leading '" +
                     "calibration' comment as kitti2rawlog writes it");
}

std::string toIniText(const DriveInfo& info) {
    mrpt::config::CConfigFileMemory cfg;
    cfg.write("DRIVE", "name", info.name);
    cfg.write("DRIVE", "first_frame", info.firstFrame);
    cfg.write("DRIVE", "frame_count", info.frameCount);
    std::string missing;
    for (uint64_t f : info.missing) missing += (missing.empty() ? "" : " ") + std::to_string(f);
    cfg.write("DRIVE", "missing_frames", missing);
    cfg.write("DRIVE", "velo_on_vehicle", poseText(info.T_vehicle_velo));
    if (info.gray) writeCamera(cfg, "GRAY", *info.gray);
    if (info.color) writeCamera(cfg, "COLOR", *info.color);
    return cfg.getContent();
}

DriveInfo driveInfoFromIniText(const std::string& text, const std::string& origin) {
    const mrpt::config::CConfigFileMemory cfg(text);
    if (!cfg.sectionExists("DRIVE")) {
        throw InputError(origin + ": the calibration comment has no [DRIVE] section");
    }
    DriveInfo info;
    info.name = cfg.read_string("DRIVE", "name", "");
    info.firstFrame = cfg.read_uint64_t("DRIVE", "first_frame", 0);
    info.frameCount = cfg.read_uint64_t("DRIVE", "frame_count", 0);
    std::istringstream missing(cfg.read_string("DRIVE", "missing_frames", ""));
    for (uint64_t f; missing >> f;) info.missing.push_back(f);
    const std::string velo = cfg.read_string("DRIVE", "velo_on_vehicle", "");
    if (!velo.empty()) info.T_vehicle_velo = poseFromText(velo, origin + ": key velo_on_vehicle");
    info.gray = readCamera(cfg, "GRAY", origin);
    info.color = readCamera(cfg, "COLOR", origin);
    return info;
}

}  // namespace djpete::obs
