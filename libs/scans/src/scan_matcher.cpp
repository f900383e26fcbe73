#include "djpete/scans/scan_matcher.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "plane_map.h"
#include "scan_alignment.h"

namespace djpete::scans {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using geometry::Vec6;

namespace {

Mat6 symmetric(const Mat6& m) { return 0.5 * (m + m.transpose()); }

}  // namespace

struct ScanMatcher::Impl {
    struct Keyframe {
        obs::FrameId frame;
        SE3 T_odom_vehicle, T_map_vehicle;
        Mat6 covariance;  ///< of T_map_vehicle
    };

    explicit Impl(const ScanOptions& o) : options(o), map(o) { reset(); }

    void reset() {
        map.clear();
        last.reset();
        way_m = 0;
        deviation2 = 0;
        deviations = 0;
    }

    /// A third of what predictions were wrong by on average (KISS-ICP's adaptive threshold).
    double kernel_m() const {
        if (deviations == 0) return options.firstKernel_m;
        const double first2 = options.firstKernel_m * options.firstKernel_m;
        return std::sqrt((first2 + deviation2) / (deviations + 1)) / 3;
    }

    /// How far the prediction was off for the farthest points.
    void learn(const SE3& T_predicted, const SE3& T) {
        const SE3 wrong = T_predicted.inverse() * T;
        const double off =
            wrong.translation().norm() +
            2 * options.maxRange_m * std::sin(0.5 * std::min(wrong.angle_rad(), M_PI));
        deviation2 += off * off;
        deviations += 1;
    }

    std::optional<Alignment> alignWith(const PreparedScan& scan, const std::vector<Vec3>& points,
                                       const SE3& T_predicted) {
        std::vector<Vec3> some;
        some.reserve(scan.toMatch.size());
        for (const uint32_t i : scan.toMatch) some.push_back(points[i]);
        return align(some, map, T_predicted, kernel_m(), options);
    }

    ScanMatch motion(const Keyframe& from, const Keyframe& to, const Alignment& alignment) const {
        ScanMatch out;
        out.from = from.frame;
        out.T_from_vehicle = (from.T_map_vehicle.inverse() * to.T_map_vehicle).normalised();
        // d(T_a^-1 T_b) = d_b - Ad((T_a^-1 T_b)^-1) d_a
        const Mat6 Ad = out.T_from_vehicle.inverse().adjoint();
        Mat6 covariance = to.covariance + Ad * from.covariance * Ad.transpose();
        covariance.diagonal().head<3>().array() += options.floor_m * options.floor_m;
        covariance.diagonal().tail<3>().array() += options.floor_rad * options.floor_rad;
        out.information = symmetric(covariance.ldlt().solve(Mat6::Identity()));
        out.matched = alignment.matched;
        out.rms_m = alignment.rms_m;
        return out;
    }

    std::optional<ScanMatch> addKeyframe(obs::FrameId frame, const PreparedScan& scan,
                                         const SE3& T_odom_vehicle, const Vec6& twist) {
        const auto points = atOneInstant(scan, twist, options);
        Keyframe now{frame, T_odom_vehicle, SE3(), Mat6::Zero()};
        std::optional<ScanMatch> out;
        if (last) {
            const SE3 T_last_vehicle = last->T_odom_vehicle.inverse() * T_odom_vehicle;
            const SE3 T_predicted = (last->T_map_vehicle * T_last_vehicle).normalised();
            const auto alignment = alignWith(scan, points, T_predicted);
            if (alignment) {
                now.T_map_vehicle = alignment->T_map_vehicle;
                now.covariance = alignment->covariance;
                learn(T_predicted, now.T_map_vehicle);
                way_m += T_last_vehicle.translation().norm();
                out = motion(*last, now, *alignment);
            } else {
                reset();
            }
        }
        std::vector<Vec3> points_map;
        points_map.reserve(points.size());
        for (const Vec3& p : points) points_map.push_back(now.T_map_vehicle * p);
        map.add(points_map, way_m);
        last = now;
        return out;
    }

    ScanOptions options;
    PlaneMap map;
    std::optional<Keyframe> last;
    double way_m = 0;
    double deviation2 = 0, deviations = 0;
};

ScanMatcher::ScanMatcher(const ScanOptions& options) : impl_(std::make_unique<Impl>(options)) {}
ScanMatcher::~ScanMatcher() = default;
ScanMatcher::ScanMatcher(ScanMatcher&&) noexcept = default;
ScanMatcher& ScanMatcher::operator=(ScanMatcher&&) noexcept = default;

std::optional<ScanMatch> ScanMatcher::addKeyframe(obs::FrameId frame, const PreparedScan& scan,
                                                  const geometry::SE3& T_odom_vehicle,
                                                  const geometry::Vec6& twistPerSecond) {
    return impl_->addKeyframe(frame, scan, T_odom_vehicle, twistPerSecond);
}
void ScanMatcher::reset() { impl_->reset(); }

}  // namespace djpete::scans
