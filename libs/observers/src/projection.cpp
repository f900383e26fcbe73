#include "djpete/observers/projection.h"

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"

namespace djpete::observers {

namespace {

using geometry::Vec2;
using geometry::Vec3;

/// The eight corners that lie in front of the plane, and where the twelve edges cross it.
std::vector<Vec3> cornersInFront(const geometry::Cuboid& cuboid, const geometry::SE3& T_cam_obj,
                                 double near_m) {
    std::array<Vec3, 8> p_cam;
    const auto corners = cuboid.corners();
    for (std::size_t i = 0; i < 8; ++i) p_cam[i] = T_cam_obj * corners[i];
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < 8; ++i) {
        if (p_cam[i].z() >= near_m) out.push_back(p_cam[i]);
        for (std::size_t bit = 1; bit < 8; bit <<= 1) {
            if ((i & bit) != 0) continue;
            const Vec3 &a = p_cam[i], &b = p_cam[i | bit];
            if ((a.z() < near_m) == (b.z() < near_m)) continue;
            out.push_back(a + (near_m - a.z()) / (b.z() - a.z()) * (b - a));
        }
    }
    return out;
}

cv::Mat disc(int radius_px) {
    const int side = 2 * radius_px + 1;
    return cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side});
}

/// Puts `hull` into `image`, first clamped to a frame wide around it: cv::fillConvexPoly takes
/// integers, and a box that starts at the near plane projects very far out.
void fillHull(cv::Mat& image, const std::vector<Vec2>& hull) {
    const float far = 4.F * static_cast<float>(std::max(image.cols, image.rows));
    if (hull.size() < 3) return;
    std::vector<cv::Point2f> outline, clipped;
    for (const auto& p : hull)
        outline.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    const std::vector<cv::Point2f> frame{{-far, -far}, {far, -far}, {far, far}, {-far, far}};
    if (cv::intersectConvexConvex(outline, frame, clipped) <= 0 || clipped.size() < 3) return;
    std::vector<cv::Point> pixels;
    for (const auto& p : clipped) pixels.emplace_back(cvRound(p.x), cvRound(p.y));
    cv::fillConvexPoly(image, pixels, cv::Scalar(255));
}

}  // namespace

std::vector<Vec2> cuboidHull(const geometry::Cuboid& cuboid, const geometry::SE3& T_cam_obj,
                             const geometry::StereoCamera& camera, double nearPlane_m) {
    std::vector<cv::Point2f> pixels;
    for (const auto& p_cam : cornersInFront(cuboid, T_cam_obj, nearPlane_m)) {
        const Vec2 uv = camera.project(p_cam);
        pixels.emplace_back(static_cast<float>(uv.x()), static_cast<float>(uv.y()));
    }
    if (pixels.empty()) return {};
    std::vector<cv::Point2f> hull;
    cv::convexHull(pixels, hull);
    std::vector<Vec2> out;
    for (const auto& p : hull) out.emplace_back(p.x, p.y);
    return out;
}

std::optional<obs::ImageBox> projectCuboid(const geometry::Cuboid& cuboid,
                                           const geometry::SE3& T_cam_obj,
                                           const geometry::StereoCamera& camera,
                                           double nearPlane_m) {
    const auto hull = cuboidHull(cuboid, T_cam_obj, camera, nearPlane_m);
    if (hull.empty()) return std::nullopt;
    Vec2 low = hull.front(), high = hull.front();
    for (const auto& p : hull) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    low = low.cwiseMax(Vec2::Zero());
    high = high.cwiseMin(Vec2(camera.width_px - 1, camera.height_px - 1));
    if (!(low.x() < high.x()) || !(low.y() < high.y())) return std::nullopt;
    return obs::ImageBox{static_cast<float>(low.x()), static_cast<float>(low.y()),
                         static_cast<float>(high.x()), static_cast<float>(high.y())};
}

mrpt::img::CImage exclusionImage(const obs::CObservationDetectedObjects& objects,
                                 const obs::RigCamera& camera, int margin_px) {
    const auto& model = camera.model;
    if (model.width_px <= 0 || model.height_px <= 0 || margin_px < 0) {
        throw obs::InputError("exclusion image of " + std::to_string(model.width_px) + "x" +
                              std::to_string(model.height_px) + " pixels with margin " +
                              std::to_string(margin_px) +
                              "; expected a positive size and a margin of at least 0");
    }
    cv::Mat image = cv::Mat::zeros(model.height_px, model.width_px, CV_8UC1);
    const geometry::SE3 T_cam_sensor =
        camera.T_vehicle_cam.inverse() * geometry::fromCPose3D(objects.sensorPose);
    for (const auto& d : objects.detections) {
        if (d.mask && d.mask->consistent() &&
            d.mask->width_px == static_cast<uint32_t>(model.width_px) &&
            d.mask->height_px == static_cast<uint32_t>(model.height_px)) {
            auto dense = d.mask->toDense();
            image |= cv::Mat(model.height_px, model.width_px, CV_8UC1, dense.data());
        } else {
            fillHull(image, cuboidHull({d.size_m}, T_cam_sensor * d.T_sensor_obj, model));
        }
    }
    if (margin_px > 0) cv::dilate(image, image, disc(margin_px));
    return mrpt::img::CImage(image, mrpt::img::DEEP_COPY);
}

}  // namespace djpete::observers
