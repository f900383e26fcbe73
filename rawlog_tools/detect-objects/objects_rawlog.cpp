#include "objects_rawlog.h"

#include <mrpt/serialization/CArchive.h>

#include "djpete/obs/errors.h"

namespace djpete::detect_objects {

ObjectsRawlog::ObjectsRawlog(const std::filesystem::path& file) : file_(file) {
    std::error_code error;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
    if (std::filesystem::is_directory(file) || !stream_.open(file.string())) {
        throw obs::InputError(file.string() + ": cannot be written; expected a path for a rawlog");
    }
}

void ObjectsRawlog::write(const obs::CObservationDetectedObjects& objects) {
    try {
        mrpt::serialization::archiveFrom(stream_) << objects;
    } catch (const std::exception&) {
        throw obs::InputError(file_.string() + ": cannot be written to; is the disk full?");
    }
}

std::filesystem::path companionOf(const std::filesystem::path& drive, const std::string& what) {
    return drive.parent_path() / (drive.stem().string() + "_" + what + ".rawlog");
}

}  // namespace djpete::detect_objects
