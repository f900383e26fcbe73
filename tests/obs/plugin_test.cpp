/// How MRPT's own tools read a companion rawlog:
///   rawlog-edit -p build/lib/libdjpete-obs-plugin.so --info -i drive_objects.rawlog
///   RawLogViewer -l build/lib/libdjpete-obs-plugin.so drive_objects.rawlog
/// The plug-in's path must be absolute or start with ./ (it goes to dlopen). Without the plug-in
/// the tools stop at the first object of an unknown class.
#include <gmock/gmock.h>

#include <array>
#include <cstdio>

#include "obs_samples.h"

namespace {

std::string outputOf(const std::string& command) {
    std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen((command + " 2>&1").c_str(), "r"), pclose);
    std::string out;
    std::array<char, 4096> part{};
    while (std::size_t n = std::fread(part.data(), 1, part.size(), pipe.get()))
        out.append(part.data(), n);
    return out;
}

}  // namespace

TEST(Plugin, LetsRawlogEditReadDetections) {
    if (outputOf("command -v rawlog-edit").empty()) GTEST_SKIP() << "skipped: needs rawlog-edit";
    const auto file = djpete_test::scratch("obs_plugin") / "d_objects.rawlog";
    obs_samples::writeRawlog(file,
                             {obs_samples::detectedObjects(0), obs_samples::detectedObjects(1),
                              obs_samples::detectedObjects(2)});
    const std::string info =
        outputOf("rawlog-edit -p " DJPETE_OBS_PLUGIN " --info -i " + file.string());
    EXPECT_THAT(info, testing::ContainsRegex("Overall number of objects *: 3"));
    EXPECT_THAT(info, testing::ContainsRegex("detections */ *3"));
    const std::string text =
        outputOf("rawlog-edit -p " DJPETE_OBS_PLUGIN " --describe -i " + file.string());
    EXPECT_THAT(text, testing::HasSubstr("2 detected objects"));
}
