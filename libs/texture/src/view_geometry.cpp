#include "view_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "dense_stereo.h"
#include "djpete/geometry/cuboid.h"

namespace djpete::texture {

namespace {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

constexpr double kNear_m = 0.3;
constexpr int kStereoEdge_px = 2;  // matching fattens foreground edges by about this

/// The boxes of a view's objects as seen from one sensor frame s.
class Boxes {
  public:
    Boxes(const TextureView& view, const SE3& T_world_s, const TextureOptions& options)
        : margin_(options.box_margin_m), clearance_(options.ground_clearance_m) {
        for (const auto& object : view.objects) {
            Box box;
            box.T_obj_s = object.T_world_obj.inverse() * T_world_s;
            box.centre_s = box.T_obj_s.inverse().translation();
            box.half = 0.5 * object.size_m;
            const double reach = box.half.norm() + 2 * margin_;
            box.reach2 = reach * reach;
            boxes_.push_back(box);
        }
    }

    struct Owner {
        std::size_t object = 0;
        Vec3 p_obj{0, 0, 0};
        bool road = false;
    };
    /// The object that p_s belongs to, if any.
    std::optional<Owner> ownerOf(const Vec3& p_s) const {
        std::optional<Owner> owner;
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < boxes_.size(); ++k) {
            const Box& box = boxes_[k];
            const double distance2 = (p_s - box.centre_s).squaredNorm();
            if (distance2 > box.reach2 || distance2 >= nearest) continue;
            const Vec3 q = box.T_obj_s * p_s;
            if ((q.cwiseAbs() - box.half).maxCoeff() > margin_) continue;
            nearest = distance2;
            owner = Owner{k, q, q.z() < -box.half.z() + clearance_};
        }
        return owner;
    }
    const Vec3& sensorInObject(std::size_t k) const { return boxes_[k].T_obj_s.translation(); }

  private:
    struct Box {
        SE3 T_obj_s;
        Vec3 centre_s{0, 0, 0}, half{0, 0, 0};
        double reach2 = 0;
    };
    std::vector<Box> boxes_;
    double margin_, clearance_;
};

SurfacePoint surfacePoint(const Boxes::Owner& owner, const Boxes& boxes) {
    return {owner.p_obj, (boxes.sensorInObject(owner.object) - owner.p_obj).normalized()};
}

bool outsideMask(const cv::Mat& mask, const Vec2& uv) {
    if (mask.empty()) return false;
    const int x = static_cast<int>(std::lround(uv.x())), y = static_cast<int>(std::lround(uv.y()));
    return mask.at<uint8_t>(y, x) == 0;
}

}  // namespace

ViewGeometry::ViewGeometry(const TextureView& view, const ViewImage& image)
    : onObject(view.objects.size()), scene(PixelRect{0, 0, image.pixels.cols, image.pixels.rows}) {}

ViewGeometry geometryFromScan(const TextureView& view, const ViewImage& image,
                              const std::vector<cv::Mat>& grownMasks,
                              const TextureOptions& options) {
    ViewGeometry out(view, image);
    const SE3 T_world_velo = view.T_world_vehicle * view.scan->T_vehicle_velo;
    const SE3 T_cam_velo = view.T_world_cam.inverse() * T_world_velo;
    const Boxes boxes(view, T_world_velo, options);
    // Half a beam spacing, and one pixel of safety.
    const double toRad = M_PI / 180;
    const double halfWidth =
        1 + image.camera.fx * std::tan(0.5 * toRad * options.scan_horizontal_spacing_deg);
    const double halfHeight =
        1 + image.camera.fy * std::tan(0.5 * toRad * options.scan_vertical_spacing_deg);
    for (const auto& point : view.scan->points) {
        const Vec3 p_velo = point.position();
        const Vec3 p_cam = T_cam_velo * p_velo;
        const bool ahead = p_cam.z() > kNear_m;
        const Vec2 uv = ahead ? image.camera.project(p_cam) : Vec2(-1, -1);
        if (const auto owner = boxes.ownerOf(p_velo)) {
            const bool inImage = ahead && image.camera.contains(uv);
            if (owner->road || (inImage && outsideMask(grownMasks[owner->object], uv))) continue;
            out.onObject[owner->object].push_back(surfacePoint(*owner, boxes));
        } else if (ahead && image.camera.contains(uv, -halfHeight)) {
            out.scene.drawPoint(uv, p_cam.z(), halfWidth, halfHeight);
        }
    }
    return out;
}

void carveFreeSpace(const TextureView& view, const ObjectInView& object, FreeSpace& space) {
    constexpr double kFarthest_m = 30, kMargin_m = 0.3;
    const SE3 T_obj_velo =
        object.T_world_obj.inverse() * view.T_world_vehicle * view.scan->T_vehicle_velo;
    const Vec3 centre_velo = T_obj_velo.inverse().translation();
    const double distance = centre_velo.norm(), reach = 0.5 * object.size_m.norm() + kMargin_m;
    if (distance > kFarthest_m || distance <= reach) return;
    if (space.empty()) space.reset(object.size_m + Vec3::Constant(kMargin_m));
    // Only rays in the cone around the box.
    const Eigen::Vector3f towards = (centre_velo / distance).cast<float>();
    const double sine = reach / distance;
    const auto cos2 = static_cast<float>(1 - sine * sine);
    for (const auto& point : view.scan->points) {
        const Eigen::Vector3f p = point.position().cast<float>();
        const float along = towards.dot(p);
        if (along <= 0 || along * along < cos2 * p.squaredNorm()) continue;
        space.addRay(T_obj_velo.translation(), T_obj_velo * point.position());
    }
}

PixelRect rectOfBox(const geometry::StereoCamera& camera, const SE3& T_cam_obj, const Vec3& size_m,
                    int border_px) {
    Vec2 low(1e9, 1e9), high(-1e9, -1e9);
    for (const Vec3& corner : geometry::Cuboid{size_m}.corners()) {
        const Vec3 p_cam = T_cam_obj * corner;
        if (p_cam.z() < kNear_m) return {};
        const Vec2 uv = camera.project(p_cam);
        low = low.cwiseMin(uv);
        high = high.cwiseMax(uv);
    }
    low = low.cwiseMax(Vec2(-1e6, -1e6));
    high = high.cwiseMin(Vec2(1e6, 1e6));
    return {std::max(0, static_cast<int>(std::floor(low.x())) - border_px),
            std::max(0, static_cast<int>(std::floor(low.y())) - border_px),
            std::min(camera.width_px, static_cast<int>(std::ceil(high.x())) + border_px + 1),
            std::min(camera.height_px, static_cast<int>(std::ceil(high.y())) + border_px + 1)};
}

namespace {

/// Points of object k; other pixels with depth go to the scene.
void addStereoPoints(const cv::Mat& depth, const PixelRect& rect, std::size_t k,
                     const cv::Mat& mask, const Boxes& boxes, const ViewImage& image,
                     ViewGeometry& out) {
    cv::Mat mine(depth.size(), CV_8UC1, cv::Scalar(0));
    for (int y = rect.y0; y < rect.y1; ++y) {
        const float* row = depth.ptr<float>(y - rect.y0);
        for (int x = rect.x0; x < rect.x1; ++x) {
            const double z = static_cast<double>(row[x - rect.x0]);
            if (z <= 0) continue;
            const auto owner = boxes.ownerOf(image.camera.backProject(Vec2(x, y), z));
            if (!owner) {
                out.scene.drawPoint(Vec2(x, y), z, 1, 1);
            } else if (owner->object == k && !owner->road && !outsideMask(mask, Vec2(x, y))) {
                mine.at<uint8_t>(y - rect.y0, x - rect.x0) = 255;
            }
        }
    }
    const int kernel = 2 * kStereoEdge_px + 1;
    cv::erode(mine, mine, cv::getStructuringElement(cv::MORPH_RECT, {kernel, kernel}),
              cv::Point(-1, -1), 1, cv::BORDER_CONSTANT, cv::Scalar(0));
    for (int y = rect.y0; y < rect.y1; ++y) {
        for (int x = rect.x0; x < rect.x1; ++x) {
            if (mine.at<uint8_t>(y - rect.y0, x - rect.x0) == 0) continue;
            const double z = static_cast<double>(depth.at<float>(y - rect.y0, x - rect.x0));
            const auto owner = boxes.ownerOf(image.camera.backProject(Vec2(x, y), z));
            out.onObject[k].push_back(surfacePoint(*owner, boxes));
        }
    }
}

}  // namespace

ViewGeometry geometryFromStereo(const TextureView& view, const ViewImage& image,
                                const std::vector<cv::Mat>& erodedMasks,
                                const TextureOptions& options) {
    ViewGeometry out(view, image);
    if (!view.images.right || !image.camera.hasRight() || !options.stereo_geometry) return out;
    const std::array<cv::Mat, 2> pair = greyPair(view);
    const Boxes boxes(view, view.T_world_cam, options);
    for (std::size_t k = 0; k < view.objects.size(); ++k) {
        const auto& object = view.objects[k];
        const SE3 T_cam_obj = view.T_world_cam.inverse() * object.T_world_obj;
        const double distance = T_cam_obj.translation().norm();
        if (distance > options.stereo_max_distance_m) continue;
        const PixelRect rect = rectOfBox(image.camera, T_cam_obj, object.size_m, kStereoEdge_px);
        if (rect.empty()) continue;
        const double reach = 0.5 * object.size_m.norm();
        const double nearest = std::max(1.0, 0.6 * (distance - reach));  // occluders count too
        const cv::Mat depth = denseDepth(pair, image.camera, rect, nearest, distance + reach,
                                         0);  // paint is plain; the box keeps nonsense out
        addStereoPoints(depth, rect, k, erodedMasks[k], boxes, image, out);
    }
    return out;
}

}  // namespace djpete::texture
