/// Robust kernels on the whitened residual norm.
#pragma once

#include <cmath>

namespace djpete::solver {

/// rho(s) of the squared whitened norm s = |r|^2; a residual costs rho(|r|^2) / 2, as Ceres defines
/// it. `scale` is the norm (in sigmas) from which a residual counts as an outlier. rho(s) ~ s for
/// small s.
struct RobustKernel {
    enum class Type { None, Huber, Cauchy, GemanMcClure };

    Type type = Type::None;
    double scale = 1;  ///< > 0

    static RobustKernel none() { return {}; }
    static RobustKernel huber(double scale) { return {Type::Huber, scale}; }
    static RobustKernel cauchy(double scale) { return {Type::Cauchy, scale}; }
    static RobustKernel gemanMcClure(double scale) { return {Type::GemanMcClure, scale}; }

    double rho(double s) const {
        const double a2 = scale * scale;
        switch (type) {
            case Type::Huber:
                return s <= a2 ? s : 2 * scale * std::sqrt(s) - a2;
            case Type::Cauchy:
                return a2 * std::log1p(s / a2);
            case Type::GemanMcClure:
                return s / (1 + s / a2);
            case Type::None:
                break;
        }
        return s;
    }
    /// d rho / d s: the weight of iterated least squares.
    double weight(double s) const {
        const double a2 = scale * scale;
        switch (type) {
            case Type::Huber:
                return s <= a2 ? 1 : scale / std::sqrt(s);
            case Type::Cauchy:
                return 1 / (1 + s / a2);
            case Type::GemanMcClure: {
                const double q = 1 + s / a2;
                return 1 / (q * q);
            }
            case Type::None:
                break;
        }
        return 1;
    }
    /// Within `scale`, or without a kernel.
    bool isInlier(double s) const { return type == Type::None || s <= scale * scale; }
};

}  // namespace djpete::solver
