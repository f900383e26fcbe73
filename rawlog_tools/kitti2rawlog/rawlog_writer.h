/// A rawlog being written: its head, then observations in order.
#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservation.h>

#include <filesystem>

#include "djpete/obs/calibration.h"

namespace djpete::kitti2rawlog {

/// Appends to a compressed rawlog; what was appended is in the file whatever happens after.
class RawlogWriter {
  public:
    /// Creates `file` and writes the head comment. Throws InputError if it cannot be created.
    RawlogWriter(const std::filesystem::path& file, const obs::DriveInfo& info,
                 mrpt::Clock::time_point stamp);
    /// Throws InputError if the disk takes no more.
    void write(const mrpt::obs::CObservation& observation);
    const std::filesystem::path& file() const { return file_; }

  private:
    std::filesystem::path file_;
    mrpt::io::CFileGZOutputStream stream_;
};

}  // namespace djpete::kitti2rawlog
