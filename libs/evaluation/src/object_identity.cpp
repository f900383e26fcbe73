#include "object_identity.h"

#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace djpete::evaluation {

namespace {

/// First and last frame of each visit.
std::vector<std::pair<std::size_t, std::size_t>> visitsOf(const LabelTrack& track,
                                                          std::size_t minGapFrames) {
    std::vector<std::pair<std::size_t, std::size_t>> visits;
    for (const auto& [frame, box] : track.boxes) {
        if (!box.inRange) continue;
        const bool stays = !visits.empty() && frame - visits.back().second <= minGapFrames;
        if (stays) {
            visits.back().second = frame;
        } else {
            visits.emplace_back(frame, frame);
        }
    }
    return visits;
}

}  // namespace

ObjectIdentity identityOf(const LabelTrack& track,
                          const std::map<std::size_t, int64_t>& objectOfFrame,
                          std::size_t minGapFrames) {
    ObjectIdentity out;
    std::optional<int64_t> last;
    for (const auto& [frame, object] : objectOfFrame) {
        if (last && object != *last) ++out.switches;
        last = object;
    }
    if (track.moving) return out;
    auto before = objectOfFrame.end();  // last match of the visit before, if there is one
    for (const auto& [first, end] : visitsOf(track, minGapFrames)) {
        const auto begin = objectOfFrame.lower_bound(first);
        const auto behind = objectOfFrame.upper_bound(end);
        const bool matched = begin != behind;
        if (matched && before != objectOfFrame.end()) {
            ++out.seenAgain;
            if (begin->second == before->second) ++out.knownAgain;
        }
        before = matched ? std::prev(behind) : objectOfFrame.end();
    }
    return out;
}

}  // namespace djpete::evaluation
