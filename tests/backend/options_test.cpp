#include <gmock/gmock.h>
#include <mrpt/config/CConfigFileMemory.h>

#include <fstream>
#include <set>
#include <sstream>

#include "djpete/backend/map_keeper.h"
#include "djpete/obs/errors.h"

namespace djpete::backend {
namespace {

using mrpt::config::CConfigFileMemory;

std::string text(const BackendOptions& options) {
    CConfigFileMemory config;
    options.save(config);
    return config.getContent();
}

TEST(BackendOptions, whatIsSavedIsLoadedAgain) {
    BackendOptions changed;
    changed.keeper.latency_keyframes = 3;
    changed.backbone.windowSize = 7;
    changed.backbone.minParallax_rad = 0.5;
    changed.association.filter.speed_mps = 4.5;
    changed.association.vehiclesOnly = false;
    changed.objects.mode = ObjectMode::Joint;
    changed.joint.fewLandmarks = 17;
    changed.objects.movingAbove = 44;
    BackendOptions loaded;
    loaded.load(CConfigFileMemory(text(changed)), "test.ini");
    EXPECT_EQ(loaded.keeper.latency_keyframes, 3U);
    EXPECT_NEAR(loaded.backbone.minParallax_rad, 0.5, 1e-5);
    EXPECT_FALSE(loaded.association.vehiclesOnly);
    EXPECT_EQ(loaded.objects.mode, ObjectMode::Joint);
    EXPECT_EQ(text(loaded), text(changed));
    EXPECT_NE(text(loaded), text(BackendOptions()));
}

TEST(BackendOptions, everyKeySaysWhatItIs) {
    std::istringstream lines(text({}));
    unsigned keys = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.find('=') == std::string::npos) continue;
        ++keys;
        EXPECT_NE(line.find("//"), std::string::npos) << line;
    }
    EXPECT_GE(keys, 50U);
}

TEST(BackendOptions, unknownKeysAndBadValuesAreNamed) {
    const auto message = [](const std::string& section, const std::string& key,
                            const std::string& value) {
        const CConfigFileMemory config("[" + section + "]\n" + key + " = " + value + "\n");
        BackendOptions options;
        try {
            options.load(config, "drive.ini");
        } catch (const obs::InputError& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_THAT(message("backbone", "windowsize_", "3"), testing::HasSubstr("windowsize_"));
    EXPECT_THAT(message("backbone", "window_size", "0"), testing::HasSubstr("window_size"));
    EXPECT_THAT(message("objects", "robust_scale", "-1"), testing::HasSubstr("robust_scale"));
    EXPECT_THAT(message("objects", "mode", "sometimes"),
                testing::HasSubstr("'sometimes'; expected off, worker or joint"));
    EXPECT_THAT(message("map_keeper", "latency_keyframes", "0"), testing::HasSubstr("latency"));
    EXPECT_EQ(message("objects", "robust_scale", "5"), "");
}

TEST(BackendOptions, aLatencyOfZeroIsRefused) {
    BackendOptions options;
    options.keeper.latency_keyframes = 0;
    EXPECT_THROW(MapKeeper(options, Mode::Lockstep), obs::InputError);
}

}  // namespace
}  // namespace djpete::backend
