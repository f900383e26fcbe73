#include "exposure_swing.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {

namespace {

constexpr uint64_t kTurn_frames = 12;
constexpr double kLeastLevel = 0.7;  // of the most, at the end of a turn
constexpr double kQuickTurn = 3.0 / kTurn_frames;
constexpr float kQuickShare = 1.F / 3;
constexpr uint32_t kLevel = 0x5e1U, kSign = 0x5e2U, kQuick = 0x5e3U;  // tell the hashes apart

/// -1 .. 1 at the begin of a turn; the signs alternate.
double levelAt(uint32_t seed, uint64_t turn) {
    const auto k = static_cast<uint32_t>(turn);
    const double size =
        kLeastLevel + (1 - kLeastLevel) * static_cast<double>(unit(hash(seed, k, kLevel)));
    return ((turn + hash(seed, kSign)) % 2 == 0) ? size : -size;
}

}  // namespace

double exposureSwing(uint32_t seed, uint64_t frame, double amount) {
    const uint64_t turn = frame / kTurn_frames;
    double share = static_cast<double>(frame % kTurn_frames) / kTurn_frames;
    if (unit(hash(seed, static_cast<uint32_t>(turn), kQuick)) < kQuickShare)
        share = std::clamp((share - 0.5) / kQuickTurn + 0.5, 0.0, 1.0);
    share = share * share * (3 - 2 * share);
    const double from = levelAt(seed, turn), to = levelAt(seed, turn + 1);
    return std::exp((from + (to - from) * share) * std::log1p(amount));
}

}  // namespace djpete::simulator
