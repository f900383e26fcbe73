/// objects.csv: what is known of each object at each keyframe that saw it. This header is the
/// definition of the file; writer and reader follow it.
///
/// Text, '.' as decimal point, '\n' after every line:
///
///     # first_frame N
///     # T_world_firstcam r00 r01 r02 tx r10 r11 r12 ty r20 r21 r22 tz
///     object_id,class,frame,time_s,x,y,z,qx,qy,qz,qw,length,width,height,vx,vy,vz,sigma_x,...
///     0,Car,12,1.236,...
///
/// Both '#' lines are required and stand before the header line:
/// - first_frame: the frame number of the run's first frame, which is row 0 of the run's
///   trajectory.kitti.txt. The row of frame f is f - first_frame: that file has every frame.
/// - T_world_firstcam: row-major 3x4; `world` is the vehicle at first_frame and firstcam the camera
///   of trajectory.kitti.txt at first_frame. So T_world_cam(f) = T_world_firstcam * row(f -
///   first_frame). KITTI's labels are in the frame of camera 0; a trajectory that is to be compared
///   with them must be of that camera too.
///
/// The header line is exactly kObjectsCsvHeader. One row for each object and each keyframe in which
/// a detection was associated with it (none where it is only predicted), at most one per pair, the
/// pose being the final one of the map for that instant:
///
/// | column | meaning |
/// |---|---|
/// | object_id | integer >= 0, identity in the map |
/// | class | KITTI's word: Car, Van, Truck, Pedestrian, Cyclist, Tram, Misc |
/// | frame | the keyframe's frame number (KITTI's image number), not a row number |
/// | time_s | its time in seconds; any epoch, the same for all rows; empty if unknown |
/// | x,y,z,qx,qy,qz,qw | T_world_obj: box centre in metres and unit quaternion; obj: x length, z up
/// | | length,width,height | metres, > 0 | | vx,vy,vz | velocity of the centre in world axes, m/s;
/// 0 for a static object | | sigma_x,sigma_y,sigma_z | standard deviation of the centre along the
/// axes of obj, m, >= 0 | | sigma_yaw | standard deviation of the rotation about obj's z, rad, >= 0
/// | | observations | detections of the object over the whole run, integer >= 1 | | moving | 1 if
/// the map models the object as moving at this time, else 0 |
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "djpete/geometry/se3.h"
#include "djpete/obs/detection.h"

namespace djpete::evaluation {

constexpr const char* kObjectsCsvHeader =
    "object_id,class,frame,time_s,x,y,z,qx,qy,qz,qw,length,width,height,vx,vy,vz,sigma_x,sigma_y,"
    "sigma_z,sigma_yaw,observations,moving";

/// One row; see the table above.
struct ObjectRow {
    std::size_t line = 0;  ///< in the file, from 1
    int64_t objectId = 0;
    obs::ObjectClass objectClass = obs::ObjectClass::Car;
    std::size_t frame = 0;
    std::optional<double> time_s;
    geometry::SE3 T_world_obj;
    geometry::Vec3 size_m{0, 0, 0};
    geometry::Vec3 velocity_world{0, 0, 0};
    geometry::Vec3 sigma_m{0, 0, 0};
    double sigmaYaw_rad = 0;
    std::size_t observations = 0;
    bool moving = false;
};

struct ObjectsFile {
    std::string path;
    std::size_t firstFrame = 0;
    geometry::SE3 T_world_firstcam;
    std::vector<ObjectRow> rows;  ///< in the order of the file; none is fine
};

/// Throws obs::InputError naming file and line for anything that is not as defined above.
ObjectsFile readObjectsCsv(const std::string& path);

}  // namespace djpete::evaluation
