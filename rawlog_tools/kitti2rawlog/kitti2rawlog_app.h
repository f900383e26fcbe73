/// The program kitti2rawlog, to run in-process too.
#pragma once

#include <iosfwd>

#include "conversion.h"

namespace djpete::kitti2rawlog {

class Kitti2RawlogApp {
  public:
    /// Parses the command line. Returns false if it asked for help or the version, which was
    /// printed. Throws InputError on options that are unknown, incomplete or contradictory.
    bool initialize(int argc, const char* const* argv);
    /// Converts; progress goes to stderr, a closing line to `out`. Throws InputError.
    void run(std::ostream& out);

    ConversionJob job;        ///< set by initialize
    ConversionReport report;  ///< set by run
};

}  // namespace djpete::kitti2rawlog
