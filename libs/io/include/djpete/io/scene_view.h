/// Pictures of a scene from any place, without a display.
#pragma once

#include <mrpt/img/CImage.h>
#include <mrpt/opengl/COpenGLScene.h>

#include <optional>
#include <set>
#include <string>

#include "djpete/geometry/types.h"

namespace djpete::io {

/// The camera of a picture, in world. It stands upright; `eye` must not be straight above.
struct SceneView {
    geometry::Vec3 eye{0, 0, 0}, target{0, 0, 0};
    double height_deg = 30;  ///< vertical field of view
    int width_px = 1600, height_px = 900;
};

/// MRPT's camera for a view.
void setCamera(const SceneView& view, mrpt::opengl::CCamera& camera);

struct ScenePicture {
    std::optional<mrpt::img::CImage> image;
    std::string whyNot;  ///< one sentence, if there is none, e.g. no EGL on this machine
};

/// The width is rounded down to a multiple of 4, which MRPT's renderer needs.
ScenePicture pictureOf(const mrpt::opengl::COpenGLScene& scene, const SceneView& view);

/// Throws obs::InputError naming the file if it is missing or no scene.
mrpt::opengl::COpenGLScene::Ptr loadScene(const std::string& file);

/// Shows these of the scene's layers (see makeScene) and hides the others.
void showLayers(mrpt::opengl::COpenGLScene& scene, const std::set<std::string>& names);

}  // namespace djpete::io
