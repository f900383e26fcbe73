#include "djpete/scans/options.h"

#include <gmock/gmock.h>
#include <mrpt/config/CConfigFileMemory.h>

#include "djpete/obs/errors.h"
#include "djpete/obs/options.h"

namespace djpete::scans {
namespace {

ScanOptions loaded(const std::string& text) {
    ScanOptions out;
    obs::loadOptions(out, mrpt::config::CConfigFileMemory("[scans]\n" + text), "scans", "x.ini");
    return out;
}

std::string errorOf(const std::string& text) {
    try {
        loaded(text);
    } catch (const obs::InputError& e) {
        return e.what();
    }
    return "";
}

TEST(ScanOptions, ReadWhatTheyWrite) {
    ScanOptions a;
    a.enabled = false;
    a.spinPeriod_s = 0.1;
    a.floor_rad = 1e-3;
    a.mapKeyframes = 7;
    mrpt::config::CConfigFileMemory file;
    a.saveToConfigFile(file, "scans");
    ScanOptions b;
    obs::loadOptions(b, file, "scans", "x.ini");
    EXPECT_FALSE(b.enabled);
    EXPECT_DOUBLE_EQ(b.spinPeriod_s, 0.1);
    EXPECT_NEAR(b.floor_rad, 1e-3, 1e-7);
    EXPECT_EQ(b.mapKeyframes, 7U);
}

TEST(ScanOptions, WhatIsOutOfRangeIsNamed) {
    EXPECT_THAT(errorOf("plane_size_m = 0"), testing::HasSubstr("plane_size_m"));
    EXPECT_THAT(errorOf("iterations = 0"), testing::HasSubstr("iterations"));
    EXPECT_THAT(errorOf("floor_deg = nan"), testing::HasSubstr("floor_deg"));
    EXPECT_THAT(errorOf("min_range_m = 50\nmax_range_m = 40"), testing::HasSubstr("max_range_m"));
    EXPECT_THAT(errorOf("plane_sise_m = 1"), testing::HasSubstr("unknown key 'plane_sise_m'"));
}

}  // namespace
}  // namespace djpete::scans
