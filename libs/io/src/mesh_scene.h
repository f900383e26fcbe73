/// A mesh as the exporters of Assimp want it.
#pragma once

#include <assimp/scene.h>

#include <memory>
#include <string>
#include <vector>

#include "djpete/texture/surface.h"

namespace djpete::io {

struct SceneStyle {
    std::string texture;       ///< "*0": inside the scene; else a file's name
    std::vector<uint8_t> png;  ///< of the texture inside
    bool yUp = false;          ///< turned to glTF's axes: x left, y up, z ahead
    bool linearColours = false;
};

/// One node, one mesh, one unlit material that is seen from both sides.
std::unique_ptr<aiScene> sceneOf(const texture::ColouredMesh& mesh, const SceneStyle& style);

/// Of the atlas; PNG.
std::vector<uint8_t> pngOf(const texture::MeshAtlas& atlas);

}  // namespace djpete::io
