/// Where the picture of a scene is taken from.
#pragma once

#include "djpete/io/scene_writer.h"

namespace djpete::io {

/// Sets camera, light and background colour of the scene's main viewport.
void placeCamera(const map::SlamMap& map, const SceneOptions& options,
                 mrpt::opengl::COpenGLScene& scene);

}  // namespace djpete::io
