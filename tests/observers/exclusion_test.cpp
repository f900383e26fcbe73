/// Objects in the image: hulls, boxes and the exclusion image.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "djpete/observers/projection.h"
#include "synthetic_scan.h"

namespace {

using namespace djpete;
using geometry::Cuboid;
using geometry::Mat3;
using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

/// A box with its length along the viewing direction, in cam.
SE3 ahead(double x, double y, double z) {
    Mat3 R;
    R << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    return SE3(R, Vec3(x, y, z));
}

const Cuboid kCar{{4, 1.8, 1.5}};

TEST(CuboidHull, EnclosesEveryProjectedCorner) {
    const auto camera = djpete_test::forwardCamera().model;
    const SE3 T = ahead(2, 0.5, 15) * SE3::fromYaw(0.4, Vec3::Zero());
    const auto hull = observers::cuboidHull(kCar, T, camera);
    ASSERT_GE(hull.size(), 4U);
    const auto box = observers::projectCuboid(kCar, T, camera);
    ASSERT_TRUE(box);
    for (const auto& corner : kCar.corners()) {
        const Vec2 uv = camera.project(T * corner);
        EXPECT_GE(uv.x(), static_cast<double>(box->left) - 1e-2);
        EXPECT_LE(uv.x(), static_cast<double>(box->right) + 1e-2);
        EXPECT_GE(uv.y(), static_cast<double>(box->top) - 1e-2);
        EXPECT_LE(uv.y(), static_cast<double>(box->bottom) + 1e-2);
        int positive = 0, negative = 0;
        for (std::size_t i = 0; i < hull.size(); ++i) {
            const Vec2 a = hull[i], e = hull[(i + 1) % hull.size()] - a, w = uv - a;
            const double cross = (e.x() * w.y() - e.y() * w.x()) / e.norm();
            positive += cross > 1e-2;
            negative += cross < -1e-2;
        }
        EXPECT_TRUE(positive == 0 || negative == 0) << "a corner lies outside";
    }
}

TEST(CuboidHull, CutsAtTheNearPlane) {
    const auto camera = djpete_test::forwardCamera().model;
    EXPECT_TRUE(observers::cuboidHull(kCar, ahead(0, 0, -10), camera).empty());
    EXPECT_FALSE(observers::projectCuboid(kCar, ahead(0, 0, -10), camera));
    EXPECT_FALSE(observers::projectCuboid(kCar, ahead(50, 0, 10), camera));
    // Half in front: a car beside us reaches the left border of the image, and no further right
    // than its front corner.
    const SE3 T = ahead(-3, 0.8, 1.0);
    const auto box = observers::projectCuboid(kCar, T, camera);
    ASSERT_TRUE(box);
    EXPECT_EQ(box->left, 0.F);
    const Vec2 frontCorner = camera.project(T * Vec3(2, -0.9, -0.75));
    EXPECT_NEAR(static_cast<double>(box->right), frontCorner.x(), 0.01);
}

obs::CObservationDetectedObjects oneObject(const SE3& T_vehicle_obj) {
    obs::CObservationDetectedObjects o;
    const SE3 T_vehicle_sensor = SE3::fromYaw(0.3, Vec3(0.5, 0.1, 0.2));
    o.sensorPose = geometry::toCPose3D(T_vehicle_sensor);
    obs::ObjectDetection d;
    d.size_m = kCar.size_m;
    d.T_sensor_obj = T_vehicle_sensor.inverse() * T_vehicle_obj;
    o.detections.push_back(d);
    return o;
}

int countOf(const mrpt::img::CImage& image, uint8_t value) {
    const cv::Mat& m = image.asCvMatRef();
    int n = 0;
    for (int v = 0; v < m.rows; ++v)
        for (int u = 0; u < m.cols; ++u) n += m.at<uint8_t>(v, u) == value;
    return n;
}

TEST(ExclusionImage, CoversTheProjectedBoxWhereThereIsNoMask) {
    const auto rig = djpete_test::forwardCamera();
    const SE3 T_vehicle_obj = SE3::fromYaw(0.2, Vec3(12, 2, -0.9));
    const auto image = observers::exclusionImage(oneObject(T_vehicle_obj), rig, 0);
    EXPECT_EQ(image.getWidth(), 1242U);
    EXPECT_EQ(image.getHeight(), 375U);
    EXPECT_FALSE(image.isColor());
    const auto at = [&](const Vec3& p_obj) {
        const Vec2 uv = rig.model.project(rig.T_vehicle_cam.inverse() * T_vehicle_obj * p_obj);
        return image.asCvMatRef().at<uint8_t>(static_cast<int>(std::lround(uv.y())),
                                              static_cast<int>(std::lround(uv.x())));
    };
    EXPECT_EQ(at({0, 0, 0}), 255);
    for (const auto& corner : kCar.corners()) EXPECT_EQ(at(0.95 * corner), 255);
    EXPECT_EQ(at({0, 0, 1.6}), 0);
    EXPECT_EQ(at({0, 3.5, 0}), 0);
    EXPECT_EQ(countOf(image, 255) + countOf(image, 0), 1242 * 375);
    EXPECT_GT(countOf(observers::exclusionImage(oneObject(T_vehicle_obj), rig, 5), 255),
              countOf(image, 255));
}

TEST(ExclusionImage, PrefersTheMaskAndGrowsItByTheMargin) {
    const auto rig = djpete_test::forwardCamera();
    auto objects = oneObject(SE3::fromYaw(0, Vec3(12, 2, -0.9)));
    std::vector<uint8_t> dense(1242 * 375, 0);
    dense[100 * 1242 + 200] = 1;
    objects.detections[0].mask = obs::RleMask::fromDense(dense.data(), 1242, 375, 1242);
    EXPECT_EQ(countOf(observers::exclusionImage(objects, rig, 0), 255), 1);
    const auto grown = observers::exclusionImage(objects, rig, 3);
    const cv::Mat& m = grown.asCvMatRef();
    EXPECT_EQ(m.at<uint8_t>(100, 203), 255);
    EXPECT_EQ(m.at<uint8_t>(97, 200), 255);
    EXPECT_EQ(m.at<uint8_t>(100, 204), 0);
    // A mask of another image's size cannot be used: the box stands in.
    objects.detections[0].mask = obs::RleMask{10, 10, {100}};
    EXPECT_GT(countOf(observers::exclusionImage(objects, rig, 0), 255), 1000);
}

TEST(ExclusionImage, TakesCarsBesideAndBehindUs) {
    const auto rig = djpete_test::forwardCamera();
    EXPECT_EQ(
        countOf(observers::exclusionImage(oneObject(SE3::fromYaw(0, {-9, 1, 0})), rig, 4), 255), 0);
    const auto beside =
        observers::exclusionImage(oneObject(SE3::fromYaw(0, {1.5, 3, -0.9})), rig, 0);
    EXPECT_EQ(beside.asCvMatRef().at<uint8_t>(374, 2), 255);
    EXPECT_EQ(beside.asCvMatRef().at<uint8_t>(200, 900), 0);
    auto broken = rig;
    broken.model.width_px = 0;
    EXPECT_THROW(observers::exclusionImage({}, broken, 0), obs::InputError);
    EXPECT_THROW(observers::exclusionImage({}, rig, -1), obs::InputError);
}

}  // namespace
