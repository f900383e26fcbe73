/// Bad input, options, and same bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <functional>
#include <map>
#include <opencv2/core.hpp>
#include <set>
#include <sstream>

#include "djpete/obs/errors.h"
#include "djpete/obs/options.h"
#include "synthetic_street.h"

using namespace djpete;
using namespace djpete_test;
using frontend::FrontendOptions;
using frontend::VisualOdometry;
using testing::HasSubstr;

namespace {

std::string errorOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const obs::InputError& e) {
        return e.what();
    }
    return "no InputError";
}

/// Everything that odometry says of a short drive, as bytes.
std::string bytesOfDrive(int threads) {
    cv::setNumThreads(threads);
    const SyntheticStreet street;
    VisualOdometry odometry;
    mrpt::io::CMemoryStream stream;
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (std::size_t i = 0; i < 6; ++i) {
        const SE3 T_world_cam = SE3::fromYaw(0, Vec3(0, 0, 0.7 * static_cast<double>(i)));
        archive << *odometry.process(street.frame(i, T_world_cam));
    }
    return {static_cast<const char*>(stream.getRawBufferData()),
            static_cast<std::size_t>(stream.getTotalBytesCount())};
}

}  // namespace

TEST(Input, OneCameraWithoutScanIsToldAtTheFirstFrame) {
    const SyntheticStreet street;
    VisualOdometry odometry;
    const auto text = errorOf([&] { odometry.process(street.frame(3, SE3(), false)); });
    EXPECT_THAT(text, HasSubstr("frame 3"));
    EXPECT_THAT(text, HasSubstr("needs a right image or a scan"));
}

TEST(Input, SizesAreChecked) {
    const SyntheticStreet street;
    VisualOdometry odometry;
    const mrpt::img::CImage small(320, 120, mrpt::img::CH_GRAY);
    auto in = street.frame(0, SE3());
    in.images.right = small;
    EXPECT_THAT(errorOf([&] { odometry.process(in); }),
                HasSubstr("frame 0: right image is 320x120 but 640x240 was expected"));
    in = street.frame(0, SE3());
    in.exclusion.emplace(100, 50, mrpt::img::CH_GRAY);
    EXPECT_THAT(errorOf([&] { odometry.process(in); }),
                HasSubstr("exclusion mask is 100x50 but 640x240"));
    odometry.process(street.frame(0, SE3()));
    in = street.frame(1, SE3());
    in.images.left = small;
    in.images.right = small;
    in.images.camera.model.width_px = in.images.camera.model.height_px = 0;
    EXPECT_THAT(errorOf([&] { odometry.process(in); }), HasSubstr("as in the first frame"));
    // After an error odometry is where it was.
    EXPECT_TRUE(odometry.process(street.frame(1, SE3()))->tracked);
}

TEST(Input, EmptyImagesAndMissingCalibrationAreTold) {
    const SyntheticStreet street;
    VisualOdometry odometry;
    auto in = street.frame(0, SE3());
    in.images.left = mrpt::img::CImage();
    EXPECT_THAT(errorOf([&] { odometry.process(in); }), HasSubstr("left image is empty"));
    in = street.frame(0, SE3());
    in.images.camera.model.fx = 0;
    EXPECT_THAT(errorOf([&] { odometry.process(in); }), HasSubstr("calibration"));
    in = street.frame(0, SE3());
    in.images.camera.model.baseline_m = 0;
    EXPECT_THAT(errorOf([&] { odometry.process(in); }), HasSubstr("baseline"));
}

TEST(Input, StampsMustGrow) {
    const SyntheticStreet street;
    VisualOdometry odometry;
    odometry.process(street.frame(5, SE3()));
    EXPECT_THAT(errorOf([&] { odometry.process(street.frame(5, SE3())); }),
                HasSubstr("frame 5: time stamp is not later"));
}

TEST(Input, ColourImagesAreTakenAndLendTheirColour) {
    const SyntheticStreet street;
    auto in = street.frame(0, SE3());
    const mrpt::img::CImage grey = in.images.left;
    in.images.left = mrpt::img::CImage(640, 240, mrpt::img::CH_RGB);
    for (unsigned v = 0; v < 240; ++v) {
        for (unsigned u = 0; u < 640; ++u) {
            const uint8_t g = *grey(u, v);
            *in.images.left(u, v, 0) = 20;  // blue
            *in.images.left(u, v, 1) = g;
            *in.images.left(u, v, 2) = 240;  // red
        }
    }
    VisualOdometry odometry;
    const auto keyframe = odometry.process(in);
    ASSERT_GT(keyframe->features.size(), 50U);
    for (const auto& f : keyframe->features) {
        EXPECT_EQ(f.rgb[0], 240);
        EXPECT_EQ(f.rgb[2], 20);
    }
}

TEST(Options, EveryKeySurvivesAFileAndAnUnknownOneIsTold) {
    FrontendOptions options;
    options.featuresWanted = 444;
    options.sigmaTrack_px = 0.123456789;
    options.seed = 99;
    mrpt::config::CConfigFileMemory file;
    options.saveToConfigFile(file, "frontend");
    FrontendOptions read;
    obs::loadOptions(read, file, "frontend", "test.ini");
    EXPECT_EQ(read.featuresWanted, 444);
    EXPECT_NEAR(read.sigmaTrack_px, 0.123456789, 1e-9);
    EXPECT_EQ(read.seed, 99U);
    std::ostringstream a, b;
    options.dumpToTextStream(a);
    read.dumpToTextStream(b);
    EXPECT_EQ(a.str(), b.str());
    EXPECT_THAT(a.str(), HasSubstr("keyframe_translation_m"));
    file.write("frontend", "colour_of_the_car", 1);
    EXPECT_THAT(errorOf([&] { obs::loadOptions(read, file, "frontend", "test.ini"); }),
                HasSubstr("colour_of_the_car"));
}

TEST(Options, ValuesOutOfRangeAreTold) {
    FrontendOptions options;
    options.kltLevels = 9;
    EXPECT_THAT(errorOf([&] { VisualOdometry odometry(options); }), HasSubstr("klt_levels"));
}

TEST(Determinism, TwoRunsAndAnyNumberOfThreadsGiveTheSameBytes) {
    const int threads = cv::getNumThreads();
    const auto once = bytesOfDrive(1);
    EXPECT_EQ(once, bytesOfDrive(1));
    EXPECT_EQ(once, bytesOfDrive(2));
    EXPECT_EQ(once, bytesOfDrive(4));
    cv::setNumThreads(threads);
}

TEST(Tracks, IdsAreUniqueInAKeyframeAndFollowOnePoint) {
    const SyntheticStreet street;
    FrontendOptions options;
    options.keyframeTranslation_m = 0.5;  // every frame a keyframe
    VisualOdometry odometry(options);
    std::map<uint64_t, Vec3> p_world;  // true surface point of each track's first sight
    int seenAgain = 0, moved = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        const SE3 T_world_cam(Eigen::Matrix3d::Identity(),
                              Vec3(0, 0, 0.6 * static_cast<double>(i)));
        const auto keyframe = odometry.process(street.frame(i, T_world_cam));
        std::set<uint64_t> ids;
        for (const auto& f : keyframe->features) {
            EXPECT_TRUE(ids.insert(f.track.value).second);
            const double depth = street.depthAt(T_world_cam, f.u_px, f.v_px);
            const Vec3 p = T_world_cam * street.camera.model.backProject({f.u_px, f.v_px}, depth);
            const auto [first, isNew] = p_world.emplace(f.track.value, p);
            if (isNew) continue;
            ++seenAgain;
            // one pixel at that depth, twice that on slopes
            moved += (first->second - p).norm() > 4 * depth / street.camera.model.fx ? 1 : 0;
        }
    }
    EXPECT_GT(seenAgain, 200);
    EXPECT_LT(moved, seenAgain / 20);
}
