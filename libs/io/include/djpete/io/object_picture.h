/// Object models as pictures.
#pragma once

#include <string>
#include <vector>

#include "djpete/texture/object_model.h"

namespace djpete::io {

/// One row per model (e.g. before and after an edit), each seen from the left, the front, the
/// right, the back and from half ahead, all from the same places. PNG by software, no display or
/// EGL needed. Throws obs::InputError naming the file that cannot be written.
void writeObjectPicture(const std::vector<texture::ObjectModel>& models, const std::string& file);

}  // namespace djpete::io
