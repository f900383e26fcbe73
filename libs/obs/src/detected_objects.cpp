#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CText3D.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/optional_serialization.h>
#include <mrpt/serialization/stl_serialization.h>

#include <sstream>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/CObservationDetectedObjects.h"
#include "djpete/obs/CObservationVisualKeyframe.h"
#include "serialization.h"

IMPLEMENTS_SERIALIZABLE(CObservationDetectedObjects, CObservation, djpete::obs)

namespace djpete::obs {

namespace {

/// More detections than this in one frame means a damaged file, not a busy street.
constexpr uint32_t kMaxDetections = 1'000'000;

/// Sides of larger images mean damage too.
constexpr uint32_t kMaxSide_px = 65'535;

/// And more points around one object.
constexpr uint32_t kMaxPoints = 1'000'000;

void writeMask(mrpt::serialization::CArchive& out, const RleMask& m) {
    out << m.width_px << m.height_px << static_cast<uint32_t>(m.runs.size());
    for (uint32_t run : m.runs) out << run;
}

RleMask readMask(mrpt::serialization::CArchive& in) {
    RleMask m;
    uint32_t n = 0;
    in >> m.width_px >> m.height_px >> n;
    const uint64_t pixels = static_cast<uint64_t>(m.width_px) * m.height_px;
    if (m.width_px > kMaxSide_px || m.height_px > kMaxSide_px || n > pixels + 1)
        THROW_EXCEPTION("CObservationDetectedObjects: damaged mask");
    for (uint32_t i = 0; i < n; ++i) {
        uint32_t run = 0;
        in >> run;
        m.runs.push_back(run);
    }
    if (!m.consistent()) THROW_EXCEPTION("CObservationDetectedObjects: damaged mask");
    return m;
}

void writePoints(mrpt::serialization::CArchive& out, const std::vector<ObjectPoints::Point>& all) {
    out << static_cast<uint32_t>(all.size());
    for (const auto& p : all) writeMatrix(out, p);
}

std::vector<ObjectPoints::Point> readPoints(mrpt::serialization::CArchive& in) {
    uint32_t n = 0;
    in >> n;
    if (n > kMaxPoints) THROW_EXCEPTION("CObservationDetectedObjects: damaged points");
    std::vector<ObjectPoints::Point> out(n);
    for (auto& p : out) {
        readMatrix(in, p);
        if (!p.allFinite()) THROW_EXCEPTION("CObservationDetectedObjects: damaged points");
    }
    return out;
}

void write(mrpt::serialization::CArchive& out, const ObjectDetection& d) {
    out << static_cast<uint8_t>(d.objectClass) << d.score;
    writeMatrix(out, d.size_m);
    writePose(out, d.T_sensor_obj);
    writeMatrix(out, d.information);
    out << d.box.has_value();
    if (d.box) out << d.box->left << d.box->top << d.box->right << d.box->bottom;
    out << d.mask.has_value();
    if (d.mask) writeMask(out, *d.mask);
    out << d.source << d.sourceTrackId.has_value() << d.sourceTrackId.value_or(0);
    out << (d.points != nullptr);
    if (!d.points) return;
    writePoints(out, d.points->body);
    writePoints(out, d.points->ground);
    writeMatrix(out, d.points->origin);
}

ObjectDetection readDetection(mrpt::serialization::CArchive& in, uint8_t version) {
    ObjectDetection d;
    uint8_t cls = 0;
    bool has = false;
    in >> cls >> d.score;
    d.objectClass =
        static_cast<ObjectClass>(std::min<uint8_t>(cls, static_cast<uint8_t>(ObjectClass::Other)));
    readMatrix(in, d.size_m);
    d.T_sensor_obj = readPose(in);
    readMatrix(in, d.information);
    in >> has;
    if (has) {
        ImageBox b;
        in >> b.left >> b.top >> b.right >> b.bottom;
        d.box = b;
    }
    in >> has;
    if (has) {
        d.mask = readMask(in);
    }
    int32_t id = 0;
    in >> d.source >> has >> id;
    if (has) d.sourceTrackId = id;
    if (version < 1) return d;  // points came with version 1
    in >> has;
    if (!has) return d;
    ObjectPoints points;
    points.body = readPoints(in);
    points.ground = readPoints(in);
    readMatrix(in, points.origin);
    d.points = std::make_shared<ObjectPoints>(std::move(points));
    return d;
}

}  // namespace

uint8_t CObservationDetectedObjects::serializeGetVersion() const { return 1; }

void CObservationDetectedObjects::serializeTo(mrpt::serialization::CArchive& out) const {
    out << sensorLabel << timestamp << sensorPose << static_cast<uint32_t>(detections.size());
    for (const auto& d : detections) write(out, d);
}

void CObservationDetectedObjects::serializeFrom(mrpt::serialization::CArchive& in,
                                                uint8_t version) {
    if (version > 1) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
    uint32_t n = 0;
    in >> sensorLabel >> timestamp >> sensorPose >> n;
    if (n > kMaxDetections) THROW_EXCEPTION("CObservationDetectedObjects: damaged data");
    detections.clear();
    for (uint32_t i = 0; i < n; ++i) detections.push_back(readDetection(in, version));
}

void CObservationDetectedObjects::getDescriptionAsText(std::ostream& o) const {
    CObservation::getDescriptionAsText(o);
    o << "Sensor pose on vehicle: " << sensorPose << "\n"
      << detections.size() << " detected objects\n";
    for (const auto& d : detections) {
        o << "  " << toString(d.objectClass) << " score " << d.score << ", size l w h "
          << d.size_m.transpose() << " m, pose in sensor " << geometry::toCPose3D(d.T_sensor_obj)
          << ", source " << d.source;
        if (d.sourceTrackId) o << ", track " << *d.sourceTrackId;
        if (d.box) {
            o << ", image box " << d.box->left << " " << d.box->top << " " << d.box->right << " "
              << d.box->bottom;
        }
        if (d.mask) o << ", mask of " << d.mask->area_px() << " pixels";
        o << "\n";
    }
}

std::string CObservationDetectedObjects::exportTxtHeader() const {
    return "count, then per object: class score length width height x y z qw qx qy qz";
}

std::string CObservationDetectedObjects::exportTxtDataRow() const {
    std::ostringstream o;
    o.precision(9);
    o << detections.size();
    for (const auto& d : detections) {
        const Eigen::Quaterniond q(d.T_sensor_obj.rotation());
        o << ' ' << toString(d.objectClass) << ' ' << d.score << ' ' << d.size_m.transpose() << ' '
          << d.T_sensor_obj.translation().transpose() << ' ' << q.w() << ' ' << q.x() << ' '
          << q.y() << ' ' << q.z();
    }
    return o.str();
}

void CObservationDetectedObjects::getVisualizationInto(mrpt::opengl::CSetOfObjects& o) const {
    for (const auto& d : detections) {
        const geometry::Vec3 h = 0.5 * d.size_m;
        auto box =
            mrpt::opengl::CBox::Create(mrpt::math::TPoint3D(-h.x(), -h.y(), -h.z()),
                                       mrpt::math::TPoint3D(h.x(), h.y(), h.z()), true, 2.0F);
        const mrpt::img::TColor colour = isVehicle(d.objectClass) ? mrpt::img::TColor(230, 120, 20)
                                                                  : mrpt::img::TColor(30, 120, 220);
        box->setColor_u8(colour);
        box->setBoxBorderColor(colour);
        const auto T_vehicle_obj = sensorPose + geometry::toCPose3D(d.T_sensor_obj);
        box->setPose(T_vehicle_obj);
        o.insert(box);
        std::ostringstream name;
        name.precision(2);
        name << toString(d.objectClass) << ' ' << d.score;
        auto text = mrpt::opengl::CText3D::Create(name.str(), "sans", 0.5);
        text->setColor_u8(colour);
        text->setLocation(T_vehicle_obj.x(), T_vehicle_obj.y(),
                          T_vehicle_obj.z() + d.size_m.maxCoeff());
        o.insert(text);
    }
}

void registerObservationClasses() {
    mrpt::rtti::registerClass(CLASS_ID(CObservationDetectedObjects));
    mrpt::rtti::registerClass(CLASS_ID(CObservationVisualKeyframe));
}

}  // namespace djpete::obs
