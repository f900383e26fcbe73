/// Builds the object models of a result again, view by view.
#pragma once

#include <functional>
#include <string>

#include "djpete/evaluation/estimated_drive.h"
#include "djpete/texture/object_texturer.h"

namespace djpete::evaluation {

struct RebuildOptions {
    texture::TextureOptions texture;
    double range_m = 30;  ///< objects farther than this are left out of a view
};

/// Called after each view.
using AfterView = std::function<void(std::size_t frame, const texture::ObjectTexturer& texturer)>;

/// Gives the images and scans of the result's keyframes to a new texturer, in order, with the
/// result's final poses, settles it and returns it. Objects have no masks. Throws obs::InputError
/// if the rawlog cannot be read.
texture::ObjectTexturer rebuildTextures(const EstimatedDrive& drive, const std::string& rawlog,
                                        const RebuildOptions& options, const AfterView& afterView);

}  // namespace djpete::evaluation
