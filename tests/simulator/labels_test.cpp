/// Labels against the pictures' own truth.
#include <algorithm>

#include "small_drive.h"

using namespace small_drive;

namespace {

struct MaskBox {
    double left = 1e9, top = 1e9, right = -1, bottom = -1;
    int pixels = 0;
};

std::map<uint32_t, MaskBox> maskBoxes(const sim::RenderedImage& image) {
    std::map<uint32_t, MaskBox> out;
    for (int v = 0; v < image.height_px; ++v) {
        for (int u = 0; u < image.width_px; ++u) {
            const uint32_t id = image.actorId[image.index(u, v)];
            if (id == 0) continue;
            auto& b = out[id];
            b.left = std::min<double>(b.left, u);
            b.right = std::max<double>(b.right, u);
            b.top = std::min<double>(b.top, v);
            b.bottom = std::max<double>(b.bottom, v);
            ++b.pixels;
        }
    }
    return out;
}

double overlap(const sim::Label& a, const MaskBox& b) {
    const double w = std::min(a.right, b.right) - std::max(a.left, b.left);
    const double h = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
    if (w <= 0 || h <= 0) return 0;
    const double both = w * h;
    return both / ((a.right - a.left) * (a.bottom - a.top) +
                   (b.right - b.left) * (b.bottom - b.top) - both);
}

}  // namespace

TEST(SimulatedLabels, BoxesOfFullyVisibleCarsAreThoseOfTheirMasks) {
    int checked = 0;
    for (uint32_t seed : {1U, 2U, 3U}) {
        Scene scene(seed, 1241, 376);
        for (uint64_t frame : {0U, 12U, 25U}) {
            const auto image = scene.left(frame);
            const auto masks = maskBoxes(image);
            for (const auto& l : scene.labels(frame, image)) {
                // The mask of somebody far off is coarse, that of a half hidden or cut one smaller.
                const bool person = l.type == "Pedestrian" || l.type == "Cyclist";
                if (l.occlusion != 0 || l.truncation > 0.001 || l.bottom - l.top < 20 ||
                    (person && l.right - l.left < 14))
                    continue;
                const auto& mask = masks.at(l.trackId);
                EXPECT_GT(overlap(l, mask), 0.75) << sim::toKittiRow(l);
                // Nothing of the car is outside of its box.
                EXPECT_GT(mask.left, l.left - 1.5);
                EXPECT_LT(mask.right, l.right + 1.5);
                EXPECT_GT(mask.top, l.top - 1.5);
                EXPECT_LT(mask.bottom, l.bottom + 1.5);
                ++checked;
            }
        }
    }
    EXPECT_GT(checked, 20);
}

TEST(SimulatedLabels, EveryCarInRangeThatIsSeenHasOneLabel) {
    for (uint32_t seed : {4U, 5U}) {
        Scene scene(seed, 1241, 376);
        const auto image = scene.left(10);
        const SE3 T_cam_world =
            (scene.world.T_world_vehicle(10) * sim::T_vehicle_camera()).inverse();
        std::map<uint32_t, int> labelled;
        for (const auto& l : scene.labels(10, image)) ++labelled[l.trackId];
        const auto masks = maskBoxes(image);
        EXPECT_GT(masks.size(), 5U);
        for (const auto& car : scene.world.actors()) {
            const auto mask = masks.find(car.id);
            const double range =
                (T_cam_world * scene.world.T_world_obj(car, 10).translation()).norm();
            const bool due = mask != masks.end() && mask->second.pixels >= 25 && range <= 60;
            EXPECT_EQ(labelled[car.id], due ? 1 : 0) << "car " << car.id << " at " << range << " m";
        }
    }
}

TEST(SimulatedLabels, PosesAndSizesAreTheCars) {
    Scene scene(6, 1241, 376);
    const auto image = scene.left(5);
    const auto labels = scene.labels(5, image);
    ASSERT_GT(labels.size(), 4U);
    const SE3 T_world_cam = scene.world.T_world_vehicle(5) * sim::T_vehicle_camera();
    for (const auto& l : labels) {
        const auto actor = std::find_if(scene.world.actors().begin(), scene.world.actors().end(),
                                        [&](const auto& c) { return c.id == l.trackId; });
        ASSERT_NE(actor, scene.world.actors().end());
        const SE3 T_world_obj = scene.world.T_world_obj(*actor, 5);
        const SE3 error = T_world_obj.inverse() * T_world_cam * poseOf(l);
        // A label cannot say how the camera is pitched and rolled (under 1 degree here).
        EXPECT_LT(error.translation().norm(), 0.03);
        EXPECT_LT(error.angle_rad(), 0.02);
        EXPECT_NEAR(l.length_m, actor->size_m.x(), 1e-9);
        EXPECT_NEAR(l.width_m, actor->size_m.y(), 1e-9);
        EXPECT_NEAR(l.height_m, actor->size_m.z(), 1e-9);
        EXPECT_NEAR(
            std::remainder(l.rotationY_rad - std::atan2(l.x_m, l.z_m) - l.alpha_rad, 2 * M_PI), 0,
            1e-9);
    }
}

TEST(SimulatedLabels, ActorsThatNeverMoveStay) {
    Scene scene(7);
    int moving = 0;
    for (const auto& actor : scene.world.actors()) {
        if (!scene.world.present(actor, 10) || !scene.world.present(actor, 20)) continue;
        const Vec3 way = scene.world.T_world_obj(actor, 20).translation() -
                         scene.world.T_world_obj(actor, 10).translation();
        if (!actor.moving) {
            EXPECT_EQ(way.norm(), 0);
        }
        moving += way.norm() > 1 ? 1 : 0;
    }
    EXPECT_GE(moving, 2);
}
