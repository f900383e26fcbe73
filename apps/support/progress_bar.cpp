#include "djpete_app/progress_bar.h"

#include <unistd.h>

#include <iostream>

namespace djpete::apps {

ProgressBar::ProgressBar() : terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressBar::show(uint64_t done, uint64_t all, const std::string& note) {
    const std::string count =
        std::to_string(done) + (all == 0 ? "" : "/" + std::to_string(all)) + " frames";
    if (terminal_) {
        const auto ticks = static_cast<std::size_t>(all == 0 ? 0 : done * 30 / all);
        const std::string bar =
            all == 0 ? "" : "[" + std::string(ticks, '#') + std::string(30 - ticks, '.') + "] ";
        std::cerr << "\r\033[K" << bar << count << "  " << note << std::flush;
        shown_ = true;
        return;
    }
    const uint64_t step = all == 0 ? done / 50 : done * 10 / all;
    if (step == lastStep_) return;
    lastStep_ = step;
    std::cerr << count << (note.empty() ? "" : "  " + note) << "\n";
}

void ProgressBar::finish() {
    if (shown_) std::cerr << "\n";
    shown_ = false;
}

}  // namespace djpete::apps
