#include "djpete/simulator/map_view.h"

#include <algorithm>
#include <cmath>

namespace djpete::simulator {

using geometry::SE3;
using geometry::Vec3;

RenderedImage renderMap(Renderer& renderer, const World& world, uint64_t frame, int side_px) {
    constexpr double kMargin_m = 35, kHeight_m = 420;
    Vec3 low = world.T_world_vehicle(0).translation(), high = low;
    for (uint64_t f = 0; f < world.frames(); f += 5) {
        low = low.cwiseMin(world.T_world_vehicle(f).translation());
        high = high.cwiseMax(world.T_world_vehicle(f).translation());
    }
    const Vec3 size = high - low + Vec3::Constant(2 * kMargin_m);
    const double scale = side_px / std::max(size.x(), size.y());
    geometry::StereoCamera camera;
    camera.width_px = std::max(8, static_cast<int>(std::lround(scale * size.x())));
    camera.height_px = std::max(8, static_cast<int>(std::lround(scale * size.y())));
    camera.fx = camera.fy = scale * kHeight_m;
    camera.cx = 0.5 * camera.width_px;
    camera.cy = 0.5 * camera.height_px;
    camera.baseline_m = 1;
    geometry::Mat3 axes;  // image right: x, image down: -y, ahead: down
    axes << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    const Vec3 middle = 0.5 * (low + high);
    const SE3 T_world_cam(axes, Vec3(middle.x(), middle.y(), low.z() + kHeight_m));
    return renderer.renderCamera(frame, camera,
                                 world.T_world_vehicle(frame).inverse() * T_world_cam, 7);
}

}  // namespace djpete::simulator
