#include "djpete/texture/exposure.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace djpete::texture {

namespace {

constexpr double kNeighbourSigma = 0.3;  // of the logarithms of gains of images in a row
constexpr double kGaugeWeight = 1e-3;
// Of the guess. Black levels hardly change; what looks like an offset is mostly an object that
// moves into the shade or turns.
constexpr double kOffsetSigma = 1;
constexpr double kNoise = 12;  // grey levels, of a sample
// Samples err alike where a car gleams; so many count at most.
constexpr double kMostIndependent = 40;
constexpr double kHuber = 1.5;
constexpr int kIterations = 5;
constexpr double kLeastGain = 0.1, kMostGain = 10, kMostOffset = 30;

}  // namespace

std::map<obs::FrameId, double> solveGains(const std::vector<obs::FrameId>& frames,
                                          const std::vector<ExposurePair>& pairs) {
    std::map<obs::FrameId, int> index;
    for (const auto& frame : frames) index.emplace(frame, 0);
    int n = 0;
    for (auto& [frame, i] : index) i = n++;
    std::map<obs::FrameId, double> out;
    if (n == 0) return out;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    const auto add = [&](int a, int b, double value, double weight) {
        entries.emplace_back(a, a, weight);
        entries.emplace_back(b, b, weight);
        entries.emplace_back(std::max(a, b), std::min(a, b), -weight);  // the lower triangle
        right[a] += weight * value;
        right[b] -= weight * value;
    };
    for (const auto& pair : pairs) {
        const auto a = index.find(pair.a), b = index.find(pair.b);
        if (a == index.end() || b == index.end() || a == b) continue;
        add(a->second, b->second, pair.logRatio, pair.weight);
    }
    const double together = 1 / (kNeighbourSigma * kNeighbourSigma);
    for (int i = 1; i < n; ++i) add(i - 1, i, 0, together);
    for (int i = 0; i < n; ++i) entries.emplace_back(i, i, kGaugeWeight);
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factors(matrix);
    Eigen::VectorXd logs = Eigen::VectorXd::Zero(n);
    if (factors.info() == Eigen::Success) logs = factors.solve(right);
    const double mean = logs.mean();
    for (const auto& [frame, i] : index) {
        out[frame] = std::clamp(std::exp(logs[i] - mean), kLeastGain, kMostGain);
    }
    return out;
}

Exposure fitExposure(const ExposureSamples& s, const Exposure& guess, double gainSigma) {
    Exposure out = guess;
    double total = 0;
    for (const float w : s.weight) total += static_cast<double>(w);
    const double share = total > kMostIndependent ? kMostIndependent / total : 1;
    const double sigma = gainSigma * guess.gain;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        // Normal equations in (gain, offset), with the guess as a prior.
        double aa = kNoise * kNoise / (sigma * sigma), ab = 0,
               bb = kNoise * kNoise / (kOffsetSigma * kOffsetSigma);
        double ra = aa * guess.gain, rb = bb * guess.offset;
        for (std::size_t i = 0; i < s.common.size(); ++i) {
            const auto c = static_cast<double>(s.common[i]), v = static_cast<double>(s.shown[i]);
            const double off = std::abs(v - out.gain * c - out.offset) / kNoise;
            const double w =
                share * static_cast<double>(s.weight[i]) * (off <= kHuber ? 1.0 : kHuber / off);
            aa += w * c * c;
            ab += w * c;
            bb += w;
            ra += w * c * v;
            rb += w * v;
        }
        const double determinant = aa * bb - ab * ab;
        if (!(determinant > 0)) return guess;
        out.gain = std::clamp((ra * bb - rb * ab) / determinant, kLeastGain, kMostGain);
        out.offset = std::clamp((rb * aa - ra * ab) / determinant, -kMostOffset, kMostOffset);
    }
    return out;
}

}  // namespace djpete::texture
