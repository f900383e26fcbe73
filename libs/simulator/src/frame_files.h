/// The files of one frame.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "djpete/simulator/drive_writer.h"

namespace djpete::simulator {

/// All that a frame's files are made of.
struct FrameData {
    uint64_t frame = 0;
    RenderedImage left, right;
    std::vector<Label> labels;
    std::vector<LidarPoint> scan;
    std::string oxts;
};

/// Makes the folders that the files of frames go to. Throws std::runtime_error naming a folder that
/// cannot be made.
void makeFolders(const std::filesystem::path& folder, const DriveOptions& options);

/// Writes the files of a frame; faults of images and scans are applied here. Throws
/// std::runtime_error naming the file that cannot be written.
void writeFrameFiles(const FrameData& data, const std::filesystem::path& folder,
                     const DriveOptions& options);

/// Removes what another run has left of a frame.
void removeFrameFiles(uint64_t frame, const std::filesystem::path& folder,
                      const DriveOptions& options);

/// True if every file of the frame is there and whole.
bool frameIsComplete(uint64_t frame, const std::filesystem::path& folder,
                     const DriveOptions& options);

}  // namespace djpete::simulator
