/// The program simulate-drive, to run in-process too.
#pragma once

#include <filesystem>
#include <iosfwd>

#include "djpete/simulator/drive_writer.h"

namespace djpete::apps {

class SimulateDriveApp {
  public:
    /// False after --help or --version. Throws obs::InputError on a wrong command line.
    bool initialize(int argc, const char* const* argv);
    /// Simulates; progress to stderr, a closing line to `out`. Throws std::runtime_error naming the
    /// file that cannot be written.
    void run(std::ostream& out);

    simulator::DriveOptions options;  ///< set by initialize
    std::filesystem::path folder;
};

}  // namespace djpete::apps
