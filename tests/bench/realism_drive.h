/// A drive in KITTI's layout, as the realism bench reads it.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kitti_folder.h"

namespace djpete_bench {

using djpete::geometry::SE3;

/// A box of label_02, in the frame of camera 0.
struct LabelledBox {
    std::size_t frame = 0;
    std::string type;
    double truncation = 0;
    int occlusion = 0;
    djpete::geometry::Vec3 size_m;  ///< length, width, height
    SE3 T_cam_obj;                  ///< obj: centre of the box, x ahead, z up
};

/// Frames `begin` to `end` - 1 of a drive, those that are there.
struct RealismDrive {
    std::string name;
    djpete_test::KittiFolder folder;
    std::vector<std::size_t> frames;
    std::vector<SE3> T_first_cam;  ///< true poses of all frames, or empty
    std::vector<LabelledBox> boxes;

    /// 8 bit grey. Throws std::runtime_error naming a file that cannot be read.
    cv::Mat left(std::size_t frame) const;
    cv::Mat right(std::size_t frame) const;
    /// Points in `velo`; nothing if the frame has no scan.
    std::optional<djpete::obs::LidarScan> scan(std::size_t frame) const;
};

/// A drive in the layout of KITTI odometry. Poses come from its own poses.txt, or else from
/// `poses` (may be empty). Throws std::runtime_error if there is no frame in the range.
RealismDrive openOdometryDrive(const std::filesystem::path& dir, std::size_t begin, std::size_t end,
                               const std::filesystem::path& poses);
/// A drive in KITTI's raw layout with a label file of the tracking benchmark.
RealismDrive openRawDrive(const std::filesystem::path& dir, const std::filesystem::path& labels);

}  // namespace djpete_bench
