/// Whether a labelled object keeps one identity in the map. Private to the room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "label_tracks.h"

namespace djpete::evaluation {

struct ObjectIdentity {
    std::size_t switches = 0;
    std::size_t seenAgain = 0, knownAgain = 0;  ///< 0 for moving tracks
};

/// `objectOfFrame`: the map's object that was matched with the track's box in that frame.
/// A switch is a change of object from one matched frame to the next. A track is left for
/// `minGapFrames` or more frames without a box in range; it is seen again if it was matched in the
/// visit before and in the visit after, and known again if the last object before is the first
/// after.
ObjectIdentity identityOf(const LabelTrack& track,
                          const std::map<std::size_t, int64_t>& objectOfFrame,
                          std::size_t minGapFrames);

}  // namespace djpete::evaluation
