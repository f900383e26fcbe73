#include "djpete/obs/rawlog_source.h"

#include <gmock/gmock.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "obs_samples.h"

using djpete::obs::DriveInfo;
using djpete::obs::RawlogSource;
using obs_samples::fs::path;
using testing::HasSubstr;

namespace {

DriveInfo frames(uint64_t first, uint64_t count, std::vector<uint64_t> missing = {}) {
    DriveInfo info;
    info.firstFrame = first;
    info.frameCount = count;
    info.missing = std::move(missing);
    return info;
}

/// A drive of `n` frames, each with a true pose and two detections.
path sampleDrive(const path& file, int n, uint64_t promised) {
    std::vector<mrpt::serialization::CSerializable::Ptr> entries{
        obs_samples::head(frames(0, promised))};
    for (int i = 0; i < n; ++i) {
        entries.push_back(obs_samples::truth(i));
        entries.push_back(obs_samples::detectedObjects(i));
    }
    obs_samples::writeRawlog(file, entries);
    return file;
}

std::vector<uint64_t> idsOf(RawlogSource& source) {
    std::vector<uint64_t> out;
    while (const auto f = source.next()) out.push_back(f->id.value);
    return out;
}

}  // namespace

TEST(RawlogSource, ObservationsOfOneStampAreOneFrame) {
    const auto file = sampleDrive(djpete_test::scratch("obs_group") / "d.rawlog", 3, 3);
    RawlogSource source(file);
    EXPECT_EQ(source.info().frameCount, 3U);
    for (uint64_t i = 0; i < 3; ++i) {
        const auto f = source.next();
        ASSERT_TRUE(f);
        EXPECT_EQ(f->id.value, i);
        EXPECT_EQ(f->stamp, obs_samples::stampOf(static_cast<int>(i)));
        ASSERT_TRUE(f->T_world_vehicle_truth);
        EXPECT_EQ(f->T_world_vehicle_truth->translation().x(), 0.5 * static_cast<double>(i));
        ASSERT_EQ(f->detections.size(), 1U);
        EXPECT_EQ(f->detections[0]->detections.size(), 2U);
        EXPECT_FALSE(f->hasImages() || f->hasScan());
        EXPECT_FALSE(f->loadMainImages() || f->loadScan());
    }
    EXPECT_FALSE(source.next());
}

TEST(RawlogSource, FrameNumbersAreTheDrivesOwnAndSkipMissingOnes) {
    const auto file = djpete_test::scratch("obs_ids") / "d.rawlog";
    obs_samples::writeRawlog(file,
                             {obs_samples::head(frames(10, 5, {11, 12})), obs_samples::truth(0),
                              obs_samples::truth(1), obs_samples::truth(2)});
    RawlogSource source(file);
    EXPECT_EQ(idsOf(source), (std::vector<uint64_t>{10, 13, 14}));
}

TEST(RawlogSource, StampsMaySpread) {
    const auto file = djpete_test::scratch("obs_spread") / "d.rawlog";
    auto late = obs_samples::truth(0);
    late->timestamp = mrpt::Clock::fromDouble(1.3e9 + 0.02);
    obs_samples::writeRawlog(file, {obs_samples::detectedObjects(0), late, obs_samples::truth(1)});
    RawlogSource exact(file);
    EXPECT_EQ(idsOf(exact).size(), 3U);
    RawlogSource loose(file, {0.03});
    EXPECT_EQ(idsOf(loose).size(), 2U);
}

TEST(RawlogSource, SensoryFramesAreReadToo) {
    const auto file = djpete_test::scratch("obs_sf") / "d.rawlog";
    std::vector<mrpt::serialization::CSerializable::Ptr> entries;
    for (int i = 0; i < 2; ++i) {
        auto sf = mrpt::obs::CSensoryFrame::Create();
        sf->insert(obs_samples::truth(i));
        sf->insert(obs_samples::detectedObjects(i));
        entries.push_back(sf);
    }
    obs_samples::writeRawlog(file, entries);
    RawlogSource source(file);
    EXPECT_FALSE(source.info().gray);
    const auto f = source.next();
    ASSERT_TRUE(f);
    EXPECT_TRUE(f->T_world_vehicle_truth);
    EXPECT_EQ(f->detections.size(), 1U);
    EXPECT_TRUE(source.next());
    EXPECT_FALSE(source.next());
}

TEST(RawlogSource, ACutRawlogGivesItsFramesThenOneSentence) {
    const auto file = sampleDrive(djpete_test::scratch("obs_cut") / "d.rawlog", 40, 40);
    const auto size = std::filesystem::file_size(file);
    std::size_t most = 0;
    for (std::size_t bytes = 1; bytes < size; bytes += 1 + size / 97) {
        const auto torn = obs_samples::cut(file, bytes);
        std::size_t n = 0;
        std::string what;
        try {
            RawlogSource source(torn);
            while (source.next()) ++n;
        } catch (const djpete::obs::InputError& e) {
            what = e.what();
        }
        // Only where nothing but gzip's closing checksum is gone, all frames are still there.
        if (n < 40) {
            EXPECT_THAT(what, HasSubstr(torn.string())) << bytes << " of " << size;
        }
        EXPECT_LE(n, 40U);
        most = std::max(most, n);
    }
    EXPECT_GT(most, 20U) << "frames before the cut are handed out";
}

TEST(RawlogSource, FewerFramesThanPromisedIsAnError) {
    const auto file = sampleDrive(djpete_test::scratch("obs_few") / "d.rawlog", 3, 5);
    RawlogSource source(file);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(source.next());
    EXPECT_THAT(obs_samples::inputError([&] { source.next(); }), HasSubstr("3 of 5 frames"));
    EXPECT_THAT(obs_samples::inputError([&] { djpete::obs::readDetections(file); }),
                HasSubstr("3 of 5 frames"));
}

TEST(RawlogSource, DamagedBytesNeverCrash) {
    const auto dir = djpete_test::scratch("obs_damage");
    const auto file = sampleDrive(dir / "d.rawlog", 10, 10);
    std::ifstream in(file, std::ios::binary);
    const std::string good((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    int refused = 0;
    for (std::size_t at = 0; at < good.size(); at += 1 + good.size() / 150) {
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ 0x55);
        std::ofstream(dir / "bad.rawlog", std::ios::binary) << bad;
        try {
            RawlogSource source(dir / "bad.rawlog");
            while (source.next()) {
            }
        } catch (const djpete::obs::InputError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 100);
}

TEST(RawlogSource, WhatIsNoRawlogIsNamed) {
    const auto dir = djpete_test::scratch("obs_none");
    EXPECT_THAT(obs_samples::inputError([&] { RawlogSource(dir / "absent.rawlog"); }),
                HasSubstr("absent.rawlog: no such rawlog"));
    EXPECT_THAT(obs_samples::inputError([&] { RawlogSource{dir}; }), HasSubstr("no such rawlog"));
    std::ofstream(dir / "text.rawlog") << "this is a shopping list, not a rawlog\n";
    EXPECT_THAT(obs_samples::inputError([&] { RawlogSource(dir / "text.rawlog"); }),
                HasSubstr("text.rawlog"));
    std::ofstream(dir / "empty.rawlog").flush();
    EXPECT_THAT(obs_samples::inputError([&] { RawlogSource(dir / "empty.rawlog"); }),
                HasSubstr("empty"));
}

TEST(ReadDetections, ReturnsOneEntryPerStamp) {
    const auto file = sampleDrive(djpete_test::scratch("obs_companion") / "d.rawlog", 4, 4);
    const auto all = djpete::obs::readDetections(file);
    ASSERT_EQ(all.size(), 4U);
    EXPECT_EQ(all[3]->timestamp, obs_samples::stampOf(3));
}
