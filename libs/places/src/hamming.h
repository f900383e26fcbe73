/// How many bits of two descriptors differ.
#pragma once

#include <vector>

#include "djpete/obs/CObservationVisualKeyframe.h"

namespace djpete::places {

/// Differing bits, without any special instruction.
unsigned hammingPortable(const obs::Descriptor& a, const obs::Descriptor& b);

/// The nearest and the second nearest of some descriptors.
struct Nearest {
    static constexpr unsigned kNone = 257;
    unsigned best = kNone, second = kNone;  ///< differing bits
    unsigned index = 0;                     ///< of the best; the first of equals
};
/// For each of `from`, its nearest among `to`. Uses the processor's bit count where it has one;
/// the result is the same without.
std::vector<Nearest> nearest(const std::vector<obs::Descriptor>& from,
                             const std::vector<obs::Descriptor>& to);
std::vector<Nearest> nearestPortable(const std::vector<obs::Descriptor>& from,
                                     const std::vector<obs::Descriptor>& to);

/// Distance from one descriptor, counted the fastest way of this processor.
using HammingFunction = unsigned (*)(const obs::Descriptor&, const obs::Descriptor&);
HammingFunction hammingFunction();

}  // namespace djpete::places
