/// Higher Order Tracking Accuracy (Luiten et al., IJCV 2020).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace djpete::evaluation {

/// Boxes of one frame. Identities count from 0 within their drive.
struct HotaFrame {
    std::vector<std::size_t> labelIds, resultIds;
    Eigen::MatrixXd similarity;  ///< labels x results, 0..1
};

/// Sums from which HOTA follows, for each of the 19 localisation thresholds 0.05, 0.10, ..., 0.95.
/// Sums of several drives may be added: association is a mean over matches.
struct HotaSums {
    static constexpr std::size_t kAlphas = 19;
    std::array<double, kAlphas> matches{}, misses{}, falsePositives{}, association{}, similarity{};

    HotaSums& operator+=(const HotaSums& other);
};

/// Means over the 19 thresholds, 0..1.
struct Hota {
    double hota = 0;  ///< of sqrt(DetA AssA)
    double detA = 0;  ///< of matches / (matches + misses + false positives)
    double assA = 0;  ///< of the mean over matches of how much of both whole tracks is matched
    double locA = 0;  ///< of the mean similarity of the matches, 1 where there is none
};

/// Boxes of a frame are paired such that the sum of similarity times the agreement of the two whole
/// tracks is largest; pairs of a similarity below a threshold are no matches at that threshold.
HotaSums sumHota(const std::vector<HotaFrame>& frames, std::size_t labelTracks,
                 std::size_t resultTracks);
Hota hotaOf(const HotaSums& sums);

}  // namespace djpete::evaluation
