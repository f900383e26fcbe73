/// A simulated drive in KITTI's folder layout.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "djpete/simulator/faults.h"
#include "djpete/simulator/labels.h"
#include "djpete/simulator/oxts.h"
#include "djpete/simulator/renderer.h"

namespace djpete::simulator {

/// Frames begin .. end-1.
struct Frames {
    uint64_t begin = 0, end = 0;
};

struct DriveOptions {
    WorldOptions world;
    uint64_t begin = 0, end = 100;  ///< frames begin .. end-1 are written
    int width_px = 1241, height_px = 376;
    bool scans = true;   ///< velodyne
    bool colour = true;  ///< image_2 and image_3
    LidarOptions lidar;
    LabelOptions labels;
    DetectorNoise detector;
    OxtsNoise oxts;
    double objectRange_m = 80;  ///< objects.txt holds what is nearer than this, or in the image
    std::vector<Frames> depth;  ///< frames with depth pictures
    std::vector<Fault> faults;
    bool map = false;        ///< map.png
    double meshTexel_m = 0;  ///< if above 0, objects/NNN.ply are written, with edges of this length
    bool resume = false;     ///< keep the frames that a broken run has completed
    unsigned threads = 2;
};

/// What a written drive is like.
struct DriveReport {
    double movingShare = 0;  ///< of the left image that moving vehicles cover, mean over the frames
};

/// Called after each frame with how many are done and how many there are.
using Progress = std::function<void(uint64_t done, uint64_t all)>;

/// Writes a drive; files carry the number of their frame.
///
/// Sensors: image_0 .. image_3, velodyne (x, y, z, reflectance; beam after beam), oxts (a row of
/// KITTI's raw data per file), calib.txt, calib_imu_to_velo.txt, times.txt. Cameras 2 and 3 stand
/// where 0 and 1 do, so P2 = P0 and P3 = P1, labels hold for both, and grey is the luma of colour.
///
/// Truth: poses.txt (camera 0 seen from camera 0 of frame 0 without lane offset), label_02.txt,
/// objects.txt (where actors are and how they move), exposure.txt, moving.txt (share of the left
/// image that moving cars, vans and trucks cover, per frame), and of the left camera instances
/// (16-bit PNG in KITTI's MOTS coding: 1000 * class + track id for the labelled, class 1 for cars,
/// vans and trucks, 2 for pedestrians; 10000, "ignore", for cyclists and the unlabelled; 0
/// elsewhere) and depth (16-bit PNG, metres * 256, of chosen frames). With `map`, map.png shows the
/// streets from above at the first frame. objects/NNN.ply is the shape of each labelled actor with
/// its albedo, in frame obj. detections.txt has the labels as a noisy detector would give them.
///
/// Rows of times.txt and poses.txt start at frame 0. faults.txt says what was made wrong.
/// drive_options.txt says what the drive was made with; a run with `resume` needs the same and ends
/// with the same bytes as an unbroken one. A frame has the same bytes whatever range it is written
/// with. While a drive is being written, the rows of its tables are in the folder `unfinished`.
///
/// Throws std::runtime_error naming the file that cannot be written.
DriveReport writeDrive(const DriveOptions& options, const std::filesystem::path& folder,
                       const Progress& progress);

}  // namespace djpete::simulator
