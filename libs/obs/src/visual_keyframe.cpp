#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/serialization/CArchive.h>

#include <sstream>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/CObservationVisualKeyframe.h"
#include "serialization.h"

IMPLEMENTS_SERIALIZABLE(CObservationVisualKeyframe, CObservation, djpete::obs)

namespace djpete::obs {

namespace {

constexpr uint32_t kMaxFeatures = 10'000'000;

void write(mrpt::serialization::CArchive& out, const KeyframeFeature& f) {
    out << f.track.value << f.u_px << f.v_px << f.sigma_px << f.uRight_px.has_value()
        << f.uRight_px.value_or(0.F) << f.uRightSigma_px << f.depth_m.has_value()
        << f.depth_m.value_or(0.F) << f.depthSigma_m << f.rgb[0] << f.rgb[1] << f.rgb[2]
        << f.descriptor.has_value();
    if (f.descriptor) {
        for (const uint64_t bits : *f.descriptor) out << bits;
    }
}

KeyframeFeature readFeature(mrpt::serialization::CArchive& in, uint8_t version) {
    KeyframeFeature f;
    bool hasRight = false, hasDepth = false;
    float uRight = 0, depth = 0;
    in >> f.track.value >> f.u_px >> f.v_px >> f.sigma_px >> hasRight >> uRight >>
        f.uRightSigma_px >> hasDepth >> depth >> f.depthSigma_m >> f.rgb[0] >> f.rgb[1] >> f.rgb[2];
    if (hasRight) f.uRight_px = uRight;
    if (hasDepth) f.depth_m = depth;
    bool hasDescriptor = false;
    if (version >= 1) in >> hasDescriptor;
    if (hasDescriptor) {
        f.descriptor.emplace();
        for (uint64_t& bits : *f.descriptor) in >> bits;
    }
    return f;
}

std::optional<double> depthOf(const KeyframeFeature& f, const geometry::StereoCamera& camera) {
    if (f.depth_m) return *f.depth_m;
    if (!f.uRight_px || !camera.hasRight()) return std::nullopt;
    const double disparity = static_cast<double>(f.u_px) - static_cast<double>(*f.uRight_px);
    if (disparity <= 0.5) return std::nullopt;
    return camera.depthFromDisparity(disparity);
}

}  // namespace

uint8_t CObservationVisualKeyframe::serializeGetVersion() const { return 2; }

void CObservationVisualKeyframe::serializeTo(mrpt::serialization::CArchive& out) const {
    out << sensorLabel << timestamp << sensorPose << frame.value << isKeyframe << tracked;
    writeCamera(out, camera);
    writePose(out, T_odom_cam);
    out << static_cast<uint32_t>(features.size());
    for (const auto& f : features) write(out, f);
    out << scanMotion.has_value();
    if (!scanMotion) return;
    out << scanMotion->from.value;
    writePose(out, scanMotion->T_from_cam);
    writeMatrix(out, scanMotion->information);
}

void CObservationVisualKeyframe::serializeFrom(mrpt::serialization::CArchive& in, uint8_t version) {
    if (version > 2) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
    in >> sensorLabel >> timestamp >> sensorPose >> frame.value >> isKeyframe >> tracked;
    camera = readCamera(in);
    T_odom_cam = readPose(in);
    uint32_t n = 0;
    in >> n;
    if (n > kMaxFeatures) THROW_EXCEPTION("CObservationVisualKeyframe: damaged data");
    features.clear();
    for (uint32_t i = 0; i < n; ++i) features.push_back(readFeature(in, version));
    scanMotion.reset();
    bool hasScanMotion = false;
    if (version >= 2) in >> hasScanMotion;
    if (!hasScanMotion) return;
    scanMotion.emplace();
    in >> scanMotion->from.value;
    scanMotion->T_from_cam = readPose(in);
    readMatrix(in, scanMotion->information);
}

void CObservationVisualKeyframe::getDescriptionAsText(std::ostream& o) const {
    CObservation::getDescriptionAsText(o);
    std::size_t withRight = 0, withDepth = 0;
    for (const auto& f : features) {
        withRight += f.uRight_px.has_value() ? 1U : 0U;
        withDepth += f.depth_m.has_value() ? 1U : 0U;
    }
    o << (isKeyframe ? "Keyframe" : "Frame") << " " << frame.value
      << (tracked ? "" : " (predicted only)") << "\nCamera on vehicle: " << sensorPose
      << "\nT_odom_cam: " << geometry::toCPose3D(T_odom_cam) << "\n"
      << features.size() << " features, " << withRight << " with a stereo match, " << withDepth
      << " with LiDAR depth\n";
    if (scanMotion) o << "Scan matched with that of frame " << scanMotion->from.value << "\n";
}

std::string CObservationVisualKeyframe::exportTxtHeader() const {
    return "frame is_keyframe tracked x y z qw qx qy qz features";
}

std::string CObservationVisualKeyframe::exportTxtDataRow() const {
    const Eigen::Quaterniond q(T_odom_cam.rotation());
    std::ostringstream o;
    o.precision(9);
    o << frame.value << ' ' << isKeyframe << ' ' << tracked << ' '
      << T_odom_cam.translation().transpose() << ' ' << q.w() << ' ' << q.x() << ' ' << q.y() << ' '
      << q.z() << ' ' << features.size();
    return o.str();
}

void CObservationVisualKeyframe::getVisualizationInto(mrpt::opengl::CSetOfObjects& o) const {
    auto cloud = mrpt::opengl::CPointCloudColoured::Create();
    for (const auto& f : features) {
        const auto depth = depthOf(f, camera);
        if (!depth) continue;
        const geometry::Vec3 p = camera.backProject({f.u_px, f.v_px}, *depth);
        cloud->push_back(static_cast<float>(p.x()), static_cast<float>(p.y()),
                         static_cast<float>(p.z()), static_cast<float>(f.rgb[0]) / 255.F,
                         static_cast<float>(f.rgb[1]) / 255.F,
                         static_cast<float>(f.rgb[2]) / 255.F);
    }
    cloud->setPointSize(3.F);
    cloud->setPose(sensorPose);
    o.insert(cloud);
}

}  // namespace djpete::obs
