/// What can be wrong with a recording, to try software on.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace djpete::simulator {

enum class FaultKind : uint8_t {
    DroppedFrames,
    BlackFrames,
    SwappedCameras,
    TimeJump,
    LongBaseline,
    ShortBaseline,
    ExtrinsicTilt,
    NanPoints,
    SparseBeams,
    ExposureSwing
};

/// A kind with its name on the command line.
struct FaultName {
    FaultKind kind;
    const char* name;
    const char* what;       ///< half a sentence
    bool ofDrive;           ///< holds for the whole drive, not for a range of frames
    double mostAmount = 0;  ///< above 0: it has an amount, above 0 and at most this
};
const std::array<FaultName, 10>& faultNames();

/// A fault in the frames begin .. end-1.
struct Fault {
    FaultKind kind = FaultKind::DroppedFrames;
    uint64_t begin = 0, end = 0;
    double amount = 0;  ///< of kinds that have one (FaultName::mostAmount)
};

/// A fault where it is if nobody says so: the whole drive for wrong calibrations, five frames in
/// the middle for dropped and black ones, the middle third for all else.
Fault faultAtItsPlace(FaultKind kind, uint64_t driveBegin, uint64_t driveEnd);

/// True if a fault of this kind is at work at a frame.
bool isFaulty(const std::vector<Fault>& faults, FaultKind kind, uint64_t frame);
/// True if one of this kind is anywhere in the drive.
bool hasFault(const std::vector<Fault>& faults, FaultKind kind);

/// The amount of the first fault of this kind; 0 without one.
double amountOf(const std::vector<Fault>& faults, FaultKind kind);

/// Its name, with "=AMOUNT" if it has one.
std::string wordOf(const Fault& fault);
/// One row per fault: name, first frame, last frame, what it is.
std::string faultTable(const std::vector<Fault>& faults);

}  // namespace djpete::simulator
