#include "object_meshes.h"

#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "djpete/simulator/object_truth.h"
#include "parallel.h"

namespace djpete::simulator {

namespace fs = std::filesystem;

std::set<uint32_t> labelledIds(const fs::path& labelFile) {
    std::ifstream in(labelFile);
    if (!in) throw std::runtime_error(labelFile.string() + ": cannot be read");
    std::set<uint32_t> ids;
    int row = 0;
    for (std::string line; std::getline(in, line);) {
        ++row;
        std::istringstream words(line);
        uint64_t frame = 0;
        uint32_t id = 0;
        if (!(words >> frame >> id))
            throw std::runtime_error(labelFile.string() + ", line " + std::to_string(row) +
                                     ": expected a frame and a track id");
        ids.insert(id);
    }
    return ids;
}

void writeObjectMeshes(const World& world, const std::set<uint32_t>& ids, double texel_m,
                       const fs::path& folder, unsigned threads) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) throw std::runtime_error(folder.string() + ": the folder cannot be made");
    const std::vector<uint32_t> all(ids.begin(), ids.end());
    parallelFor(static_cast<int>(all.size()), threads, [&](int i) {
        const uint32_t id = all[static_cast<std::size_t>(i)];
        char name[32];
        std::snprintf(name, sizeof name, "%03u.ply", id);
        const fs::path file = folder / name, begun = folder / (std::string(name) + ".part");
        if (fs::exists(file)) return;
        writePly(objectTruth(world.actors().at(id - 1), texel_m), begun);
        fs::rename(begun, file);
    });
}

}  // namespace djpete::simulator
