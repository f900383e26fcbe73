#include "djpete/io/loops_csv.h"

#include <cmath>

#include "text_file.h"

namespace djpete::io {

namespace {

std::string driveAndFrame(map::FrameId frame) {
    return std::to_string(frame.value / map::kFramesPerDrive) + "," +
           std::to_string(frame.value % map::kFramesPerDrive);
}

}  // namespace

void writeLoopsCsv(const std::vector<map::LoopRecord>& loops, const std::string& file) {
    TextFile out(file);
    out.text(
        "older_drive,older_frame,newer_drive,newer_frame,features,near,joined,correction_m,"
        "correction_deg,x,y,z,qx,qy,qz,qw\n");
    for (const auto& loop : loops) {
        out.text(driveAndFrame(loop.olderFrame) + "," + driveAndFrame(loop.newerFrame) + "," +
                 std::to_string(loop.features) + (loop.near ? ",1" : ",0") +
                 (loop.joined ? ",1" : ",0"));
        out.number(loop.correction_m, ',');
        out.number(loop.correction_rad * 180 / M_PI, ',');
        for (const double v : poseNumbers(loop.T_older_newer)) out.number(v, ',');
        out.text("\n");
    }
    out.close();
}

}  // namespace djpete::io
