/// What a drive was made with, as text beside it.
#pragma once

#include <filesystem>
#include <string>

#include "djpete/simulator/drive_writer.h"

namespace djpete::simulator {

/// One line `name value` per option that has a say in the bytes of the drive.
std::string optionText(const DriveOptions& options);

/// For --resume: throws std::runtime_error with one sentence if the drive in the folder was begun
/// with other options. A folder without drive_options.txt holds no drive: returns false.
bool wasBegunWith(const DriveOptions& options, const std::filesystem::path& folder);

}  // namespace djpete::simulator
