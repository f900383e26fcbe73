#include "djpete/simulator/faults.h"

#include <algorithm>
#include <sstream>

#include "number_rows.h"

namespace djpete::simulator {

const std::array<FaultName, 10>& faultNames() {
    static const std::array<FaultName, 10> kNames{{
        {FaultKind::DroppedFrames, "dropped-frames", "no file of any sensor and no label", false},
        {FaultKind::BlackFrames, "black-frames", "all images are black", false},
        {FaultKind::SwappedCameras, "swapped-cameras", "left and right images change places",
         false},
        {FaultKind::TimeJump, "time-jump", "times.txt is one second ahead", false},
        {FaultKind::LongBaseline, "baseline+1%", "calib.txt states a baseline 1 % too long", true},
        {FaultKind::ShortBaseline, "baseline-1%", "calib.txt states a baseline 1 % too short",
         true},
        {FaultKind::ExtrinsicTilt, "extrinsic-tilt",
         "Tr of calib.txt is turned by 1 degree about the camera's x axis", true},
        {FaultKind::NanPoints, "nan-points", "one LiDAR point in twenty has no numbers", false},
        {FaultKind::SparseBeams, "sparse-beams", "one LiDAR beam in four works", false},
        {FaultKind::ExposureSwing, "exposure",
         "the exposure of all cameras goes up to 1 + F and down to 1 / (1 + F) of what it would be",
         true, 2},
    }};
    return kNames;
}

Fault faultAtItsPlace(FaultKind kind, uint64_t driveBegin, uint64_t driveEnd) {
    const uint64_t n = driveEnd - driveBegin;
    const auto& names = faultNames();
    const auto name = std::find_if(names.begin(), names.end(),
                                   [kind](const FaultName& f) { return f.kind == kind; });
    if (name->ofDrive) return {kind, driveBegin, driveEnd};
    uint64_t length = std::max<uint64_t>(1, n / 3);
    if (kind == FaultKind::DroppedFrames || kind == FaultKind::BlackFrames)
        length = std::min<uint64_t>(length, 5);
    const uint64_t begin = driveBegin + (n - length) / 2;
    return {kind, begin, begin + length};
}

bool isFaulty(const std::vector<Fault>& faults, FaultKind kind, uint64_t frame) {
    return std::any_of(faults.begin(), faults.end(), [&](const Fault& f) {
        return f.kind == kind && frame >= f.begin && frame < f.end;
    });
}

bool hasFault(const std::vector<Fault>& faults, FaultKind kind) {
    return std::any_of(faults.begin(), faults.end(),
                       [kind](const Fault& f) { return f.kind == kind; });
}

double amountOf(const std::vector<Fault>& faults, FaultKind kind) {
    const auto at = std::find_if(faults.begin(), faults.end(),
                                 [kind](const Fault& f) { return f.kind == kind; });
    return at == faults.end() ? 0 : at->amount;
}

std::string wordOf(const Fault& fault) {
    for (const auto& name : faultNames()) {
        if (name.kind != fault.kind) continue;
        return name.name + (name.mostAmount > 0 ? numberRow({fault.amount}, "=%.10g") : "");
    }
    return "";
}

std::string faultTable(const std::vector<Fault>& faults) {
    std::ostringstream out;
    for (const auto& fault : faults) {
        for (const auto& name : faultNames()) {
            if (name.kind == fault.kind)
                out << wordOf(fault) << " " << fault.begin << " " << fault.end - 1 << " "
                    << name.what << "\n";
        }
    }
    return out.str();
}

}  // namespace djpete::simulator
