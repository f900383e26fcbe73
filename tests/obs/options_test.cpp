#include "djpete/obs/options.h"

#include <mrpt/config/CConfigFileMemory.h>

#include "obs_samples.h"

namespace {

struct SampleOptions : mrpt::config::CLoadableOptions {
    double speed = 2.5;
    int count = 3;
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& c, const std::string& s) override {
        speed = c.read_double(s, "speed", speed);
        count = c.read_int(s, "count", count);
        if (count < 0) throw std::runtime_error("count is negative\nwith a second line");
    }
    void saveToConfigFile(mrpt::config::CConfigFileBase& c, const std::string& s) const override {
        c.write(s, "speed", speed);
        c.write(s, "count", count);
    }
};

std::string loadError(const std::string& ini) {
    const mrpt::config::CConfigFileMemory config(ini);
    SampleOptions o;
    return obs_samples::inputError([&] { djpete::obs::loadOptions(o, config, "A", "tuning.ini"); });
}

}  // namespace

TEST(Options, KnownKeysAreLoadedAndTheRestKeepsItsDefault) {
    const mrpt::config::CConfigFileMemory config(std::string("[A]\ncount = 8\n"));
    SampleOptions o;
    djpete::obs::loadOptions(o, config, "A", "tuning.ini");
    EXPECT_EQ(o.count, 8);
    EXPECT_EQ(o.speed, 2.5);
    djpete::obs::loadOptions(o, config, "ABSENT", "tuning.ini");
    EXPECT_EQ(o.count, 8);
}

TEST(Options, AnUnknownKeyIsNamedWithItsFileAndTheKnownOnes) {
    const std::string what = loadError("[A]\ncount = 1\nsped = 4\n");
    EXPECT_NE(what.find("tuning.ini"), std::string::npos) << what;
    EXPECT_NE(what.find("'sped'"), std::string::npos) << what;
    EXPECT_NE(what.find("count, speed"), std::string::npos) << what;
}

TEST(Options, ARefusedValueIsOneSentence) {
    const std::string what = loadError("[A]\ncount = -1\n");
    EXPECT_NE(what.find("count is negative"), std::string::npos) << what;
}

TEST(Options, AnUnknownSectionIsRefused) {
    const mrpt::config::CConfigFileMemory config(std::string("[A]\ncount = 8\n[B]\nx = 1\n"));
    EXPECT_NO_THROW(djpete::obs::requireKnownSections(config, {"A", "B"}, "tuning.ini"));
    const std::string what = obs_samples::inputError(
        [&] { djpete::obs::requireKnownSections(config, {"A"}, "tuning.ini"); });
    EXPECT_NE(what.find("[B]"), std::string::npos) << what;
}
