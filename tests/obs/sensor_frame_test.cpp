#include "djpete/obs/sensor_frame.h"

#include <gmock/gmock.h>
#include <mrpt/maps/CPointsMapXYZI.h>

#include <limits>

#include "obs_samples.h"

using djpete::obs::RawlogSource;
using djpete::obs::SensorFrame;
using obs_samples::fs::path;
using testing::HasSubstr;

namespace {

mrpt::img::TCamera camera(unsigned width, unsigned height) {
    mrpt::img::TCamera c;
    c.ncols = width;
    c.nrows = height;
    c.setIntrinsicParamsFromValues(70, 71, 32, 24);
    return c;
}

mrpt::obs::CObservationStereoImages::Ptr stereo(const path& left, const path& right) {
    auto o = mrpt::obs::CObservationStereoImages::Create();
    o->sensorLabel = djpete::obs::label::kStereoGray;
    o->timestamp = obs_samples::stampOf(0);
    mrpt::img::TStereoCamera params;
    params.leftCamera = params.rightCamera = camera(64, 48);
    params.rightCameraPose.x = 0.5;
    o->setStereoCameraParams(params);
    o->hasImageRight = true;
    o->imageLeft.setExternalStorage(left.string());
    o->imageRight.setExternalStorage(right.string());
    return o;
}

mrpt::obs::CObservationPointCloud::Ptr scan(const path& file) {
    auto o = mrpt::obs::CObservationPointCloud::Create();
    o->sensorLabel = djpete::obs::label::kVelodyne;
    o->timestamp = obs_samples::stampOf(0);
    o->setAsExternalStorage(file.string(),
                            mrpt::obs::CObservationPointCloud::ExternalStorageFormat::KittiBinFile);
    return o;
}

/// Through a rawlog and back, as programs get their frames.
SensorFrame stored(const path& dir, const std::vector<mrpt::serialization::CSerializable::Ptr>& o) {
    obs_samples::writeRawlog(dir / "d.rawlog", o);
    auto frame = RawlogSource(dir / "d.rawlog").next();
    EXPECT_TRUE(frame);
    return *frame;
}

std::string stereoError(const path& dir, const path& left, const path& right) {
    const auto f = stored(dir, {stereo(left, right)});
    return obs_samples::inputError([&] { f.loadMainImages(); });
}

}  // namespace

TEST(SensorFrame, LoadsImagesOnDemandAndLetsThemGo) {
    const auto dir = djpete_test::scratch("obs_lazy");
    obs_samples::writeImage(dir / "l.png");
    obs_samples::writeImage(dir / "r.png");
    const auto f = stored(dir, {stereo(dir / "l.png", dir / "r.png")});
    // As long as nothing was loaded the files may come and go.
    std::filesystem::rename(dir / "l.png", dir / "l2.png");
    EXPECT_ANY_THROW(f.loadMainImages());
    std::filesystem::rename(dir / "l2.png", dir / "l.png");
    const auto images = f.loadMainImages();
    ASSERT_TRUE(images && images->right);
    EXPECT_EQ(images->camera.model.baseline_m, 0.5);
    EXPECT_EQ(images->camera.model.fx, 70);
    EXPECT_FALSE(images->isColor());
    f.unload();
    // The observation forgot its pixels: without the file it cannot have them again ...
    std::filesystem::remove(dir / "l.png");
    EXPECT_THAT(obs_samples::inputError([&] { f.loadMainImages(); }), HasSubstr("does not exist"));
    // ... but what was handed out stays.
    EXPECT_EQ(*images->left.ptr<uint8_t>(3, 2), 7 * 3 + 13 * 2);
    EXPECT_EQ(*images->right->ptr<uint8_t>(60, 40), (7 * 60 + 13 * 40) % 251);
}

TEST(SensorFrame, RelativeNamesAreFoundBesideTheRawlog) {
    for (const std::string folder : {"", "d_Images/"}) {
        const auto dir = djpete_test::scratch("obs_relative");
        std::filesystem::create_directories(dir / folder / "sub");
        obs_samples::writeImage(dir / folder / "sub/l.png");
        obs_samples::writeImage(dir / folder / "sub/r.png");
        const auto f = stored(dir, {stereo("sub/l.png", "sub/r.png")});
        EXPECT_TRUE(f.loadMainImages()) << folder;
    }
}

TEST(SensorFrame, ASingleColourImageIsMainWhenThereIsNoGrey) {
    const auto dir = djpete_test::scratch("obs_mono");
    auto o = mrpt::obs::CObservationImage::Create();
    o->sensorLabel = djpete::obs::label::kImageColor;
    o->timestamp = obs_samples::stampOf(0);
    o->cameraParams = camera(64, 48);
    o->image.setExternalStorage(obs_samples::writeImage(dir / "c.png", 64, 48, true).string());
    const auto f = stored(dir, {o});
    EXPECT_TRUE(f.imageColor);
    const auto images = f.loadMainImages();
    ASSERT_TRUE(images);
    EXPECT_TRUE(images->isColor());
    EXPECT_FALSE(images->right);
    EXPECT_EQ(images->camera.model.baseline_m, 0);
}

TEST(SensorFrame, BadImagesAreNamed) {
    const auto dir = djpete_test::scratch("obs_bad_images");
    const auto good = obs_samples::writeImage(dir / "good.png");
    const auto small = obs_samples::writeImage(dir / "small.png", 32, 48);
    const auto torn = obs_samples::cut(good, std::filesystem::file_size(good) / 2);
    const auto head = dir / "head.png";
    std::filesystem::copy_file(obs_samples::cut(small, 20), head);
    EXPECT_THAT(stereoError(dir, dir / "none.png", good), HasSubstr("none.png: image of frame 0"));
    EXPECT_THAT(stereoError(dir, torn, good), HasSubstr("cut_good.png"));
    EXPECT_THAT(stereoError(dir, good, head), HasSubstr("head.png"));
    EXPECT_THAT(stereoError(dir, good, small), HasSubstr("32x48 but 64x48 was expected"));
}

TEST(SensorFrame, UncalibratedOrDistortedImagesAreRefused) {
    const auto dir = djpete_test::scratch("obs_uncalibrated");
    const auto good = obs_samples::writeImage(dir / "good.png");
    const auto error = [&](const auto& change) {
        auto o = stereo(good, good);
        change(*o);
        const auto f = stored(dir, {o});
        return obs_samples::inputError([&] { f.loadMainImages(); });
    };
    EXPECT_THAT(error([](auto& o) { o.leftCamera.setIntrinsicParamsFromValues(0, 0, 0, 0); }),
                HasSubstr("no calibration"));
    EXPECT_THAT(error([](auto& o) { o.leftCamera.dist[0] = 0.1; }), HasSubstr("rectified"));
    EXPECT_THAT(error([](auto& o) { o.rightCameraPose.x(0); }), HasSubstr("baseline"));
}

TEST(SensorFrame, ScansKeepIntensityAndLoseNoReturnPoints) {
    const auto dir = djpete_test::scratch("obs_scan");
    const auto file =
        obs_samples::writeScan(dir / "s.bin", {1, 2, 3, 0.5F, 0, 0, 0, 0, 4, 5, 6, 0.25F});
    const auto f = stored(dir, {scan(file)});
    for (int i = 0; i < 2; ++i) {
        const auto s = f.loadScan();
        ASSERT_TRUE(s);
        ASSERT_EQ(s->points.size(), 2U);
        EXPECT_EQ(s->points[0].z, 3);
        EXPECT_EQ(s->points[0].intensity, 0.5F);
        EXPECT_EQ(s->points[1].x, 4);
        f.unload();
    }
}

TEST(SensorFrame, BadScansAreNamed) {
    const auto dir = djpete_test::scratch("obs_bad_scans");
    const auto error = [&](const path& file) {
        const auto f = stored(dir, {scan(file)});
        return obs_samples::inputError([&] { f.loadScan(); });
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    EXPECT_THAT(error(obs_samples::writeScan(dir / "nan.bin", {1, 2, 3, 0, 1, nan, 3, 0})),
                AllOf(HasSubstr("nan.bin"), HasSubstr("point 1"), HasSubstr("not finite")));
    EXPECT_THAT(error(obs_samples::writeScan(dir / "inf.bin", {inf, 2, 3, 0})),
                HasSubstr("point 0"));
    EXPECT_THAT(error(obs_samples::writeScan(dir / "torn.bin", {1, 2, 3, 0, 5})),
                HasSubstr("20 bytes"));
    EXPECT_THAT(error(obs_samples::writeScan(dir / "empty.bin", {})), HasSubstr("0 bytes"));
    EXPECT_THAT(error(dir / "none.bin"), HasSubstr("none.bin: scan of frame 0 does not exist"));
}
