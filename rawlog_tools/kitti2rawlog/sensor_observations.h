/// KITTI's images, scans and poses as MRPT observations that refer to their files.
#pragma once

#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CObservationStereoImages.h>

#include <filesystem>
#include <string>

#include "djpete/obs/calibration.h"

namespace djpete::kitti2rawlog {

/// Names external files as the rawlog shall: absolute where they are, or copied into
/// `<rawlog>_Images/` and relative to it.
class ExternalFiles {
  public:
    ExternalFiles(const std::filesystem::path& rawlog, bool copy);
    /// Image of KITTI's camera 0..3. Throws InputError if it cannot be copied.
    std::string put(const std::filesystem::path& image, std::size_t camera);
    std::string putScan(const std::filesystem::path& scan);

  private:
    std::string place(const std::filesystem::path& file, const std::string& folder);
    std::filesystem::path images_;
    bool copy_;
};

mrpt::obs::CObservationStereoImages::Ptr stereoObservation(const obs::RigCamera& camera,
                                                           const std::string& left,
                                                           const std::string& right,
                                                           mrpt::Clock::time_point stamp,
                                                           const std::string& label);
mrpt::obs::CObservationImage::Ptr monoObservation(const obs::RigCamera& camera,
                                                  const std::string& image,
                                                  mrpt::Clock::time_point stamp,
                                                  const std::string& label);
/// A KITTI .bin; the Velodyne is the vehicle frame.
mrpt::obs::CObservationPointCloud::Ptr scanObservation(const std::string& file,
                                                       mrpt::Clock::time_point stamp);
mrpt::obs::CObservationRobotPose::Ptr truthObservation(const geometry::SE3& T_world_vehicle,
                                                       mrpt::Clock::time_point stamp);

}  // namespace djpete::kitti2rawlog
