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
    SparseBeams
};

/// A kind with its name on the command line.
struct FaultName {
    FaultKind kind;
    const char* name;
    const char* what;  ///< half a sentence
    bool ofDrive;      ///< holds for the whole drive, not for a range of frames
};
const std::array<FaultName, 9>& faultNames();

/// A fault in the frames begin .. end-1.
struct Fault {
    FaultKind kind = FaultKind::DroppedFrames;
    uint64_t begin = 0, end = 0;
};

/// A fault where it is if nobody says so: the whole drive for wrong calibrations, five frames in
/// the middle for dropped and black ones, the middle third for all else.
Fault faultAtItsPlace(FaultKind kind, uint64_t driveBegin, uint64_t driveEnd);

/// True if a fault of this kind is at work at a frame.
bool isFaulty(const std::vector<Fault>& faults, FaultKind kind, uint64_t frame);
/// True if one of this kind is anywhere in the drive.
bool hasFault(const std::vector<Fault>& faults, FaultKind kind);

/// One row per fault: name, first frame, last frame, what it is.
std::string faultTable(const std::vector<Fault>& faults);

}  // namespace djpete::simulator
