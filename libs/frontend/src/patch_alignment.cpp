#include "patch_alignment.h"

#include <cmath>

namespace djpete::frontend {

namespace {

constexpr std::size_t kWide = kSide + 2;  // with a frame of one for derivatives
constexpr double kNoise = 3.0;            // grey levels between two views of a patch

/// Bilinear samples about (x, y): row r of the patch moved by shear * r
/// columns; false if any lies outside.
bool samplePatch(const cv::Mat& image, double x, double y, double shear, float* out) {
    constexpr int half = kHalf, side = 2 * half + 1;
    const double reach = half * std::abs(shear) + half;
    if (!(x - reach >= 0 && x + reach < image.cols - 1 && y - half >= 0 &&
          y + half < image.rows - 1)) {
        return false;
    }
    const int yFloor = static_cast<int>(std::floor(y));
    const auto fy = static_cast<float>(y - yFloor);
    for (int r = 0; r < side; ++r) {
        const double xr = x + shear * (r - half) - half;
        const int xFloor = static_cast<int>(std::floor(xr));
        const auto fx = static_cast<float>(xr - xFloor);
        const uint8_t* a = image.ptr<uint8_t>(yFloor + r - half) + xFloor;
        const uint8_t* b = image.ptr<uint8_t>(yFloor + r - half + 1) + xFloor;
        const float w00 = (1 - fx) * (1 - fy), w01 = fx * (1 - fy);
        const float w10 = (1 - fx) * fy, w11 = fx * fy;
        float* row = out + r * side;
        for (int c = 0; c < side; ++c) {
            row[c] = w00 * static_cast<float>(a[c]) + w01 * static_cast<float>(a[c + 1]) +
                     w10 * static_cast<float>(b[c]) + w11 * static_cast<float>(b[c + 1]);
        }
    }
    return true;
}

void removeMean(Patch& p) {
    auto values = p.head<static_cast<int>(kArea)>().array();
    values -= p.sum() / static_cast<float>(kArea);
}

double dot(const Patch& a, const Patch& b) { return a.dot(b); }

/// kWide x kWide bilinear samples about (x, y), `step` apart; false if any lies outside.
bool sampleWide(const cv::Mat& image, double x, double y, const geometry::Mat2& step,
                std::array<float, kWide * kWide>& out) {
    const double half = kHalf + 1;
    const double reachX = half * (std::abs(step(0, 0)) + std::abs(step(0, 1)));
    const double reachY = half * (std::abs(step(1, 0)) + std::abs(step(1, 1)));
    if (!(x - reachX >= 0 && x + reachX < image.cols - 1 && y - reachY >= 0 &&
          y + reachY < image.rows - 1)) {
        return false;
    }
    for (std::size_t r = 0; r < kWide; ++r) {
        for (std::size_t c = 0; c < kWide; ++c) {
            const double dc = static_cast<double>(c) - half, dr = static_cast<double>(r) - half;
            const double xs = x + step(0, 0) * dc + step(0, 1) * dr;
            const double ys = y + step(1, 0) * dc + step(1, 1) * dr;
            const int xi = static_cast<int>(xs), yi = static_cast<int>(ys);
            const auto fx = static_cast<float>(xs - xi), fy = static_cast<float>(ys - yi);
            const uint8_t* a = image.ptr<uint8_t>(yi) + xi;
            const uint8_t* b = image.ptr<uint8_t>(yi + 1) + xi;
            const float top = static_cast<float>(a[0]) + fx * static_cast<float>(a[1] - a[0]);
            const float low = static_cast<float>(b[0]) + fx * static_cast<float>(b[1] - b[0]);
            out[r * kWide + c] = top + fy * (low - top);
        }
    }
    return true;
}

double precision(double sigma) { return (kNoise / sigma) * (kNoise / sigma); }

}  // namespace

std::optional<PatchTemplate> PatchTemplate::from(const cv::Mat& grey, double u_px, double v_px,
                                                 const geometry::Mat2& stepsPerPixel,
                                                 const PlacePrior& prior) {
    std::array<float, kWide * kWide> wide;
    if (!sampleWide(grey, u_px, v_px, stepsPerPixel, wide)) return std::nullopt;
    PatchTemplate t;
    t.values_.setZero();
    for (auto& p : t.by_) p.setZero();
    for (std::size_t r = 0; r < kSide; ++r) {
        for (std::size_t c = 0; c < kSide; ++c) {
            const std::size_t w = (r + 1) * kWide + c + 1;
            const auto i = static_cast<Eigen::Index>(r * kSide + c);
            t.values_[i] = wide[w];
            t.by_[0][i] = 0.5F * (wide[w + 1] - wide[w - 1]);
            t.by_[1][i] = 0.5F * (wide[w + kWide] - wide[w - kWide]);
            t.by_[2][i] = t.by_[0][i] * (static_cast<float>(r) - static_cast<float>(kHalf));
        }
    }
    removeMean(t.values_);
    for (auto& p : t.by_) removeMean(p);
    t.prior_ = geometry::Vec3(0, precision(prior.row_px), precision(prior.shear)).asDiagonal();
    geometry::Mat3 H = t.prior_;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            H(i, j) += dot(t.by_[static_cast<std::size_t>(i)], t.by_[static_cast<std::size_t>(j)]);
        }
    }
    if (!(H(0, 0) > 100.0)) return std::nullopt;
    t.inverse_ = H.inverse();
    if (!t.inverse_.allFinite()) return std::nullopt;
    return t;
}

std::optional<PatchPlace> PatchTemplate::align(const cv::Mat& grey, const PatchPlace& start,
                                               double maxShift_px) const {
    PatchPlace out = start;
    Patch p = Patch::Zero(), e;
    const auto compare = [&] {
        if (!samplePatch(grey, out.u_px, out.v_px, out.shear, p.data())) return false;
        removeMean(p);
        e = p - values_;
        return true;
    };
    for (int i = 0; i < 12; ++i) {
        if (!compare()) return std::nullopt;
        const geometry::Vec3 moved(0, out.v_px - start.v_px, out.shear - start.shear);
        const geometry::Vec3 gradient =
            geometry::Vec3(dot(by_[0], e), dot(by_[1], e), dot(by_[2], e)) + prior_ * moved;
        const geometry::Vec3 step = inverse_ * gradient;
        out.u_px -= step.x();
        out.v_px -= step.y();
        out.shear -= step.z();
        if (std::abs(out.u_px - start.u_px) > maxShift_px ||
            std::abs(out.v_px - start.v_px) > 1.5 || std::abs(out.shear) > 1.0)
            return std::nullopt;
        if (step.cwiseAbs().maxCoeff() < 0.005) break;
    }
    if (!compare()) return std::nullopt;
    const double pp = dot(p, p), tt = dot(values_, values_);
    if (!(pp > 0) || !(tt > 0)) return std::nullopt;
    out.correlation = dot(p, values_) / std::sqrt(pp * tt);
    out.sigma_px = std::sqrt(dot(e, e) / kArea * inverse_(0, 0));
    return out;
}

}  // namespace djpete::frontend
