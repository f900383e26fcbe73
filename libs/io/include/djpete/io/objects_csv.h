/// Object states as a table.
#pragma once

#include <string>

#include "djpete/map/slam_map.h"

namespace djpete::io {

/// One row per object and frame with a state: T_world_obj, velocity in world (m/s), standard
/// deviations in frame obj (m, rad; given the cameras). Comment lines first:
/// `# T_world_firstcam r00 r01 r02 tx r10 ... tz` and `# first_frame N`. Columns:
/// object_id,class,frame,time_s,x,y,z,qx,qy,qz,qw,length,width,height,vx,vy,vz,
/// sigma_x,sigma_y,sigma_z,sigma_yaw,observations,moving
/// time_s is UNIX time; empty if the map does not know the frame. Only frames from `first` on are
/// written, with `first` as frame 0.
void writeObjectsCsv(const map::SlamMap& map, const std::string& file, map::FrameId first = {});

}  // namespace djpete::io
