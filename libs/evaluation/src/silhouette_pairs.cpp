#include "djpete/evaluation/silhouette_pairs.h"

#include <algorithm>
#include <limits>

#include "djpete/geometry/cuboid.h"
#include "djpete/obs/overlap.h"
#include "djpete/solver/assignment.h"

namespace djpete::evaluation {

SilhouetteBuffer::SilhouetteBuffer(int width_px, int height_px)
    : width_px_(width_px), height_px_(height_px) {
    const auto pixels = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
    depth_m_.assign(pixels, std::numeric_limits<float>::infinity());
    owner_.assign(pixels, 0);
}

std::size_t SilhouetteBuffer::add(const texture::RenderedModel& rendered, int closeRadius_px) {
    const MaskImage closed = closedSilhouette(rendered, closeRadius_px);
    std::vector<float> depths;
    for (std::size_t i = 0; i < owner_.size(); ++i) {
        if (rendered.covered(i)) depths.push_back(rendered.depth_m[i]);
    }
    wholeArea_.push_back(area(closed));
    if (depths.empty()) return wholeArea_.size() - 1;
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    for (std::size_t i = 0; i < owner_.size(); ++i) {
        if (closed.pixels[i] == 0) continue;
        const float depth_m = rendered.covered(i) ? rendered.depth_m[i] : *middle;
        if (depth_m >= depth_m_[i]) continue;
        depth_m_[i] = depth_m;
        owner_[i] = static_cast<uint32_t>(wholeArea_.size());
    }
    return wholeArea_.size() - 1;
}

MaskImage SilhouetteBuffer::visible(std::size_t index) const {
    MaskImage out{width_px_, height_px_, {}};
    out.pixels.resize(owner_.size());
    std::transform(owner_.begin(), owner_.end(), out.pixels.begin(), [index](uint32_t owner) {
        return static_cast<uint8_t>(owner == index + 1 ? 255 : 0);
    });
    return out;
}

std::optional<obs::ImageBox> boxOf(const MaskImage& mask) {
    int left = mask.width_px, top = mask.height_px, right = 0, bottom = 0;
    for (int v = 0; v < mask.height_px; ++v) {
        for (int u = 0; u < mask.width_px; ++u) {
            if (mask.at(u, v) == 0) continue;
            left = std::min(left, u), right = std::max(right, u + 1);
            top = std::min(top, v), bottom = std::max(bottom, v + 1);
        }
    }
    if (right == 0) return std::nullopt;
    return obs::ImageBox{static_cast<float>(left), static_cast<float>(top),
                         static_cast<float>(right), static_cast<float>(bottom)};
}

std::optional<obs::ImageBox> projectedBox(const geometry::Vec3& size_m,
                                          const geometry::SE3& T_cam_obj,
                                          const geometry::StereoCamera& camera) {
    geometry::Vec2 low(1e9, 1e9), high(-1e9, -1e9);
    for (const geometry::Vec3& corner : geometry::Cuboid{size_m}.corners()) {
        const geometry::Vec3 p_cam = T_cam_obj * corner;
        if (p_cam.z() < 0.5) return std::nullopt;
        const geometry::Vec2 uv = camera.project(p_cam);
        low = low.cwiseMin(uv), high = high.cwiseMax(uv);
    }
    return obs::ImageBox{static_cast<float>(low.x()), static_cast<float>(low.y()),
                         static_cast<float>(high.x()), static_cast<float>(high.y())};
}

obs::ImageBox partInImage(const obs::ImageBox& box, const geometry::StereoCamera& camera) {
    return {std::max(0.F, box.left), std::max(0.F, box.top),
            std::min(static_cast<float>(camera.width_px), box.right),
            std::min(static_cast<float>(camera.height_px), box.bottom)};
}

std::vector<std::optional<std::size_t>> pairByBoxes(const std::vector<obs::ImageBox>& silhouettes,
                                                    const std::vector<obs::ImageBox>& truths,
                                                    double minOverlap) {
    Eigen::MatrixXd cost(silhouettes.size(), truths.size());
    for (std::size_t i = 0; i < silhouettes.size(); ++i) {
        for (std::size_t j = 0; j < truths.size(); ++j) {
            const double overlap = obs::imageOverlap(silhouettes[i], truths[j]);
            // A pair that is none costs more than to stay alone.
            cost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                overlap > 0 && overlap >= minOverlap ? 1 - overlap : 2;
        }
    }
    return solver::assign(cost, 1);
}

std::optional<SilhouetteFit> fitSilhouette(const MaskImage& silhouette, const MaskImage& mask,
                                           const MaskImage& ignored) {
    std::size_t inSilhouette = 0, inMask = 0, inBoth = 0;
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        if (!ignored.pixels.empty() && ignored.pixels[i] != 0) continue;
        const bool a = silhouette.pixels[i] != 0, b = mask.pixels[i] != 0;
        if (a) ++inSilhouette;
        if (b) ++inMask;
        if (a && b) ++inBoth;
    }
    if (inSilhouette == 0 || inMask == 0) return std::nullopt;
    SilhouetteFit out;
    out.iou = *silhouetteIou(silhouette, mask, ignored);
    out.excess = 1 - static_cast<double>(inBoth) / static_cast<double>(inSilhouette);
    out.missing = 1 - static_cast<double>(inBoth) / static_cast<double>(inMask);
    return out;
}

}  // namespace djpete::evaluation
