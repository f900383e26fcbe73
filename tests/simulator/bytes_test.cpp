// A seed tells every byte: reruns, thread counts and frame ranges change nothing.
#include <gtest/gtest.h>

#include "drive_files.h"

namespace {

using namespace djpete::simulator;
using djpete_test::ScratchFolder;

std::map<std::string, std::string> written(const DriveOptions& options, const std::string& name) {
    const ScratchFolder folder(name);
    writeDrive(options, folder.path(), nullptr);
    return djpete_test::filesOf(folder.path());
}

TEST(Bytes, ARerunWritesTheSameFiles) {
    const auto a = written(djpete_test::smallDrive(), "a"),
               b = written(djpete_test::smallDrive(), "b");
    EXPECT_EQ(a.size(),
              3U * 6 + 5);  // images, masks, scans; calib, times, poses, labels, detections
    EXPECT_TRUE(a == b);
}

TEST(Bytes, ThreadsDoNotMatter) {
    auto options = djpete_test::smallDrive();
    const auto one = written(options, "one");
    options.threads = 2;
    EXPECT_TRUE(one == written(options, "two"));
    options.threads = 5;
    EXPECT_TRUE(one == written(options, "five"));
}

TEST(Bytes, AFrameDoesNotDependOnTheRange) {
    auto options = djpete_test::smallDrive();
    const auto all = written(options, "all");
    options.begin = 2;
    options.end = 4;
    const auto part = written(options, "part");
    for (const char* file : {"image_0/000002.png", "image_3/000002.png", "velodyne/000002.bin",
                             "instances/000002.png"}) {
        ASSERT_TRUE(part.count(file)) << file;
        EXPECT_TRUE(part.at(file) == all.at(file)) << file;
    }
    EXPECT_FALSE(part.count("image_0/000001.png"));
}

TEST(Bytes, AnotherSeedIsAnotherDrive) {
    auto options = djpete_test::smallDrive();
    const auto a = written(options, "seed3");
    options.world.seed = 4;
    const auto b = written(options, "seed4");
    for (const char* file : {"image_0/000000.png", "velodyne/000000.bin", "label_02.txt"})
        EXPECT_FALSE(a.at(file) == b.at(file)) << file;
}

TEST(Bytes, SwitchesLeaveOutWholeFolders) {
    auto options = djpete_test::smallDrive();
    options.scans = false;
    options.colour = false;
    options.end = 1;
    const auto files = written(options, "grey");
    EXPECT_TRUE(files.count("image_0/000000.png") && files.count("image_1/000000.png"));
    for (const auto& [name, content] : files) {
        EXPECT_EQ(name.find("velodyne"), std::string::npos);
        EXPECT_EQ(name.find("image_2"), std::string::npos);
        EXPECT_EQ(name.find("image_3"), std::string::npos);
    }
}

}  // namespace
