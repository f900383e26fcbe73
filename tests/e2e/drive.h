/// Runs the programs in-process, as their mains do.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "djpete_slam_app.h"

namespace djpete_test {

namespace fs = std::filesystem;

/// Exit code and what a user would read of one program.
struct Outcome {
    int code = 0;
    std::string sentence;  ///< on failure
};

Outcome simulate(const std::vector<std::string>& arguments);
Outcome convert(const std::vector<std::string>& arguments);
/// Runs djpete-slam with datasets_cfg/simulated.ini unless `ini` is given. The app stays for looks.
Outcome slam(djpete::apps::DjpeteSlamApp& app, const std::vector<std::string>& arguments,
             const std::string& ini = "");

/// A drive of 12 small frames (620x188, scans, seed 3), simulated once per test program run.
const fs::path& smallDrive();
/// A copy of it that a test may spoil.
fs::path copyOfSmallDrive(const std::string& name);

std::string textOf(const fs::path& file);

}  // namespace djpete_test
