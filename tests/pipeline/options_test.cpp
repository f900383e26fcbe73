/// Options: every shipped INI loads, and nothing unknown is ever swallowed.
#include "djpete/pipeline/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>

#include <filesystem>
#include <fstream>

#include "djpete/obs/errors.h"

namespace djpete::pipeline {
namespace {

using testing::HasSubstr;

std::string errorOf(const std::string& text) {
    try {
        ObjectSlamOptions::fromText(text, "test.ini");
    } catch (const obs::InputError& e) {
        return e.what();
    }
    return "";
}

std::vector<std::filesystem::path> shippedInis() {
    std::vector<std::filesystem::path> out;
    for (const auto& entry : std::filesystem::directory_iterator(
             std::filesystem::path(DJPETE_SOURCE_DIR) / "datasets_cfg")) {
        if (entry.path().extension() == ".ini") out.push_back(entry.path());
    }
    return out;
}

TEST(Options, EveryShippedIniLoads) {
    const auto inis = shippedInis();
    EXPECT_GE(inis.size(), 4U);
    for (const auto& ini : inis) EXPECT_NO_THROW(ObjectSlamOptions::fromFile(ini.string())) << ini;
}

TEST(Options, PrintedConfigLoadsAndPrintsTheSame) {
    for (const auto& ini : shippedInis()) {
        const auto text = ObjectSlamOptions::fromFile(ini.string()).toText();
        EXPECT_EQ(ObjectSlamOptions::fromText(text, "printed").toText(), text) << ini;
    }
}

TEST(Options, ReferenceIniExplainsEveryKey) {
    // kitti_odometry.ini is where a user looks an option up: it must hold all of them.
    const auto file =
        std::filesystem::path(DJPETE_SOURCE_DIR) / "datasets_cfg" / "kitti_odometry.ini";
    std::ifstream in(file);
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    const mrpt::config::CConfigFileMemory shipped(text), all(ObjectSlamOptions().toText());
    std::vector<std::string> sections, keys;
    all.getAllSections(sections);
    for (const auto& section : sections) {
        all.getAllKeys(section, keys);
        for (const auto& key : keys) {
            EXPECT_TRUE(shipped.keyExists(section, key)) << "[" << section << "] " << key;
        }
    }
}

TEST(Options, UnknownKeyIsAnErrorInEverySection) {
    const mrpt::config::CConfigFileMemory all(ObjectSlamOptions().toText());
    std::vector<std::string> sections;
    all.getAllSections(sections);
    EXPECT_GE(sections.size(), 10U);
    for (const auto& section : sections) {
        const auto error = errorOf("[" + section + "]\nno_such_key = 1\n");
        EXPECT_THAT(error, HasSubstr("test.ini"));
        EXPECT_THAT(error, HasSubstr("no_such_key"));
        EXPECT_THAT(error, HasSubstr(section));
    }
}

TEST(Options, BackgroundIsOneOfThree) {
    struct Case {
        const char* word;
        bool cloud, octomap;
    };
    for (const auto& c :
         {Case{"off", false, false}, Case{"false", false, false}, Case{"cloud", true, false},
          Case{"true", true, false}, Case{"octomap", false, true}}) {
        const auto options = ObjectSlamOptions::fromText(
            std::string("[pipeline]\nbackground = ") + c.word + "\n", "test.ini");
        EXPECT_EQ(options.pipeline.background, c.cloud) << c.word;
        EXPECT_EQ(options.pipeline.octomap, c.octomap) << c.word;
        const auto again = ObjectSlamOptions::fromText(options.toText(), "printed");
        EXPECT_EQ(again.pipeline.background, c.cloud) << c.word;
        EXPECT_EQ(again.pipeline.octomap, c.octomap) << c.word;
    }
    EXPECT_THAT(errorOf("[pipeline]\nbackground = voxels\n"), HasSubstr("octomap"));
    EXPECT_THAT(errorOf("[octomap]\nresolution_m = -1\n"), HasSubstr("resolution_m"));
}

TEST(Options, UnknownSectionIsAnError) {
    EXPECT_THAT(errorOf("[fronted]\nseed = 1\n"), HasSubstr("unknown section [fronted]"));
}

TEST(Options, WrongValuesAreErrors) {
    EXPECT_THAT(errorOf("[pipeline]\nmode = fast\n"),
                HasSubstr("expected one of: threaded, lockstep"));
    EXPECT_THAT(errorOf("[pipeline]\nobserver = yolo\n"), HasSubstr("expected one of"));
    EXPECT_THAT(errorOf("[pipeline]\ntexture_lag_keyframes = -1\n"),
                HasSubstr("texture_lag_keyframes"));
    EXPECT_THAT(errorOf("[frontend]\nfeatures_wanted = -5\n"), HasSubstr("features_wanted"));
}

TEST(Options, MissingFileIsAnError) {
    EXPECT_THROW(ObjectSlamOptions::fromFile("/no/such.ini"), obs::InputError);
}

TEST(Options, CommandLineOverridesTheFile) {
    ObjectSlamOptions o;
    o.overridePipeline("[pipeline]\nmode = lockstep\n", "command line");
    EXPECT_EQ(o.pipeline.mode, "lockstep");
    EXPECT_EQ(o.pipeline.observer, "auto");
    EXPECT_THROW(o.overridePipeline("[pipeline]\nmode = x\n", "command line"), obs::InputError);
}

}  // namespace
}  // namespace djpete::pipeline
