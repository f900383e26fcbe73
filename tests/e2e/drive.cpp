#include "drive.h"

#include <fstream>
#include <sstream>

#include "djpete_test/shared_data.h"
#include "kitti2rawlog_app.h"
#include "simulate_drive_app.h"

namespace djpete_test {

namespace {

std::vector<const char*> argvOf(const char* program, const std::vector<std::string>& arguments) {
    std::vector<const char*> out{program};
    for (const auto& a : arguments) out.push_back(a.c_str());
    return out;
}

template <class F>
Outcome attempt(F&& f) {
    try {
        return {f(), ""};
    } catch (const std::exception& e) {
        return {1, e.what()};
    }
}

}  // namespace

Outcome simulate(const std::vector<std::string>& arguments) {
    return attempt([&] {
        const auto argv = argvOf("simulate-drive", arguments);
        djpete::apps::SimulateDriveApp app;
        std::ostringstream out;
        if (app.initialize(int(argv.size()), argv.data())) app.run(out);
        return 0;
    });
}

Outcome convert(const std::vector<std::string>& arguments) {
    return attempt([&] {
        const auto argv = argvOf("kitti2rawlog", arguments);
        djpete::kitti2rawlog::Kitti2RawlogApp app;
        std::ostringstream out;
        if (app.initialize(int(argv.size()), argv.data())) app.run(out);
        return 0;
    });
}

Outcome slam(djpete::apps::DjpeteSlamApp& app, const std::vector<std::string>& arguments,
             const std::string& ini) {
    std::vector<std::string> all{
        ini.empty() ? std::string(DJPETE_SOURCE_DIR) + "/datasets_cfg/simulated.ini" : ini};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.push_back("--quiet");
    auto outcome = attempt([&] {
        const auto argv = argvOf("djpete-slam", all);
        return app.initialize(int(argv.size()), argv.data()) ? app.run() : 0;
    });
    if (outcome.sentence.empty()) outcome.sentence = app.summary.error;
    return outcome;
}

const fs::path& smallDrive() {
    static const fs::path folder = [] {
        const auto dir = scratch("e2e_small_drive");
        const auto outcome = simulate(
            {"--out", dir.string(), "--frames", "0:12", "--seed", "3", "--size", "620x188"});
        if (outcome.code != 0) throw std::runtime_error(outcome.sentence);
        return dir;
    }();
    return folder;
}

fs::path copyOfSmallDrive(const std::string& name) {
    const auto dir = scratch(name);
    fs::copy(smallDrive(), dir, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    return dir;
}

std::string textOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::stringstream out;
    out << in.rdbuf();
    return out.str();
}

}  // namespace djpete_test
