/// Meshes of objects in files that other programs open.
#pragma once

#include <string>

#include "djpete/texture/surface.h"

namespace djpete::io {

/// By the file's ending:
///   .ply  binary_little_endian, frame obj, colours per vertex;
///   .obj  frame obj, with NAME.mtl and NAME.png (the atlas) beside it;
///   .glb  binary glTF with the atlas inside, y up and z ahead as glTF wants it, unlit.
/// A mesh without an atlas has colours per vertex there too. The same mesh gives the same bytes.
/// Throws obs::InputError naming the file if the ending is another, it cannot be written or the
/// mesh has no triangle.
void writeMesh(const texture::ColouredMesh& mesh, const std::string& file);

}  // namespace djpete::io
