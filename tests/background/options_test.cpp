#include "djpete/background/options.h"

#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/system/string_utils.h>

#include "djpete/obs/errors.h"
#include "djpete/obs/options.h"

namespace {

using djpete::background::OctoOptions;

TEST(OctoOptions, EveryKeyMakesTheTrip) {
    mrpt::config::CConfigFileMemory file;
    OctoOptions().saveToConfigFile(file, "octomap");
    std::vector<std::string> keys;
    file.getAllKeys("octomap", keys);
    ASSERT_EQ(keys.size(), 21U);
    const std::map<std::string, std::string> other{{"store_free_space", "false"},
                                                   {"when_full", "skip"},
                                                   {"min_distance_m", "3"},
                                                   {"decimation_m", "0.3"},
                                                   {"resolution_m", "0.25"},
                                                   {"hit_probability", "0.75"},
                                                   {"stereo_hit_probability", "0.625"},
                                                   {"miss_probability", "0.375"},
                                                   {"ground_share", "0.25"},
                                                   {"object_margin_m", "0.5"},
                                                   {"ground_clearance_m", "0.5"},
                                                   {"max_nodes", "77777"},
                                                   {"max_stored_points", "7777"}};
    for (const auto& padded : keys) {  // as they are written
        const auto key = mrpt::system::trim(padded);
        const auto it = other.find(key);
        const std::string value = it == other.end() ? "77" : it->second;
        mrpt::config::CConfigFileMemory changed, again;
        changed.setContent("[octomap]\n" + key + " = " + value);
        OctoOptions options;
        djpete::obs::loadOptions(options, changed, "octomap", "test");
        options.saveToConfigFile(again, "octomap");
        EXPECT_EQ(again.read_string("octomap", padded, "").substr(0, value.size()), value) << key;
    }
}

TEST(OctoOptions, NamesTheKeyThatIsOutOfRange) {
    for (const std::string line : {"resolution_m = 0", "when_full = perhaps", "max_nodes = 1",
                                   "queue_keyframes = -1", "resolution_m = 0.05"}) {
        mrpt::config::CConfigFileMemory file("[octomap]\n" + line);
        OctoOptions options;
        try {
            djpete::obs::loadOptions(options, file, "octomap", "test");
            FAIL() << line;
        } catch (const djpete::obs::InputError& e) {
            EXPECT_NE(std::string(e.what()).find(line.substr(0, line.find(' '))), std::string::npos)
                << e.what();
        }
    }
}

}  // namespace
