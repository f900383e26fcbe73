/// The textured objects of a result folder.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "djpete/evaluation/estimated_drive.h"
#include "djpete/texture/object_model.h"

namespace djpete::evaluation {

using ObjectModels = std::map<int64_t, texture::ObjectModel>;

/// The models in the result's objects/NNNN.object, as the drive left them; none if there are no
/// such files. Throws obs::InputError naming a file that is damaged.
ObjectModels savedModels(const EstimatedDrive& estimate);

}  // namespace djpete::evaluation
