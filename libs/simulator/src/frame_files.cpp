#include "frame_files.h"

#include <cstdio>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "image_files.h"
#include "noise.h"
#include "truth_writer.h"

namespace djpete::simulator {

namespace fs = std::filesystem;

namespace {

std::string numbered(uint64_t frame, const char* extension) {
    char name[32];
    std::snprintf(name, sizeof name, "%06llu%s", static_cast<unsigned long long>(frame), extension);
    return name;
}

bool hasDepth(uint64_t frame, const DriveOptions& options) {
    for (const auto& range : options.depth) {
        if (frame >= range.begin && frame < range.end) return true;
    }
    return false;
}

/// Folders and file names of a frame, below the drive's folder.
std::vector<fs::path> pathsOf(uint64_t frame, const DriveOptions& options) {
    const std::string png = numbered(frame, ".png");
    std::vector<fs::path> out{fs::path("image_0") / png, fs::path("image_1") / png,
                              fs::path("instances") / png,
                              fs::path("oxts") / numbered(frame, ".txt")};
    if (options.colour)
        out.insert(out.end(), {fs::path("image_2") / png, "image_3" / fs::path(png)});
    if (options.scans) out.push_back(fs::path("velodyne") / numbered(frame, ".bin"));
    if (hasDepth(frame, options)) out.push_back(fs::path("depth") / png);
    return out;
}

std::string scanBytes(const FrameData& data, const DriveOptions& options) {
    const bool sparse = isFaulty(options.faults, FaultKind::SparseBeams, data.frame);
    const bool nan = isFaulty(options.faults, FaultKind::NanPoints, data.frame);
    std::string bytes;
    bytes.reserve(16 * data.scan.size());
    for (std::size_t i = 0; i < data.scan.size(); ++i) {
        const LidarPoint& p = data.scan[i];
        if (sparse && p.beam % 4 != 0) continue;
        std::array<float, 4> row{p.x, p.y, p.z, p.reflectance};
        if (nan && hash(static_cast<uint32_t>(i), static_cast<uint32_t>(data.frame)) % 20 == 0)
            row[0] = row[1] = row[2] = std::numeric_limits<float>::quiet_NaN();
        std::array<char, sizeof row> raw;
        std::memcpy(raw.data(), row.data(), sizeof row);
        bytes.append(raw.data(), raw.size());
    }
    return bytes;
}

void writeImages(const FrameData& data, const fs::path& folder, const DriveOptions& options) {
    const std::string name = numbered(data.frame, ".png");
    const bool black = isFaulty(options.faults, FaultKind::BlackFrames, data.frame);
    const bool swapped = isFaulty(options.faults, FaultKind::SwappedCameras, data.frame);
    for (int i = 0; i < (options.colour ? 4 : 2); ++i) {
        const RenderedImage& image = (i % 2 == 0) != swapped ? data.left : data.right;
        cv::Mat picture = i < 2 ? greyOf(image) : colourOf(image);
        if (black) picture.setTo(0);
        writePng(picture, folder / ("image_" + std::to_string(i)) / name);
    }
    writePng(instancesOf(data.left, maskCodes(data.labels)), folder / "instances" / name);
    if (hasDepth(data.frame, options)) writePng(depthOf(data.left), folder / "depth" / name);
}

bool isWhole(const fs::path& file) {
    if (file.extension() == ".png") return isWholePng(file);
    std::error_code missing;
    const auto size = fs::file_size(file, missing);
    if (missing || size == 0) return false;
    return file.extension() != ".bin" || size % (4 * sizeof(float)) == 0;
}

}  // namespace

void makeFolders(const fs::path& folder, const DriveOptions& options) {
    std::vector<std::string> names{"image_0", "image_1", "instances", "oxts"};
    if (options.colour) names.insert(names.end(), {"image_2", "image_3"});
    if (options.scans) names.emplace_back("velodyne");
    if (!options.depth.empty()) names.emplace_back("depth");
    for (const auto& name : names) {
        std::error_code failed;
        fs::create_directories(folder / name, failed);
        if (failed || !fs::is_directory(folder / name))
            throw std::runtime_error((folder / name).string() + ": the folder cannot be made");
    }
}

void writeFrameFiles(const FrameData& data, const fs::path& folder, const DriveOptions& options) {
    writeImages(data, folder, options);
    if (options.scans)
        writeWhole(folder / "velodyne" / numbered(data.frame, ".bin"), scanBytes(data, options));
    writeWhole(folder / "oxts" / numbered(data.frame, ".txt"), data.oxts + "\n");
}

void removeFrameFiles(uint64_t frame, const fs::path& folder, const DriveOptions& options) {
    for (const auto& path : pathsOf(frame, options)) {
        std::error_code failed;
        fs::remove(folder / path, failed);
        if (failed) throw std::runtime_error((folder / path).string() + ": cannot be removed");
    }
}

bool frameIsComplete(uint64_t frame, const fs::path& folder, const DriveOptions& options) {
    for (const auto& path : pathsOf(frame, options)) {
        if (!isWhole(folder / path)) return false;
    }
    return true;
}

}  // namespace djpete::simulator
