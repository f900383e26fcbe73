#include "djpete/evaluation/saved_models.h"

#include <filesystem>

#include "djpete/texture/object_file.h"

namespace djpete::evaluation {

ObjectModels savedModels(const EstimatedDrive& estimate) {
    ObjectModels out;
    for (const auto& [id, object] : estimate.objects) {
        const auto file = std::filesystem::path(estimate.folder) / "objects" /
                          texture::objectFileName({static_cast<uint64_t>(id)});
        if (std::filesystem::exists(file)) out.emplace(id, texture::loadObject(file).original);
    }
    return out;
}

}  // namespace djpete::evaluation
