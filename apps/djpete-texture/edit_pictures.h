/// Pictures of object models to look at.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "djpete/texture/object_model.h"

namespace djpete::apps {

/// One row of a picture.
struct PictureRow {
    std::string caption;
    const texture::ObjectModel* model = nullptr;
};

/// Writes a PNG with a row per model: left, right, front, back, and from above the front's left.
/// All rows are seen by the same cameras, made for the first model's size. Makes the folder. Throws
/// obs::InputError naming the file that cannot be written.
void writePicture(const std::vector<PictureRow>& rows, const std::filesystem::path& file);

}  // namespace djpete::apps
