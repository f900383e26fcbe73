/// How objects are turned and merged: rules on values.
#pragma once

#include "djpete/map/entities.h"

namespace djpete::map {

/// The same box with its heading turned by pi about its z axis: x points to the other end. Poses,
/// information, covariance and twist speak in the turned frame.
ObjectObservation turnedRound(ObjectObservation observation);
ObjectState turnedRound(ObjectState state);
ObjectTrack turnedRound(ObjectTrack track);

/// `kept` with what `gone` saw: its observations and states at frames where `kept` has none. Class
/// and id are those of `kept`; the size is the mean, weighed by the numbers of observations. Both
/// must have the same heading.
ObjectTrack merged(ObjectTrack kept, const ObjectTrack& gone);

}  // namespace djpete::map
