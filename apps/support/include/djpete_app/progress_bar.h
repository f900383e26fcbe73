/// How far a program has come, on stderr.
#pragma once

#include <cstdint>
#include <string>

namespace djpete::apps {

/// A line that redraws itself on a terminal; elsewhere one line per tenth of the work (or per 50
/// frames when the amount is unknown).
class ProgressBar {
  public:
    ProgressBar();
    /// `all` 0: unknown. `note` stands at the end of the line.
    void show(uint64_t done, uint64_t all, const std::string& note = "");
    /// Ends the line on a terminal.
    void finish();

  private:
    bool terminal_;
    bool shown_ = false;
    uint64_t lastStep_ = UINT64_MAX;
};

}  // namespace djpete::apps
