#include "realism_drive.h"

#include <opencv2/imgcodecs.hpp>

namespace djpete_bench {
namespace {

namespace fs = std::filesystem;
using djpete_test::KittiFolder;

cv::Mat readGrey(const fs::path& file) {
    const cv::Mat image = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
    if (image.empty()) throw std::runtime_error(file.string() + ": no image can be read from it");
    return image;
}

std::vector<LabelledBox> readLabels(const fs::path& file) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error(file.string() + ": cannot be read");
    std::vector<LabelledBox> out;
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        std::istringstream words(line);
        LabelledBox b;
        long track = 0;
        double alpha = 0, x1 = 0, y1 = 0, x2 = 0, y2 = 0, h = 0, w = 0, l = 0, x = 0, y = 0, z = 0,
               ry = 0;
        if (!(words >> b.frame >> track >> b.type >> b.truncation >> b.occlusion >> alpha >> x1 >>
              y1 >> x2 >> y2 >> h >> w >> l >> x >> y >> z >> ry)) {
            throw std::runtime_error(file.string() + " line " + std::to_string(number) +
                                     ": expected a row of KITTI's tracking labels");
        }
        if (h <= 0) continue;  // DontCare
        b.size_m = {l, w, h};
        // Length lies along camera x at rotation 0; obj has z up, which is camera -y.
        djpete::geometry::Mat3 R;
        const double c = std::cos(ry), s = std::sin(ry);
        R.col(0) << c, 0, -s;
        R.col(2) << 0, -1, 0;
        R.col(1) = R.col(2).cross(R.col(0));
        b.T_cam_obj = SE3(R, {x, y - 0.5 * h, z});
        out.push_back(std::move(b));
    }
    return out;
}

void findFrames(RealismDrive& drive, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
        const auto name = KittiFolder::numbered(i, drive.folder.digits, ".png");
        if (!fs::exists(drive.folder.left / name)) break;
        drive.frames.push_back(i);
    }
    if (drive.frames.empty()) {
        throw std::runtime_error(drive.folder.left.string() + ": expected images " +
                                 std::to_string(begin) + " and following");
    }
}

}  // namespace

cv::Mat RealismDrive::left(std::size_t frame) const {
    return readGrey(folder.left / KittiFolder::numbered(frame, folder.digits, ".png"));
}
cv::Mat RealismDrive::right(std::size_t frame) const {
    return readGrey(folder.right / KittiFolder::numbered(frame, folder.digits, ".png"));
}

std::optional<djpete::obs::LidarScan> RealismDrive::scan(std::size_t frame) const {
    const auto file = folder.scans / KittiFolder::numbered(frame, folder.digits, ".bin");
    std::ifstream in(file, std::ios::binary);
    if (!in) return std::nullopt;
    djpete::obs::LidarScan out;
    for (std::array<float, 4> p{}; in.read(reinterpret_cast<char*>(p.data()), 16);)
        out.points.push_back({p[0], p[1], p[2], p[3]});
    return out;
}

RealismDrive openOdometryDrive(const fs::path& dir, std::size_t begin, std::size_t end,
                               const fs::path& poses) {
    RealismDrive drive;
    drive.name = dir.filename().string();
    if (drive.name.empty()) drive.name = dir.parent_path().filename().string();
    if (!fs::exists(dir / "calib.txt"))
        throw std::runtime_error(dir.string() + ": expected a KITTI drive with calib.txt");
    drive.folder = KittiFolder::odometry(dir, false);
    findFrames(drive, begin, end);
    const auto own = dir / "poses.txt";
    if (fs::exists(own))
        drive.T_first_cam = djpete_test::readPoses(own);
    else if (!poses.empty())
        drive.T_first_cam = djpete_test::readPoses(poses);
    if (fs::exists(dir / "label_02.txt")) drive.boxes = readLabels(dir / "label_02.txt");
    return drive;
}

RealismDrive openRawDrive(const fs::path& dir, const fs::path& labels) {
    RealismDrive drive;
    drive.name = dir.filename().string();
    drive.folder = KittiFolder::rawMono(dir);
    findFrames(drive, 0, 100000);
    drive.boxes = readLabels(labels);
    return drive;
}

}  // namespace djpete_bench
