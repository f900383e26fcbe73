#include "scene_camera.h"

#include <algorithm>
#include <cmath>

#include "djpete/io/scene_view.h"

namespace djpete::io {

namespace {

using geometry::Vec3;

void lookFrom(const Vec3& eye, const Vec3& target, mrpt::opengl::CCamera& camera) {
    SceneView view;
    view.eye = eye;
    view.target = target;
    setCamera(view, camera);
}

}  // namespace

void placeCamera(const map::SlamMap& map, const SceneOptions& options,
                 mrpt::opengl::COpenGLScene& scene) {
    auto viewport = scene.getViewport("main");
    viewport->setCustomBackgroundColor(mrpt::img::TColorf(0.93F, 0.94F, 0.96F));
    viewport->setViewportClipDistances(0.5F, 3000.0F);
    Vec3 first(0, 0, 0), ahead(1, 0, 0), low(0, 0, 0), high(0, 0, 0);
    if (!map.frames().empty()) {
        const geometry::SE3 T_world_cam = *map.cameraAt(map.frames().begin()->first);
        first = low = high = T_world_cam.translation();
        ahead = T_world_cam.rotation().col(2);
        ahead.z() = 0;
        ahead = ahead.norm() > 1e-6 ? Vec3(ahead.normalized()) : Vec3(1, 0, 0);
        for (const auto& [id, pose] : map.frames()) {
            const Vec3 at = map.cameraAt(id)->translation();
            low = low.cwiseMin(at);
            high = high.cwiseMax(at);
        }
    }
    if (options.bird_view) {
        const Vec3 centre = 0.5 * (low + high);
        const double reach = std::max(40.0, 1.3 * (high - low).norm());
        lookFrom(centre - 0.02 * reach * ahead + Vec3(0, 0, reach), centre, viewport->getCamera());
        return;
    }
    const Vec3 eye = first - options.view_behind_m * ahead + Vec3(0, 0, options.view_height_m);
    lookFrom(eye, first + 26 * ahead - Vec3(0, 0, 1.5), viewport->getCamera());
}

}  // namespace djpete::io
