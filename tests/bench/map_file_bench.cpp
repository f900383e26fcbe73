/// Speed of map files: a map of 1,000 frames, as large as a real one.
///
///     djpete_bench_map_file [folder = /tmp] [repetitions = 5]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "map_file_world.h"

namespace {

template <class Action>
double median_ms(int repetitions, Action action) {
    std::vector<double> all;
    for (int i = 0; i < repetitions; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        action();
        const std::chrono::duration<double, std::milli> t =
            std::chrono::steady_clock::now() - begin;
        all.push_back(t.count());
    }
    std::sort(all.begin(), all.end());
    return all[all.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
    using namespace djpete::map;
    const std::filesystem::path file =
        std::filesystem::path(argc > 1 ? argv[1] : "/tmp") / "djpete_bench.djmap";
    const int repetitions = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
    WorldSize size;
    size.keyframes = 400;
    size.framesBetween = 2;
    size.features = 900;
    size.landmarks = 60000;
    size.objects = 100;
    size.statesPerObject = 30;
    const SlamMap map = MadeUpMap(size).map();
    const double save = median_ms(repetitions, [&] { saveMap(map, file, someInfo()); });
    const double load = median_ms(repetitions, [&] { loadMap(file); });
    std::printf(
        "%zu keyframes x %d features, %zu frames, %zu landmarks, %zu objects x %d states: %.1f MB, "
        "save %.0f ms, load %.0f ms (median of %d)\n",
        map.keyframes().size(), int(size.features), map.frames().size(), map.landmarks().size(),
        map.objects().size(), int(size.statesPerObject),
        double(std::filesystem::file_size(file)) / 1e6, save, load, repetitions);
    std::filesystem::remove(file);
    return 0;
}
