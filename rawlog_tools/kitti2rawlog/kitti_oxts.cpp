#include "kitti_oxts.h"

#include <mrpt/obs/gnss_messages.h>
#include <mrpt/system/datetime.h>

#include <algorithm>
#include <cmath>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"
#include "text_table.h"

namespace djpete::kitti2rawlog {

namespace {

OxtsPacket packet(const TextRow& row) {
    const auto v = row.numbers(0, 30, "an OXTS packet");
    OxtsPacket p;
    p.latitude_deg = v[0];
    p.longitude_deg = v[1];
    p.altitude_m = v[2];
    p.roll_rad = v[3];
    p.pitch_rad = v[4];
    p.yaw_rad = v[5];
    p.acceleration = {v[11], v[12], v[13]};
    p.rate = {v[17], v[18], v[19]};
    p.satellites = static_cast<int>(std::clamp(v[26], 0.0, 1000.0));
    return p;
}

}  // namespace

std::map<uint64_t, OxtsPacket> readOxts(const DriveFiles& drive) {
    std::map<uint64_t, OxtsPacket> out;
    for (const auto& [frame, file] : drive.oxtsFiles) {
        const auto rows = readRows(file, "an OXTS packet");
        if (rows.size() != 1) {
            throw obs::InputError(file.string() + ": " + std::to_string(rows.size()) +
                                  " lines; expected one OXTS packet");
        }
        out.emplace(frame, packet(rows.front()));
    }
    if (drive.oxtsTable) {
        uint64_t frame = 0;
        for (const auto& row : readRows(*drive.oxtsTable, "OXTS packets"))
            out.emplace(frame++, packet(row));
    }
    return out;
}

mrpt::obs::CObservationGPS::Ptr gpsObservation(const OxtsPacket& p, mrpt::Clock::time_point stamp,
                                               const geometry::SE3& T_vehicle_imu) {
    auto o = mrpt::obs::CObservationGPS::Create();
    o->sensorLabel = obs::label::kGps;
    o->timestamp = stamp;
    o->originalReceivedTimestamp = stamp;
    o->has_satellite_timestamp = true;
    o->sensorPose = geometry::toCPose3D(T_vehicle_imu);
    mrpt::obs::gnss::Message_NMEA_GGA gga;
    mrpt::system::TTimeParts parts;
    mrpt::system::timestampToParts(stamp, parts);
    gga.fields.UTCTime.hour = parts.hour;
    gga.fields.UTCTime.minute = parts.minute;
    gga.fields.UTCTime.sec = parts.second;
    gga.fields.latitude_degrees = p.latitude_deg;
    gga.fields.longitude_degrees = p.longitude_deg;
    gga.fields.altitude_meters = p.altitude_m;
    gga.fields.fix_quality = 1;
    gga.fields.satellitesUsed = static_cast<uint32_t>(p.satellites);
    o->setMsg(gga);
    return o;
}

mrpt::obs::CObservationIMU::Ptr imuObservation(const OxtsPacket& p, mrpt::Clock::time_point stamp,
                                               const geometry::SE3& T_vehicle_imu) {
    using namespace mrpt::obs;
    auto o = CObservationIMU::Create();
    o->sensorLabel = obs::label::kImu;
    o->timestamp = stamp;
    o->sensorPose = geometry::toCPose3D(T_vehicle_imu);
    o->set(IMU_X_ACC, p.acceleration.x());
    o->set(IMU_Y_ACC, p.acceleration.y());
    o->set(IMU_Z_ACC, p.acceleration.z());
    o->set(IMU_WX, p.rate.x());
    o->set(IMU_WY, p.rate.y());
    o->set(IMU_WZ, p.rate.z());
    o->set(IMU_YAW, p.yaw_rad);
    o->set(IMU_PITCH, p.pitch_rad);
    o->set(IMU_ROLL, p.roll_rad);
    const Eigen::Quaterniond q = Eigen::AngleAxisd(p.yaw_rad, geometry::Vec3::UnitZ()) *
                                 Eigen::AngleAxisd(p.pitch_rad, geometry::Vec3::UnitY()) *
                                 Eigen::AngleAxisd(p.roll_rad, geometry::Vec3::UnitX());
    o->set(IMU_ORI_QUAT_W, q.w());
    o->set(IMU_ORI_QUAT_X, q.x());
    o->set(IMU_ORI_QUAT_Y, q.y());
    o->set(IMU_ORI_QUAT_Z, q.z());
    return o;
}

}  // namespace djpete::kitti2rawlog
