/// Residuals of plain vectors: priors on points and twists, differences of twists.
#pragma once

#include "djpete/geometry/types.h"

namespace djpete::geometry {

/// e = W (x - x_expected) for a vector of N entries.
template <int N>
class VectorPrior {
  public:
    static constexpr int kDim = N;
    static constexpr const char* kName = N == 3 ? "PointPriorResidual" : "VectorPriorResidual";
    using Vec = Eigen::Matrix<double, N, 1>;
    using Mat = Eigen::Matrix<double, N, N>;

    /// `sqrt_information` as of sqrtInformation().
    VectorPrior(const Vec& expected, const Mat& sqrt_information)
        : expected_(expected), sqrt_information_(sqrt_information) {}

    Vec operator()(const Vec& x, Mat* J_x = nullptr) const {
        if (J_x) *J_x = sqrt_information_;
        return sqrt_information_ * (x - expected_);
    }

  private:
    Vec expected_;
    Mat sqrt_information_;
};

/// Variable: p_world.
using PointPriorResidual = VectorPrior<3>;
/// Variable: a twist or any other vector of six.
using VectorPriorResidual = VectorPrior<6>;

/// e = W (v_k1 - v_k): a body twist changes slowly. Variables: v_k, v_k1.
class TwistDifferenceResidual {
  public:
    static constexpr int kDim = 6;
    static constexpr const char* kName = "TwistDifferenceResidual";

    explicit TwistDifferenceResidual(const Mat6& sqrt_information)
        : sqrt_information_(sqrt_information) {}

    Vec6 operator()(const Vec6& v_k, const Vec6& v_k1, Mat6* J_k = nullptr,
                    Mat6* J_k1 = nullptr) const {
        if (J_k) *J_k = -sqrt_information_;
        if (J_k1) *J_k1 = sqrt_information_;
        return sqrt_information_ * (v_k1 - v_k);
    }

  private:
    Mat6 sqrt_information_;
};

}  // namespace djpete::geometry
