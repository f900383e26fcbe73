/// What the places bench counts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

#include "djpete/places/place_database.h"
#include "djpete/places/view_match.h"
#include "places_drive.h"

namespace djpete_bench {

using djpete::geometry::SE3;

constexpr double kHeading_rad = 15 * M_PI / 180;

/// Processor time of this program: what it takes, whatever else the machine does.
class StopWatch {
  public:
    double ms() const { return 1e3 * static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }

  private:
    std::clock_t start_ = std::clock();
};

class Samples {
  public:
    void add(double value) { values_.push_back(value); }
    std::size_t size() const { return values_.size(); }
    /// The quantile `share` of 0..1; NaN of nothing.
    double at(double share) const {
        if (values_.empty()) return std::nan("");
        std::vector<double> sorted = values_;
        std::sort(sorted.begin(), sorted.end());
        return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
    }

  private:
    std::vector<double> values_;
};

/// How two keyframes truly stand to each other.
struct Truth {
    Truth(const PlacesDrive& drive, std::size_t a, std::size_t b)
        : T_a_b(drive.T_true_cam[a].inverse() * drive.T_true_cam[b]),
          distance_m(T_a_b.translation().norm()),
          heading_rad(T_a_b.angle_rad()) {}
    SE3 T_a_b;
    double distance_m, heading_rad;
};

struct PairStatistics {
    int pairs = 0, matched = 0, wrong = 0;
    Samples inliers, share, sigma_m, error_m, error_deg, nees, ms;
};

/// Counts a match; true if it is near the truth.
inline bool judge(PairStatistics& s, const Truth& truth,
                  const std::optional<djpete::places::ViewMatch>& match) {
    constexpr double kWrong_m = 1, kWrong_deg = 3;
    ++s.pairs;
    if (!match) return false;
    ++s.matched;
    const SE3 T_error = truth.T_a_b.inverse() * match->T_a_b;
    const double error_deg = T_error.angle_rad() * 180 / M_PI;
    const auto e = T_error.log();
    s.inliers.add(static_cast<double>(match->features.size()));
    s.share.add(match->share);
    const djpete::geometry::Mat6 covariance = match->information.inverse();
    s.sigma_m.add(std::sqrt(covariance.topLeftCorner<3, 3>().trace()));
    s.error_m.add(T_error.translation().norm());
    s.error_deg.add(error_deg);
    s.nees.add(e.dot(match->information * e));
    const bool good = T_error.translation().norm() < kWrong_m && error_deg < kWrong_deg;
    s.wrong += good ? 0 : 1;
    return good;
}

inline void judge(PairStatistics& s, const Truth& truth, const djpete::places::PlaceView& a,
                  const djpete::places::PlaceView& b, bool withGuess) {
    const djpete::places::MatchOptions options;
    djpete::geometry::Vec6 off;
    off << 0.3, 0.1, 0.4, 0.01, 0.03, 0.01;
    const StopWatch watch;
    const auto match = withGuess ? matchViewsNear(a, b, truth.T_a_b * SE3::exp(off), options)
                                 : matchViews(a, b, options, a.id.value);
    s.ms.add(watch.ms());
    judge(s, truth, match);
}

inline void printHeader() {
    std::printf("%-10s %6s %8s %6s %8s %8s %8s %8s %8s %8s %8s %8s %8s %7s\n", "", "pairs",
                "matched", "wrong", "inl p5", "inl p50", "share p5", "sig p95", "m p50", "m p95",
                "deg p50", "deg p95", "nees p50", "ms p50");
}

inline void printRow(const std::string& name, const PairStatistics& s) {
    std::printf("%-10s %6d %8d %6d %8.0f %8.0f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.1f %7.2f\n",
                name.c_str(), s.pairs, s.matched, s.wrong, s.inliers.at(0.05), s.inliers.at(0.5),
                s.share.at(0.05), s.sigma_m.at(0.95), s.error_m.at(0.5), s.error_m.at(0.95),
                s.error_deg.at(0.5), s.error_deg.at(0.95), s.nees.at(0.5), s.ms.at(0.5));
}

inline double bytesPerCorner(const djpete::places::PlaceDatabase& database,
                             const std::vector<djpete::places::PlaceView>& views) {
    std::size_t corners = 0;
    for (const auto& v : views) corners += v.corners.size();
    return static_cast<double>(database.bytes()) / static_cast<double>(corners);
}

/// SplitMix64's mixing of one number.
inline uint64_t scrambled(uint64_t z) {
    z += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
}

}  // namespace djpete_bench
