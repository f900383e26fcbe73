/// Times of every stage on a whole drive: `djpete_bench_line [CONFIG.ini DRIVE.rawlog]`.
/// Without a drive it simulates one (30 frames, 1241x376, scans, recorded detections). Lockstep
/// mode, so that the stages do not compete for the cores; wall times.
#include <cstdio>
#include <iostream>

#include "djpete_test/shared_data.h"
#include "drive.h"

namespace {

namespace fs = std::filesystem;

fs::path simulatedRawlog() {
    const auto dir = djpete_test::scratch("bench_line");
    const auto drive = (dir / "drive").string(), rawlog = (dir / "drive.rawlog").string();
    for (const auto& outcome :
         {djpete_test::simulate({"--out", drive, "--frames", "0:30", "--seed", "1"}),
          djpete_test::convert({"--input", drive, "--out", rawlog, "--labels", "none"})}) {
        if (outcome.code != 0) throw std::runtime_error(outcome.sentence);
    }
    return rawlog;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 1 && argc != 3) {
        std::cerr << "use: djpete_bench_line [CONFIG.ini DRIVE.rawlog]\n";
        return 1;
    }
    try {
        const std::string config = argc == 3 ? argv[1] : "";
        const fs::path rawlog = argc == 3 ? fs::path(argv[2]) : simulatedRawlog();
        djpete::apps::DjpeteSlamApp app;
        const auto out = djpete_test::scratch("bench_line_result").string();
        const auto outcome =
            djpete_test::slam(app, {rawlog.string(), "--out", out, "--mode", "lockstep"}, config);
        if (outcome.code != 0) throw std::runtime_error(outcome.sentence);
        const auto row = [&](const char* what, const char* stage) {
            const auto it = app.summary.timings.find(stage);
            if (it == app.summary.timings.end()) return;
            std::printf("%-28s %6zu %9.2f %9.2f %9.2f\n", what, it->second.count(),
                        it->second.p50_ms(), it->second.p95_ms(), it->second.max_ms());
        };
        std::printf("%-28s %6s %9s %9s %9s\n", "stage", "calls", "p50 ms", "p95 ms", "max ms");
        row("front end, per frame", "front end");
        row("local BA, per keyframe", "back end: backbone");
        row("object worker, per job", "back end: objects");
        row("association, per frame", "back end: associate");
        row("observer, per frame", "observer");
        row("texture, per view", "texture");
        row("background, per view", "background");
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "djpete_bench_line: " << e.what() << "\n";
        return 1;
    }
}
