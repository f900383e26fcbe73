#include <gmock/gmock.h>
#include <mrpt/config/CConfigFileMemory.h>

#include "djpete/obs/errors.h"
#include "djpete/obs/options.h"
#include "djpete/places/place_database.h"
#include "djpete/places/view_match.h"

namespace djpete::places {
namespace {

using mrpt::config::CConfigFileMemory;

template <class Options>
std::string text(const Options& options) {
    CConfigFileMemory config;
    options.saveToConfigFile(config, "s");
    return config.getContent();
}

template <class Options>
std::string complaint(const std::string& content) {
    Options options;
    try {
        obs::loadOptions(options, CConfigFileMemory("[s]\n" + content + "\n"), "s", "test.ini");
    } catch (const obs::InputError& e) {
        return e.what();
    }
    return "";
}

TEST(PlacesOptions, whatIsSavedIsLoadedAgain) {
    DatabaseOptions database;
    database.tables = 3;
    database.neighbours = 11;
    MatchOptions match;
    match.maxSigma_rad = 0.1;
    match.minInliers = 77;
    DatabaseOptions loadedDatabase;
    MatchOptions loadedMatch;
    obs::loadOptions(loadedDatabase, CConfigFileMemory(text(database)), "s", "test.ini");
    obs::loadOptions(loadedMatch, CConfigFileMemory(text(match)), "s", "test.ini");
    EXPECT_EQ(loadedDatabase.tables, 3U);
    EXPECT_NEAR(loadedMatch.maxSigma_rad, 0.1, 1e-5);
    EXPECT_EQ(text(loadedDatabase), text(database));
    EXPECT_EQ(text(loadedMatch), text(match));
    EXPECT_NE(text(loadedMatch), text(MatchOptions()));
}

TEST(PlacesOptions, everyKeySaysWhatItIs) {
    std::istringstream lines(text(DatabaseOptions()) + text(MatchOptions()));
    int keys = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.find('=') == std::string::npos) continue;
        ++keys;
        EXPECT_NE(line.find("//"), std::string::npos) << line;
    }
    EXPECT_GE(keys, 15);
}

TEST(PlacesOptions, badValuesAndKeysAreNamed) {
    using testing::HasSubstr;
    EXPECT_THAT(complaint<DatabaseOptions>("key_bits = 40"), HasSubstr("key_bits"));
    EXPECT_THAT(complaint<DatabaseOptions>("tables = 0"), HasSubstr("tables"));
    EXPECT_THAT(complaint<DatabaseOptions>("tabels = 2"), HasSubstr("tabels"));
    EXPECT_THAT(complaint<MatchOptions>("max_ratio = 1.5"), HasSubstr("max_ratio"));
    EXPECT_THAT(complaint<MatchOptions>("sigma_px = 0"), HasSubstr("sigma_px"));
    EXPECT_THAT(complaint<MatchOptions>("max_sigma_deg = nan"), HasSubstr("max_sigma_deg"));
    EXPECT_EQ(complaint<MatchOptions>("min_inliers = 30"), "");
}

}  // namespace
}  // namespace djpete::places
