#include "scan_planes.h"

#include <algorithm>
#include <cmath>

namespace djpete::calibration {

using geometry::Mat3;
using geometry::Vec3;

namespace {

constexpr int kCell_px = 10;
constexpr double kHalfWidth_px = 9, kHalfHeight_px = 13;
constexpr double kScanner_m = 0.02;     // noise of a range
constexpr double kMaxRelative = 0.004;  // rms of 1/z about the plane, beyond the scanner's noise

}  // namespace

ScanView::ScanView(const std::vector<Eigen::Vector3f>& points_velo, const geometry::SE3& T_cam_velo,
                   const geometry::StereoCamera& camera)
    : camera_(camera),
      columns_(camera.width_px / kCell_px + 1),
      rows_(camera.height_px / kCell_px + 1),
      cells_(static_cast<std::size_t>(columns_ * rows_)) {
    for (const auto& point : points_velo) {
        const Vec3 p = T_cam_velo * point.cast<double>();
        if (!(p.z() > 1)) continue;
        const geometry::Vec2 uv = camera.project(p);
        if (!camera.contains(uv)) continue;
        const int cell = int(uv.y()) / kCell_px * columns_ + int(uv.x()) / kCell_px;
        cells_[std::size_t(cell)].push_back(
            {float(p.x() / p.z()), float(p.y() / p.z()), float(1 / p.z())});
    }
}

std::optional<Plane> ScanView::planeAt(double u_px, double v_px) const {
    const auto cellOf = [](double x) { return int(std::floor(x / kCell_px)); };
    const Vec3 ray = camera_.ray({u_px, v_px});
    std::vector<Return> used;
    bool sides[4] = {false, false, false, false};
    for (int row = cellOf(v_px - kHalfHeight_px); row <= cellOf(v_px + kHalfHeight_px); ++row) {
        for (int c = cellOf(u_px - kHalfWidth_px); c <= cellOf(u_px + kHalfWidth_px); ++c) {
            if (row < 0 || c < 0 || row >= rows_ || c >= columns_) continue;
            for (const auto& r : cells_[std::size_t(row * columns_ + c)]) {
                const double du = (double(r.x) - ray.x()) * camera_.fx;
                const double dv = (double(r.y) - ray.y()) * camera_.fy;
                if (std::abs(du) > kHalfWidth_px || std::abs(dv) > kHalfHeight_px) continue;
                sides[du < 0 ? 0 : 1] = sides[dv < 0 ? 2 : 3] = true;
                used.push_back(r);
            }
        }
    }
    if (used.size() < 8 || !sides[0] || !sides[1] || !sides[2] || !sides[3]) return std::nullopt;
    // 1/z = n . (x, y, 1), about the pixel for good conditioning.
    Mat3 A = Mat3::Zero();
    Vec3 b = Vec3::Zero();
    for (const auto& r : used) {
        const Vec3 x((double(r.x) - ray.x()) * 50, (double(r.y) - ray.y()) * 50, 1);
        A += x * x.transpose();
        b += double(r.w) * x;
    }
    A.diagonal().array() += 1e-9;
    const Mat3 inverse = A.inverse();
    const Vec3 m = inverse * b;
    if (!m.allFinite() || !(m.z() > 0.01)) return std::nullopt;
    double sum2 = 0, worst = 0;
    for (const auto& r : used) {
        const Vec3 x((double(r.x) - ray.x()) * 50, (double(r.y) - ray.y()) * 50, 1);
        const double e = (m.dot(x) - double(r.w)) / m.z();
        sum2 += e * e;
        worst = std::max(worst, std::abs(e));
    }
    const double rms = std::sqrt(sum2 / double(used.size() - 3));
    const double most = kMaxRelative + kScanner_m * m.z();
    if (rms > most || worst > 3.5 * most) return std::nullopt;
    const Vec3 n(50 * m.x(), 50 * m.y(), m.z() - 50 * (m.x() * ray.x() + m.y() * ray.y()));
    // Surfaces seen at less than about six degrees tell little and err much.
    if (n.dot(ray) < 0.1 * n.norm() * ray.norm()) return std::nullopt;
    const double noise = std::max(rms, kScanner_m * m.z());
    return Plane{n, noise * std::sqrt(inverse(2, 2))};
}

}  // namespace djpete::calibration
