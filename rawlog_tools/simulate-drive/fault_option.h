/// The words of --fault and --depth.
#pragma once

#include <string>
#include <vector>

#include "djpete/simulator/drive_writer.h"

namespace djpete::apps {

/// Names of all faults with what they do, for --help.
std::string faultHelp();

/// Of "NAME", "NAME=F" or "NAME@A:B"; `options` has the range of the drive. Throws obs::InputError.
simulator::Fault parseFault(const std::string& text, const simulator::DriveOptions& options);

/// Of several; kinds with an amount at most once. Throws obs::InputError.
std::vector<simulator::Fault> parseFaults(const std::vector<std::string>& texts,
                                          const simulator::DriveOptions& options);

/// Of "A:B[,A:B]". Throws obs::InputError.
std::vector<simulator::Frames> parseFrames(const std::string& text);

}  // namespace djpete::apps
