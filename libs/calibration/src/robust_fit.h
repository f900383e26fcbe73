/// Linear least squares that outliers cannot pull, with standard errors from the spread between
/// groups (frames) of measurements.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace djpete::calibration {

template <int N>
struct LinearRow {
    Eigen::Matrix<double, N, 1> x;  ///< derivative of the prediction
    double y = 0;                   ///< measured minus predicted
    double sigma = 1;               ///< relative to other rows
    std::size_t group = 0;          ///< rising
};

template <int N>
struct LinearFit {
    Eigen::Matrix<double, N, 1> solution = Eigen::Matrix<double, N, 1>::Zero();
    Eigen::Matrix<double, N, 1> sigma = Eigen::Matrix<double, N, 1>::Zero();
    double scale = 0;  ///< robust standard deviation of y / sigma
    std::size_t used = 0, groups = 0;
    bool solved = false;
};

inline double medianOf(std::vector<double> v) {
    if (v.empty()) return 0;
    const auto middle = v.begin() + std::ptrdiff_t(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    return *middle;
}

/// Tukey's biweight at 4.7 standard deviations, which forgets gross outliers. The errors are the
/// larger of those of independent rows and those of independent groups: measurements of one frame
/// share scene and light, so frames tell more honestly how well a number is known.
template <int N>
LinearFit<N> robustFit(const std::vector<LinearRow<N>>& rows, int iterations = 12) {
    using Vec = Eigen::Matrix<double, N, 1>;
    using Mat = Eigen::Matrix<double, N, N>;
    LinearFit<N> out;
    if (rows.size() < std::size_t(4 * N)) return out;
    Mat H = Mat::Zero();
    const auto weightOf = [&](const LinearRow<N>& r, double e, bool first) {
        const double t = e / (4.7 * out.scale);
        if (first) return 1 / (r.sigma * r.sigma) / std::max(1.0, std::abs(t) * 4.7);
        return std::abs(t) < 1 ? (1 - t * t) * (1 - t * t) / (r.sigma * r.sigma) : 0.0;
    };
    const auto errorOf = [&](const LinearRow<N>& r) {
        return (r.y - r.x.dot(out.solution)) / r.sigma;
    };
    for (int i = 0; i < iterations; ++i) {
        std::vector<double> size;
        for (const auto& r : rows) size.push_back(std::abs(errorOf(r)));
        out.scale = std::max(1.4826 * medianOf(size), 1e-9);
        H.setZero();
        Vec b = Vec::Zero();
        for (const auto& r : rows) {
            const double w = weightOf(r, errorOf(r), i < 4);
            H += w * r.x * r.x.transpose();
            b += w * r.x * r.y;
        }
        H.diagonal() += Vec::Constant(1e-12 * H.diagonal().maxCoeff() + 1e-300);
        out.solution = H.ldlt().solve(b);
        if (!out.solution.allFinite()) return out;
    }
    const Mat inverse = H.ldlt().solve(Mat::Identity());
    Mat between = Mat::Zero();
    Vec ofGroup = Vec::Zero();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto& r = rows[i];
        if (i == 0 || r.group != rows[i - 1].group) {
            between += ofGroup * ofGroup.transpose();
            ofGroup.setZero();
            ++out.groups;
        }
        const double e = errorOf(r), w = weightOf(r, e, false);
        if (w > 0) ++out.used;
        ofGroup += w * (e * r.sigma) * r.x;
    }
    between += ofGroup * ofGroup.transpose();
    const double groups = double(out.groups);
    const Mat spread = inverse * between * inverse * (groups / std::max(1.0, groups - 1));
    for (int k = 0; k < N; ++k) {
        const double alone = out.scale * out.scale * inverse(k, k);
        out.sigma[k] = std::sqrt(std::max(alone, spread(k, k)));
    }
    out.solved = out.sigma.allFinite();
    return out;
}

}  // namespace djpete::calibration
