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

/// How surely an object is one, in the scale of its detector's scores: their mean.
double objectScore(const ObjectTrack& track);

/// A pose that changes by `twist` (m/s, rad/s, in its own frame) at the start.
struct MovingPose {
    geometry::SE3 T_world_obj;
    geometry::Vec6 twist;
};
/// The pose t_s after `start` on the way to T_world_end, which is reached after span_s > 0: on with
/// the twist, what that misses at the end spread smoothly over the way. Exact at both ends.
geometry::SE3 interpolated(const MovingPose& start, const geometry::SE3& T_world_end, double span_s,
                           double t_s);

}  // namespace djpete::map
