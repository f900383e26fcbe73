/// The program detect-objects, to run in-process too.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>

#include "djpete/observers/geometric_observer.h"
#include "djpete_app/frame_range.h"

namespace djpete::detect_objects {

/// What is to be done.
struct Job {
    std::filesystem::path drive, out;
    std::string observer = "geometric";                 ///< or "recorded" or "network"
    std::string network;                                ///< ONNX file of the network observer
    std::optional<std::filesystem::path> recordedFrom;  ///< nothing: the drive's own detections
    observers::GeometricObserverOptions geometric;
    apps::FrameRange range;
};

/// What came of it; also filled when run() throws.
struct Report {
    uint64_t frames = 0;      ///< read and in range
    uint64_t observed = 0;    ///< of these, frames of which the observer could say something
    uint64_t detections = 0;  ///< objects written
};

class DetectObjectsApp {
  public:
    /// Parses the command line. Returns false if it only asked for help, the version or the
    /// configuration, which was printed. Throws InputError on a wrong command line or INI.
    bool initialize(int argc, const char* const* argv);
    /// Writes one CObservationDetectedObjects (stamp of the frame, label "detections") per frame
    /// that the observer can say something about. Progress goes to stderr, a closing line to `out`.
    /// Throws InputError; what was detected before is in the file.
    void run(std::ostream& out);

    Job job;        ///< set by initialize
    Report report;  ///< set by run
};

}  // namespace djpete::detect_objects
