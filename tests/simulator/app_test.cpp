// The program, run in-process.
#include <gtest/gtest.h>

#include <sstream>

#include "drive_files.h"
#include "simulate_drive_app.h"

namespace {

using djpete::apps::SimulateDriveApp;

bool initialize(SimulateDriveApp& app, std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "simulate-drive");
    return app.initialize(static_cast<int>(arguments.size()), arguments.data());
}

TEST(SimulateDrive, WritesTheFramesAskedFor) {
    const djpete_test::ScratchFolder folder("app");
    SimulateDriveApp app;
    const std::string out = (folder.path() / "drive").string();
    ASSERT_TRUE(initialize(app, {"--out", out.c_str(), "--frames", "1:3", "--seed", "7", "--size",
                                 "124x64", "--no-scans", "--no-color", "--detection-miss", "1"}));
    std::ostringstream report;
    app.run(report);
    EXPECT_NE(report.str().find("2 frames"), std::string::npos) << report.str();
    const auto files = djpete_test::filesOf(out);
    EXPECT_FALSE(files.count("image_0/000000.png"));
    EXPECT_TRUE(files.count("image_0/000001.png") && files.count("image_0/000002.png"));
    EXPECT_FALSE(files.count("image_0/000003.png"));
    EXPECT_EQ(files.at("detections.txt"), "");
    EXPECT_NE(files.at("label_02.txt"), "");
}

TEST(SimulateDrive, HelpIsNoError) {
    SimulateDriveApp app;
    EXPECT_FALSE(initialize(app, {"--help"}));
}

TEST(SimulateDrive, BadArgumentsAreNamed) {
    const std::vector<std::pair<std::vector<const char*>, std::string>> cases{
        {{"--frames", "0:2"}, "required"},
        {{"--out", "x", "--frames", "5:5"}, "5:5"},
        {{"--out", "x", "--frames", "a:b"}, "a:b"},
        {{"--out", "x", "--size", "12by9"}, "12by9"},
        {{"--out", "x", "--size", "8x8"}, "8x8"},
        {{"--out", "x", "--step", "-1"}, "step"},
        {{"--out", "x", "--detection-miss", "1.5"}, "detection-miss"},
        {{"--out", "x", "--threads", "-2"}, "threads"},
        {{"--out", "x", "--no-such-option"}, "no-such-option"},
    };
    for (const auto& [arguments, expected] : cases) {
        SimulateDriveApp app;
        try {
            initialize(app, arguments);
            FAIL() << "no error about " << expected;
        } catch (const std::exception& e) {
            EXPECT_NE(std::string(e.what()).find(expected), std::string::npos) << e.what();
        }
    }
}

}  // namespace
