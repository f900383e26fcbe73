/// Folders for written drives, and reading them back.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "djpete/simulator/drive_writer.h"

namespace djpete_test {

/// An empty folder that goes away again.
class ScratchFolder {
  public:
    explicit ScratchFolder(const std::string& name)
        : path_(std::filesystem::temp_directory_path() /
                ("djpete_simulator_" + name + "_" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

inline std::string bytesOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Content of every file below a folder by its relative name.
inline std::map<std::string, std::string> filesOf(const std::filesystem::path& folder) {
    std::map<std::string, std::string> out;
    for (const auto& e : std::filesystem::recursive_directory_iterator(folder))
        if (e.is_regular_file())
            out[std::filesystem::relative(e.path(), folder).string()] = bytesOf(e.path());
    return out;
}

/// Numbers of each row of a text file; words become NaN-free by being skipped.
inline std::vector<std::vector<double>> numbersOf(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::vector<std::vector<double>> rows;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::vector<double> row;
        for (std::string word; words >> word;) {
            char* end = nullptr;
            const double x = std::strtod(word.c_str(), &end);
            if (end != word.c_str() && *end == 0) row.push_back(x);
        }
        rows.push_back(row);
    }
    return rows;
}

/// A few small frames.
inline djpete::simulator::DriveOptions smallDrive() {
    djpete::simulator::DriveOptions o;
    o.world.seed = 3;
    o.end = 3;
    o.width_px = 248;
    o.height_px = 76;
    o.lidar.azimuthStep_deg = 1.0;
    o.threads = 1;
    return o;
}

}  // namespace djpete_test
