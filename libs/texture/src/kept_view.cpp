#include "kept_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "view_geometry.h"

namespace djpete::texture {

namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

constexpr float kNear_m = 0.3F;
constexpr double kPixelsPerVoxel = 2;
constexpr int kDepthStep_px = 2;  // a depth per so many pixels is enough: tolerances are wide
constexpr int kBorder_px = 3;
constexpr uint8_t kUsable = 255, kOutside = 128;  // 0: hidden, or near the mask's border

/// The camera of a cut-out that starts at (x0, y0) and is scaled to `size`.
geometry::StereoCamera cutCamera(const geometry::StereoCamera& camera, const PixelRect& rect,
                                 const cv::Size& size) {
    const double sx = size.width / static_cast<double>(rect.x1 - rect.x0);
    const double sy = size.height / static_cast<double>(rect.y1 - rect.y0);
    geometry::StereoCamera out;
    out.fx = camera.fx * sx;
    out.fy = camera.fy * sy;
    out.cx = (camera.cx - rect.x0 + 0.5) * sx - 0.5;
    out.cy = (camera.cy - rect.y0 + 0.5) * sy - 0.5;
    out.width_px = size.width;
    out.height_px = size.height;
    return out;
}

/// A point of the model as the camera of a cut-out sees it.
struct SeenPoint {
    uint32_t index = 0;
    float u = 0, v = 0, facingCos = 0, range_m = 0;
    Eigen::Vector3f p_cam, n_cam;
};

/// All points in front of the camera and within or near the cut-out.
std::vector<SeenPoint> project(const ObjectModel& model, const geometry::StereoCamera& camera,
                               const SE3& T_cam_obj) {
    std::vector<SeenPoint> out;
    out.reserve(model.size());
    const auto& xs = model.cloud->getPointsBufferRef_x();
    const auto& ys = model.cloud->getPointsBufferRef_y();
    const auto& zs = model.cloud->getPointsBufferRef_z();
    const Eigen::Matrix3f R = T_cam_obj.rotation().cast<float>();
    const Eigen::Vector3f t = T_cam_obj.translation().cast<float>();
    const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
    const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
    constexpr float kOutside_px = 30;  // their discs may reach in
    const float maxU = static_cast<float>(camera.width_px) + kOutside_px;
    const float maxV = static_cast<float>(camera.height_px) + kOutside_px;
    for (uint32_t i = 0; i < model.size(); ++i) {
        const Eigen::Vector3f p = R * Eigen::Vector3f(xs[i], ys[i], zs[i]) + t;
        if (!(p.z() >= kNear_m)) continue;
        const float u = fx * p.x() / p.z() + cx, v = fy * p.y() / p.z() + cy;
        if (!(u > -kOutside_px && v > -kOutside_px && u < maxU && v < maxV)) continue;
        const auto& normal = model.normals[i];
        const Eigen::Vector3f n = R * Eigen::Vector3f(normal[0], normal[1], normal[2]);
        const float range = p.norm();
        out.push_back({i, u, v, -n.dot(p) / range, range, p, n});
    }
    return out;
}

/// Depths of the model's points; coarser than the cut-out.
class OwnSurface {
  public:
    OwnSurface(const ObjectModel& model, const geometry::StereoCamera& camera,
               const std::vector<SeenPoint>& seen)
        : depth_(PixelRect{0, 0, (camera.width_px + kDepthStep_px - 1) / kDepthStep_px,
                           (camera.height_px + kDepthStep_px - 1) / kDepthStep_px}) {
        geometry::StereoCamera coarse = camera;
        coarse.fx /= kDepthStep_px;
        coarse.fy /= kDepthStep_px;
        coarse.cx = (camera.cx + 0.5) / kDepthStep_px - 0.5;
        coarse.cy = (camera.cy + 0.5) / kDepthStep_px - 0.5;
        for (const auto& s : seen) {
            depth_.drawDisc(DiscInImage(coarse, s.p_cam, s.n_cam, model.radius_m[s.index]));
        }
    }
    /// Of a pixel of the cut-out; infinity where there is no point.
    float at(int x, int y) const {
        return x < 0 || y < 0 ? std::numeric_limits<float>::infinity()
                              : depth_.at(x / kDepthStep_px, y / kDepthStep_px);
    }

    bool has(int x, int y) const {
        return x >= 0 && y >= 0 && depth_.has(x / kDepthStep_px, y / kDepthStep_px);
    }

  private:
    DepthMap depth_;
};

/// Depths of the model's points and, where there is none, of the box.
class ExpectedDepth {
  public:
    ExpectedDepth(const geometry::StereoCamera& camera, const SE3& T_cam_obj, const Vec3& size_m,
                  const OwnSurface& own, double margin_m)
        : camera_(camera),
          T_obj_cam_(T_cam_obj.inverse()),
          half_((0.5 * size_m).array() + margin_m),
          own_(own) {}
    /// Nothing where neither point nor box is.
    std::optional<double> at(int x, int y) const {
        const float own = own_.at(x, y);
        if (std::isfinite(own)) return static_cast<double>(own);
        return entryShare(T_obj_cam_.translation(), T_obj_cam_.rotation() * camera_.ray(Vec2(x, y)),
                          half_);
    }

  private:
    const geometry::StereoCamera& camera_;
    SE3 T_obj_cam_;
    Vec3 half_;
    const OwnSurface& own_;
};

/// 255 where the pixels of the cut-out show the object and nothing else.
cv::Mat usablePixels(const Surroundings& around, const KeptView& view, const PixelRect& rect,
                     const ObjectModel& model, const OwnSurface& own,
                     const TextureOptions& options) {
    const cv::Size size(view.camera.width_px, view.camera.height_px);
    cv::Mat usable(size, CV_8UC1, cv::Scalar(kUsable));
    if (!around.mask.empty()) {
        const cv::Rect part(rect.x0, rect.y0, rect.x1 - rect.x0, rect.y1 - rect.y0);
        cv::resize(around.mask(part), usable, size, 0, 0, cv::INTER_AREA);
    }
    const ExpectedDepth depth(view.camera, view.T_cam_obj, model.size_m, own, options.box_margin_m);
    const double toX = (rect.x1 - rect.x0) / static_cast<double>(size.width);
    const double toY = (rect.y1 - rect.y0) / static_cast<double>(size.height);
    for (int y = 0; y < size.height; ++y) {
        uint8_t* row = usable.ptr<uint8_t>(y);
        const int fullY = rect.y0 + static_cast<int>((y + 0.5) * toY);
        for (int x = 0; x < size.width; ++x) {
            const int fullX = rect.x0 + static_cast<int>((x + 0.5) * toX);
            const bool outside =
                !around.grownMask.empty() && around.grownMask.at<uint8_t>(fullY, fullX) == 0;
            if (row[x] != kUsable && !outside) {
                row[x] = 0;
                continue;
            }
            const auto z = depth.at(x, y);
            const bool seen =
                z &&
                *z <= static_cast<double>(around.scene.at(fullX, fullY)) +
                          options.scene_tolerance_m &&
                std::none_of(around.boxes.begin(), around.boxes.end(), [&](const auto& box) {
                    return box.hides(view.camera.backProject(Vec2(x, y), *z));
                });
            row[x] = !seen ? uint8_t{0} : outside ? kOutside : kUsable;
        }
    }
    return usable;
}

/// Pixels that may not be used become black (outside the mask: black with a trace of red), and
/// ones that are as dark but may be used become a little lighter.
void hideUnusable(const cv::Mat& usable, cv::Mat& colours) {
    const int channels = colours.channels();
    for (int y = 0; y < colours.rows; ++y) {
        uint8_t* row = colours.ptr<uint8_t>(y);
        for (int x = 0; x < colours.cols; ++x) {
            uint8_t* pixel = row + x * channels;
            const uint8_t use = usable.at<uint8_t>(y, x);
            if (use != kUsable) {
                std::fill(pixel, pixel + channels, uint8_t{0});
                if (use == kOutside) pixel[channels - 1] = 1;
            } else if (std::all_of(pixel, pixel + channels, [](uint8_t v) { return v <= 1; })) {
                std::fill(pixel, pixel + channels, uint8_t{2});
            }
        }
    }
}

bool isOutside(const uint8_t* pixel, int channels) {
    return pixel[channels - 1] == 1 && (channels == 1 || (pixel[0] == 0 && pixel[1] == 0));
}

bool mayBeUsed(const uint8_t* pixel, int channels) {
    return channels == 1 ? pixel[0] > 1 : (pixel[0] | pixel[1] | pixel[2]) > 1;
}

/// Mean contrast of neighbouring usable pixels over their mean brightness.
float sharpnessOf(const cv::Mat& pixels) {
    const int channels = pixels.channels(), green = channels == 3 ? 1 : 0;
    double contrast = 0, brightness = 0;
    for (int y = 0; y < pixels.rows; ++y) {
        const uint8_t* row = pixels.ptr<uint8_t>(y);
        for (int x = 1; x < pixels.cols; ++x) {
            const uint8_t* b = row + x * channels;
            const uint8_t* a = b - channels;
            if (!mayBeUsed(a, channels) || !mayBeUsed(b, channels)) continue;
            contrast += std::abs(a[green] - b[green]);
            brightness += b[green];
        }
    }
    return brightness > 0 ? static_cast<float>(contrast / brightness) : 0;
}

/// Bilinear; nothing unless all four pixels may be used.
std::optional<std::array<float, 3>> colourAt(const cv::Mat& pixels, float u, float v) {
    const int x = floorToInt(u), y = floorToInt(v);
    if (x < 0 || y < 0 || x + 1 >= pixels.cols || y + 1 >= pixels.rows) return std::nullopt;
    const int channels = pixels.channels();
    const uint8_t* top = pixels.ptr<uint8_t>(y) + x * channels;
    const uint8_t* below = pixels.ptr<uint8_t>(y + 1) + x * channels;
    if (!mayBeUsed(top, channels) || !mayBeUsed(top + channels, channels) ||
        !mayBeUsed(below, channels) || !mayBeUsed(below + channels, channels)) {
        return std::nullopt;
    }
    const float fx = u - static_cast<float>(x), fy = v - static_cast<float>(y);
    std::array<float, 3> rgb{};
    for (int c = 0; c < channels; ++c) {
        const float a =
            static_cast<float>(top[c]) * (1 - fx) + static_cast<float>(top[channels + c]) * fx;
        const float b =
            static_cast<float>(below[c]) * (1 - fx) + static_cast<float>(below[channels + c]) * fx;
        rgb[static_cast<std::size_t>(2 - c)] = a * (1 - fy) + b * fy;  // stored blue first
    }
    if (channels == 1) rgb[0] = rgb[1] = rgb[2];
    return rgb;
}

/// Without a mask the object's own points tell where its outline is: pixels near it are left out.
bool nearOutline(const OwnSurface& own, int x, int y, int border_px) {
    for (int dy = -border_px; dy <= border_px; dy += border_px) {
        for (int dx = -border_px; dx <= border_px; dx += border_px) {
            if (!own.has(x + dx, y + dy)) return true;
        }
    }
    return false;
}

/// As std::lround does, halves away from zero. Doubles hold the sum exactly enough.
int nearestInt(float x) {
    const double d = static_cast<double>(x);
    return static_cast<int>(d < 0 ? d - 0.5 : d + 0.5);
}

/// Of the points that the view sees.
void takeSamples(const ObjectModel& model, const TextureOptions& options,
                 const std::vector<SeenPoint>& seen, const OwnSurface& own, KeptView& view) {
    view.samples.assign(model.size(), 0);
    view.sampled = 0;
    const auto tolerance = static_cast<float>(options.self_tolerance_m);
    for (const auto& s : seen) {
        if (static_cast<double>(s.facingCos) < options.min_facing_cos) continue;
        if (static_cast<double>(s.range_m) > options.max_distance_m) continue;
        const int x = nearestInt(s.u), y = nearestInt(s.v);
        if (s.p_cam[2] > own.at(x, y) + tolerance) continue;
        if (!view.masked && nearOutline(own, x, y, options.mask_border_px)) continue;
        const auto rgb = colourAt(view.pixels, s.u, s.v);
        if (!rgb) continue;
        const float nearness =
            std::min(1.0F, static_cast<float>(options.reference_distance_m) / s.range_m);
        view.samples[s.index] = packSample(*rgb, s.facingCos * s.facingCos * nearness * nearness);
        ++view.sampled;
    }
}

}  // namespace

std::optional<KeptView> cutView(const Surroundings& around, const SE3& T_cam_obj,
                                const ObjectModel& model, const TextureOptions& options) {
    const PixelRect rect = rectOfBox(around.image.camera, T_cam_obj, model.size_m, kBorder_px);
    if (rect.x1 - rect.x0 < 2 * kBorder_px + 2 || rect.y1 - rect.y0 < 2 * kBorder_px + 2) {
        return std::nullopt;
    }
    const double nearest =
        std::max(1.0, T_cam_obj.translation().norm() - 0.5 * model.size_m.norm());
    const double pixelsPerVoxel = around.image.camera.fx * options.voxel_m / nearest;
    const double scale = std::min(1.0, kPixelsPerVoxel / pixelsPerVoxel);
    const cv::Rect part(rect.x0, rect.y0, rect.x1 - rect.x0, rect.y1 - rect.y0);
    const cv::Size size(std::max(4, static_cast<int>(std::lround(part.width * scale))),
                        std::max(4, static_cast<int>(std::lround(part.height * scale))));
    KeptView view;
    view.camera = cutCamera(around.image.camera, rect, size);
    view.masked = !around.mask.empty();
    view.T_cam_obj = T_cam_obj;
    cv::Mat colours;
    cv::resize(around.image.pixels(part), colours, size, 0, 0, cv::INTER_AREA);
    const std::vector<SeenPoint> seen = project(model, view.camera, T_cam_obj);
    const OwnSurface own(model, view.camera, seen);
    hideUnusable(usablePixels(around, view, rect, model, own, options), colours);
    view.pixels = colours;
    takeSamples(model, options, seen, own, view);
    // By the metre on the object, so that near and far views compare.
    view.sharpness = sharpnessOf(view.pixels) *
                     static_cast<float>(view.camera.fx / T_cam_obj.translation().norm());
    return view;
}

std::vector<bool> contradicted(const ObjectModel& model, const KeptView& view) {
    std::vector<bool> out(model.size(), false);
    if (!view.masked) return out;
    const int channels = view.pixels.channels();
    for (const SeenPoint& s : project(model, view.camera, view.T_cam_obj)) {
        const int x = static_cast<int>(std::lround(s.u)), y = static_cast<int>(std::lround(s.v));
        if (x < 0 || y < 0 || x >= view.pixels.cols || y >= view.pixels.rows) continue;
        out[s.index] = isOutside(view.pixels.ptr<uint8_t>(y) + x * channels, channels);
    }
    return out;
}

void sampleView(const ObjectModel& model, const TextureOptions& options, KeptView& view) {
    const std::vector<SeenPoint> seen = project(model, view.camera, view.T_cam_obj);
    takeSamples(model, options, seen, OwnSurface(model, view.camera, seen), view);
}

}  // namespace djpete::texture
