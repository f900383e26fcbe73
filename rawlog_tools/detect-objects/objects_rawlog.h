/// The companion rawlog of detections being written.
#pragma once

#include <mrpt/io/CFileGZOutputStream.h>

#include <filesystem>
#include <string>

#include "djpete/obs/CObservationDetectedObjects.h"

namespace djpete::detect_objects {

/// Appends to a compressed rawlog; what was appended is in the file whatever happens after.
class ObjectsRawlog {
  public:
    /// Creates `file` (and its folder). Throws InputError if it cannot be created.
    explicit ObjectsRawlog(const std::filesystem::path& file);
    /// Throws InputError if the disk takes no more.
    void write(const obs::CObservationDetectedObjects& objects);

  private:
    std::filesystem::path file_;
    mrpt::io::CFileGZOutputStream stream_;
};

/// "<folder>/<name>_<what>.rawlog" for "<folder>/<name>.rawlog".
std::filesystem::path companionOf(const std::filesystem::path& drive, const std::string& what);

}  // namespace djpete::detect_objects
