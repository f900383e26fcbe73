/// Where KITTI's benchmarks keep their files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace djpete::kitti2rawlog {

enum class Layout { Odometry, Raw, Tracking, Object };
std::string toString(Layout layout);

/// Files by KITTI's frame number. Gaps are normal.
using FramedFiles = std::map<uint64_t, std::filesystem::path>;

/// The files of one drive; nothing has been read from them yet.
struct DriveFiles {
    Layout layout = Layout::Odometry;
    std::string name;                   ///< e.g. "kitti odometry 00"
    std::filesystem::path calibration;  ///< file; folder of calib_*.txt in the raw layout
    std::array<FramedFiles, 4> images;  ///< rectified cameras 0..3
    FramedFiles scans;                  ///< Velodyne .bin
    FramedFiles oxtsFiles;              ///< one packet per file (raw)
    FramedFiles instances;              ///< 16-bit masks, KITTI MOTS coding
    FramedFiles frameLabels;            ///< one label file per frame (object)
    std::optional<std::filesystem::path> oxtsTable;  ///< row i = frame i (tracking)
    std::optional<std::filesystem::path> times;      ///< row i = frame i, seconds or date
    std::optional<std::filesystem::path> poses;      ///< row i = frame i
    std::optional<std::filesystem::path> labels, detections;

    bool hasImages() const;
    bool hasSensors() const;  ///< images, scans or OXTS packets
};

/// Recognises the layout of `input`:
///   odometry  sequences/00: calib.txt, times.txt, image_0..3, velodyne; poses.txt beside them or
///             ../../poses/00.txt. The simulator's folder is this with label_02.txt,
///             detections.txt and instances/.
///   raw       2011_09_26/2011_09_26_drive_0005_sync: image_00..03/data, velodyne_points/data,
///             oxts/data, timestamps.txt of each; calib_*.txt one level up
///   tracking  training with `sequence` "0006", or training/image_02/0006 (any sensor's folder or
///             label file): image_02, image_03, velodyne, oxts, label_02, calib, instances
///   object    training: image_2, velodyne, label_2, calib with one file per frame
/// Throws InputError if the folder is missing or none of these.
DriveFiles findDrive(const std::filesystem::path& input, const std::string& sequence);

/// Files of `folder` named by a number and ending in `extension`, e.g. 000012.png; empty if there
/// is no such folder.
FramedFiles listFrames(const std::filesystem::path& folder, const std::string& extension);

}  // namespace djpete::kitti2rawlog
