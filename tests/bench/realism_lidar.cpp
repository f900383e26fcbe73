/// Points per scan and per car.
#include <algorithm>
#include <cmath>

#include "realism_statistics.h"

namespace djpete_bench {
namespace {

using djpete::obs::LidarScan;

/// Typical step of azimuth between neighbours in file order (beams are written one after the
/// other), degrees; steps below or above what an HDL-64E can do are not counted.
std::optional<double> azimuthStep_deg(const LidarScan& scan) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < scan.points.size(); ++i) {
        const auto &a = scan.points[i - 1], &b = scan.points[i];
        const double d = std::abs(std::remainder(static_cast<double>(std::atan2(b.y, b.x)) -
                                                     static_cast<double>(std::atan2(a.y, a.x)),
                                                 2 * M_PI)) *
                         180 / M_PI;
        if (d > 0.05 && d < 0.35) steps.push_back(d);
    }
    return percentile(std::move(steps), 0.5);
}

struct Range {
    double low_m, middle_m, high_m;
    std::vector<double> points;
};

/// Points on the box per square metre of its silhouette, as if it stood in the middle of its range
/// (they fall with its square); so vans and cars, seen from any side, may be compared.
void countPoints(const LabelledBox& box, const LidarScan& scan, const SE3& T_velo_cam,
                 std::vector<Range>& ranges) {
    const SE3 T_obj_velo = (T_velo_cam * box.T_cam_obj).inverse();
    const djpete::geometry::Vec3 scanner = T_obj_velo.translation();
    const double distance = scanner.head<2>().norm();
    const double wide =
        (std::abs(scanner.x()) * box.size_m.y() + std::abs(scanner.y()) * box.size_m.x()) /
        distance;
    const djpete::geometry::Vec3 half = 0.5 * box.size_m + djpete::geometry::Vec3::Constant(0.05);
    const auto inside = [&](const auto& p) {
        const djpete::geometry::Vec3 p_obj = T_obj_velo * p.position();
        return (p_obj.cwiseAbs() - half).maxCoeff() < 0 && p_obj.z() > 0.15 - half.z();
    };
    for (auto& r : ranges) {
        if (distance < r.low_m || distance > r.high_m) continue;
        const auto count = std::count_if(scan.points.begin(), scan.points.end(), inside);
        r.points.push_back(static_cast<double>(count) / (wide * box.size_m.z()) *
                           std::pow(distance / r.middle_m, 2));
    }
}

}  // namespace

Statistics lidarStatistics(const RealismDrive& drive, const RealismDrive& cars) {
    constexpr double kBeams = 64;
    std::vector<double> points, steps, silent, reflectances, distances;
    for (std::size_t frame : drive.frames) {
        const auto scan = drive.scan(frame);
        if (!scan) continue;
        points.push_back(static_cast<double>(scan->points.size()));
        for (std::size_t i = 0; i < scan->points.size(); i += 7) {
            reflectances.push_back(static_cast<double>(scan->points[i].intensity));
            distances.push_back(scan->points[i].position().norm());
        }
        if (const auto step = azimuthStep_deg(*scan)) {
            steps.push_back(*step);
            silent.push_back(1 - points.back() / (kBeams * std::round(360 / *step)));
        }
    }
    std::vector<Range> ranges{{7, 10, 14, {}}, {14, 20, 27, {}}, {30, 40, 50, {}}};
    for (std::size_t frame : cars.frames) {
        const auto scan = cars.scan(frame);
        if (!scan) continue;
        for (const auto& box : cars.boxes) {
            if (box.frame == frame && (box.type == "Car" || box.type == "Van") &&
                box.occlusion == 0 && box.truncation < 0.05)
                countPoints(box, *scan, cars.folder.camera.T_vehicle_cam, ranges);
        }
    }
    Statistics out{{"points per scan", mean(points), false},
                   {"azimuth step, deg", mean(steps), false},
                   {"beams without return, share", mean(silent), false}};
    for (int p : {10, 50, 90})
        out.push_back({"range of points p" + std::to_string(p) + ", m",
                       percentile(distances, p / 100.0), false});
    for (int p : {10, 50, 90})
        out.push_back(
            {"reflectance p" + std::to_string(p), percentile(reflectances, p / 100.0), false});
    for (const auto& r : ranges)
        out.push_back(
            {"points per m2 of car at " + std::to_string(static_cast<int>(r.middle_m)) + " m, p50",
             percentile(r.points, 0.5), false});
    return out;
}

}  // namespace djpete_bench
