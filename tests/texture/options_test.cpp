#include "djpete/texture/options.h"

#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/system/string_utils.h>

#include <cmath>

#include "djpete/obs/options.h"
#include "djpete/texture/object_model.h"

namespace {

using djpete::texture::BackgroundCloudOptions;
using djpete::texture::ColourSum;
using djpete::texture::TextureOptions;

template <class Options>
void everyKeyMakesTheTrip() {
    mrpt::config::CConfigFileMemory file, again;
    Options().saveToConfigFile(file, "s");
    std::vector<std::string> keys;
    file.getAllKeys("s", keys);
    ASSERT_FALSE(keys.empty());
    for (const auto& key : keys) {
        // 3 differs from every default and is valid for bool, too.
        mrpt::config::CConfigFileMemory changed;
        const std::string name = mrpt::system::trim(key);
        changed.setContent("[s]\n" + name + " = " +
                           (file.read_string("s", key, "") == "true" ? "false" : "3") + "\n");
        Options options;
        djpete::obs::loadOptions(options, changed, "s", "test");
        options.saveToConfigFile(again, "s");
        EXPECT_NE(again.read_string("s", key, "").substr(0, 4),
                  file.read_string("s", key, "").substr(0, 4))
            << key;
    }
}

TEST(TextureOptions, EveryKeyMakesTheTrip) { everyKeyMakesTheTrip<TextureOptions>(); }
TEST(BackgroundCloudOptions, EveryKeyMakesTheTrip) {
    everyKeyMakesTheTrip<BackgroundCloudOptions>();
}

TEST(ColourSum, MatchesTheTwoPassFormulaAndJoins) {
    const std::array<std::array<float, 3>, 4> samples{
        {{10, 20, 30}, {14, 26, 30}, {8, 22, 31}, {200, 5, 30}}};
    const std::array<float, 4> weights{1, 0.5F, 2, 0.25F};
    ColourSum all, first, second;
    double weight = 0, mean = 0, spread = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        all.add(samples[i], weights[i]);
        (i < 2 ? first : second).add(samples[i], weights[i]);
        weight += static_cast<double>(weights[i]);
        mean += static_cast<double>(weights[i] * samples[i][0]);
    }
    mean /= weight;
    for (std::size_t i = 0; i < 4; ++i) {
        spread += static_cast<double>(weights[i]) *
                  std::pow(static_cast<double>(samples[i][0]) - mean, 2);
    }
    EXPECT_EQ(all.count, 4U);
    EXPECT_NEAR(all.mean[0], mean, 1e-4);
    EXPECT_NEAR(all.variance()[0], spread / weight, 1e-2);
    first.add(second);
    EXPECT_EQ(first.count, 4U);
    for (unsigned c = 0; c < 3; ++c) {
        EXPECT_NEAR(first.mean[c], all.mean[c], 1e-4);
        EXPECT_NEAR(first.variance()[c], all.variance()[c], 1e-2);
    }
}

}  // namespace
