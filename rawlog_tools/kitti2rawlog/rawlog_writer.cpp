#include "rawlog_writer.h"

#include <mrpt/obs/CObservationComment.h>
#include <mrpt/serialization/CArchive.h>

#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"

namespace djpete::kitti2rawlog {

RawlogWriter::RawlogWriter(const std::filesystem::path& file, const obs::DriveInfo& info,
                           mrpt::Clock::time_point stamp)
    : file_(file) {
    std::error_code error;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
    if (std::filesystem::is_directory(file) || !stream_.open(file.string())) {
        throw obs::InputError(file.string() + ": cannot be written; expected a path for a rawlog");
    }
    mrpt::obs::CObservationComment head;
    head.sensorLabel = obs::label::kCalibration;
    head.timestamp = stamp;
    head.text = obs::toIniText(info);
    write(head);
}

void RawlogWriter::write(const mrpt::obs::CObservation& observation) {
    try {
        mrpt::serialization::archiveFrom(stream_) << observation;
    } catch (const std::exception&) {
        throw obs::InputError(file_.string() + ": cannot be written to; is the disk full?");
    }
}

}  // namespace djpete::kitti2rawlog
