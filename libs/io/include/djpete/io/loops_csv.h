/// Places known again, as a table.
#pragma once

#include <string>
#include <vector>

#include "djpete/map/entities.h"

namespace djpete::io {

/// One row per pair of views that was believed, in that order: drive and frame of both, features
/// that agree, whether the map had said so (near) and whether two worlds were joined, how far the
/// newer camera was off, and T_older_newer as measured. Columns:
/// older_drive,older_frame,newer_drive,newer_frame,features,near,joined,correction_m,correction_deg,
/// x,y,z,qx,qy,qz,qw
/// Throws obs::InputError naming the file if it cannot be written.
void writeLoopsCsv(const std::vector<map::LoopRecord>& loops, const std::string& file);

}  // namespace djpete::io
