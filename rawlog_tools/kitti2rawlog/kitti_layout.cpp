#include "kitti_layout.h"

#include <algorithm>
#include <cctype>

#include "djpete/obs/errors.h"

namespace djpete::kitti2rawlog {

namespace fs = std::filesystem;
using obs::InputError;

namespace {

std::optional<fs::path> ifFile(const fs::path& p) {
    if (fs::is_regular_file(p)) return p;
    return std::nullopt;
}

bool isNumber(const std::string& s) {
    return !s.empty() && s.size() < 19 &&
           std::all_of(s.begin(), s.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// sequences/00/ and sequences/00 are the same folder.
fs::path withoutTrailingSlash(const fs::path& p) {
    const auto absolute = fs::absolute(p).lexically_normal();
    return absolute.has_filename() ? absolute : absolute.parent_path();
}

DriveFiles odometry(const fs::path& dir) {
    DriveFiles d;
    d.layout = Layout::Odometry;
    d.name = "kitti odometry " + dir.filename().string();
    d.calibration = dir / "calib.txt";
    for (std::size_t i = 0; i < 4; ++i)
        d.images[i] = listFrames(dir / ("image_" + std::to_string(i)), ".png");
    d.scans = listFrames(dir / "velodyne", ".bin");
    d.instances = listFrames(dir / "instances", ".png");
    d.times = ifFile(dir / "times.txt");
    d.poses = ifFile(dir / "poses.txt");
    if (!d.poses) {
        d.poses =
            ifFile(dir.parent_path().parent_path() / "poses" / (dir.filename().string() + ".txt"));
    }
    d.labels = ifFile(dir / "label_02.txt");
    d.detections = ifFile(dir / "detections.txt");
    return d;
}

DriveFiles raw(const fs::path& dir) {
    DriveFiles d;
    d.layout = Layout::Raw;
    d.name = "kitti raw " + dir.filename().string();
    d.calibration = dir.parent_path();
    for (std::size_t i = 0; i < 4; ++i)
        d.images[i] = listFrames(dir / ("image_0" + std::to_string(i)) / "data", ".png");
    d.scans = listFrames(dir / "velodyne_points" / "data", ".bin");
    d.oxtsFiles = listFrames(dir / "oxts" / "data", ".txt");
    d.poses = ifFile(dir / "poses.txt");
    // One clock for all sensors of a frame: the first camera's, else the scanner's, else OXTS'.
    for (const char* sensor :
         {"image_00", "image_02", "image_01", "image_03", "velodyne_points", "oxts"}) {
        if (!d.times) d.times = ifFile(dir / sensor / "timestamps.txt");
    }
    return d;
}

DriveFiles tracking(const fs::path& root, const std::string& sequence) {
    DriveFiles d;
    d.layout = Layout::Tracking;
    d.name = "kitti tracking " + sequence;
    d.calibration = root / "calib" / (sequence + ".txt");
    d.images[2] = listFrames(root / "image_02" / sequence, ".png");
    d.images[3] = listFrames(root / "image_03" / sequence, ".png");
    d.scans = listFrames(root / "velodyne" / sequence, ".bin");
    d.instances = listFrames(root / "instances" / sequence, ".png");
    d.oxtsTable = ifFile(root / "oxts" / (sequence + ".txt"));
    d.poses = ifFile(root / "poses" / (sequence + ".txt"));
    d.labels = ifFile(root / "label_02" / (sequence + ".txt"));
    return d;
}

DriveFiles object(const fs::path& dir) {
    DriveFiles d;
    d.layout = Layout::Object;
    d.name = "kitti object " + dir.filename().string();
    d.calibration = dir / "calib";
    d.images[2] = listFrames(dir / "image_2", ".png");
    d.images[3] = listFrames(dir / "image_3", ".png");
    d.scans = listFrames(dir / "velodyne", ".bin");
    d.frameLabels = listFrames(dir / "label_2", ".txt");
    return d;
}

bool looksRaw(const fs::path& dir) {
    for (const char* s : {"image_00", "image_01", "image_02", "image_03", "velodyne_points"}) {
        if (fs::is_directory(dir / s / "data")) return true;
    }
    return false;
}

bool isTrackingRoot(const fs::path& dir, const std::string& sequence) {
    return fs::is_regular_file(dir / "calib" / (sequence + ".txt")) ||
           fs::is_directory(dir / "image_02" / sequence) ||
           fs::is_regular_file(dir / "label_02" / (sequence + ".txt"));
}

/// training/image_02/0006 or training/label_02/0006.txt -> (training, 0006).
std::optional<DriveFiles> trackingPart(const fs::path& p) {
    const std::string sequence = p.stem().string();
    const std::string folder = p.parent_path().filename().string();
    const fs::path root = p.parent_path().parent_path();
    for (const char* s : {"image_02", "image_03", "velodyne", "label_02", "calib", "oxts"}) {
        if (folder == s && isNumber(sequence) && isTrackingRoot(root, sequence))
            return tracking(root, sequence);
    }
    return std::nullopt;
}

}  // namespace

std::string toString(Layout layout) {
    switch (layout) {
        case Layout::Odometry:
            return "odometry";
        case Layout::Raw:
            return "raw";
        case Layout::Tracking:
            return "tracking";
        default:
            return "object";
    }
}

bool DriveFiles::hasImages() const {
    return std::any_of(images.begin(), images.end(), [](const auto& i) { return !i.empty(); });
}

bool DriveFiles::hasSensors() const {
    return hasImages() || !scans.empty() || !oxtsFiles.empty() || oxtsTable.has_value();
}

FramedFiles listFrames(const fs::path& folder, const std::string& extension) {
    FramedFiles out;
    if (!fs::is_directory(folder)) return out;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const auto& p = entry.path();
        const std::string stem = p.stem().string();
        if (p.extension() != extension || !isNumber(stem)) continue;
        const auto [it, fresh] = out.emplace(std::stoull(stem), p);
        if (!fresh) {
            throw InputError(folder.string() + ": frame " + std::to_string(it->first) +
                             " is there twice (" + it->second.filename().string() + " and " +
                             p.filename().string() + ")");
        }
    }
    return out;
}

DriveFiles findDrive(const fs::path& input, const std::string& sequence) {
    const fs::path dir = withoutTrailingSlash(input);
    if (!fs::exists(dir)) throw InputError(input.string() + ": no such folder");
    if (!sequence.empty()) {
        if (isTrackingRoot(dir, sequence)) return tracking(dir, sequence);
        throw InputError(input.string() + ": no tracking sequence " + sequence +
                         "; expected calib/" + sequence + ".txt, image_02/" + sequence +
                         " or label_02/" + sequence + ".txt in it");
    }
    if (auto d = trackingPart(dir)) return *d;
    if (!fs::is_directory(dir)) throw InputError(input.string() + ": not a folder");
    if (fs::is_regular_file(dir / "calib.txt")) return odometry(dir);
    if (looksRaw(dir)) return raw(dir);
    if (fs::is_directory(dir / "calib") &&
        (fs::is_directory(dir / "image_2") || fs::is_directory(dir / "label_2"))) {
        return object(dir);
    }
    if (fs::is_directory(dir / "calib") && fs::is_directory(dir / "label_02")) {
        throw InputError(input.string() +
                         ": a tracking folder holds many drives; expected --sequence, e.g. "
                         "--sequence 0006");
    }
    for (int i = 0; i < 4; ++i) {
        if (fs::is_directory(dir / ("image_" + std::to_string(i)))) {
            throw InputError((dir / "calib.txt").string() +
                             ": no such file; a drive cannot be converted without calibration");
        }
    }
    throw InputError(input.string() +
                     ": no KITTI drive; expected an odometry, raw, tracking or object folder (see "
                     "--help)");
}

}  // namespace djpete::kitti2rawlog
