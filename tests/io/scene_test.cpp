#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/COctoMapVoxels.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CText3D.h>
#include <mrpt/system/string_utils.h>

#include "djpete/io/scene_writer.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/options.h"
#include "small_map.h"

namespace {

using namespace djpete_test;

io::SceneContent content() {
    io::SceneContent out;
    out.map = std::make_shared<map::SlamMap>(smallMap());
    out.models[map::ObjectId{0}] = redModel(0);
    for (int i = 0; i < 2000; ++i) {
        out.background.push_back(
            {static_cast<float>(i % 40), static_cast<float>(i / 40) - 25, -1.5F, {30, 90, 40}});
    }
    return out;
}

mrpt::math::TPoint3Df voxelAt(const io::SceneContent& c, std::size_t i) {
    return {c.background[i].x, c.background[i].y, c.background[i].z};
}

TEST(Scene, HasItsLayersAndLoadsBack) {
    const TestFolder folder;
    io::writeScene(*io::makeScene(content(), {}), folder / "scene.3Dscene");
    mrpt::opengl::COpenGLScene scene;
    ASSERT_TRUE(scene.loadFromFile(folder / "scene.3Dscene"));
    for (const auto* name : {"trajectory", "sparse_map", "background", "objects", "boxes", "ids"}) {
        const auto found = scene.getByName(name);
        ASSERT_TRUE(found) << name;
        EXPECT_TRUE(std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(found)) << name;
    }
    const auto cloud =
        std::dynamic_pointer_cast<mrpt::opengl::CPointCloudColoured>(scene.getByName("object 0"));
    ASSERT_TRUE(cloud);
    ASSERT_EQ(cloud->size(), 399U);  // without the point that nobody saw
    EXPECT_EQ(cloud->getPoint3Df(398).x, redModel(0).cloud->getPointsBufferRef_x()[399]);
    EXPECT_EQ(cloud->getPointColor(398).R, 255);
    EXPECT_EQ(cloud->getPointColor(398).B, 0);
    EXPECT_NEAR(cloud->getPoseX(), 12.123456789012, 1e-6);
    EXPECT_TRUE(std::dynamic_pointer_cast<mrpt::opengl::CBox>(scene.getByName("box 1")));
    EXPECT_TRUE(std::dynamic_pointer_cast<mrpt::opengl::CText3D>(scene.getByName("id 1")));
    EXPECT_FALSE(scene.getByName("object 1"));  // no texture, only a box
}

TEST(Scene, VoxelsAreCubesUpToALimitAndPointsBeyond) {
    const TestFolder folder;
    auto voxels = content();
    voxels.backgroundVoxel_m = 0.2;
    for (const bool few : {true, false}) {
        io::SceneOptions options;
        options.max_background_cubes = few ? 2000 : 1999;
        io::writeScene(*io::makeScene(voxels, options), folder / "scene.3Dscene");
        mrpt::opengl::COpenGLScene scene;
        ASSERT_TRUE(scene.loadFromFile(folder / "scene.3Dscene"));
        const auto layer =
            std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(scene.getByName("background"));
        ASSERT_TRUE(layer);
        const auto cubes = layer->getByClass<mrpt::opengl::COctoMapVoxels>();
        const auto points = layer->getByClass<mrpt::opengl::CPointCloudColoured>();
        ASSERT_EQ(static_cast<bool>(cubes), few);
        ASSERT_EQ(static_cast<bool>(points), !few);
        if (!few) {
            EXPECT_EQ(points->size(), 2000U);
            continue;
        }
        ASSERT_EQ(cubes->getVoxelCount(0), 2000U);
        EXPECT_EQ(cubes->getVoxel(0, 5).color, mrpt::img::TColor(30, 90, 40));
        EXPECT_EQ(cubes->getVoxel(0, 5).coords, voxelAt(voxels, 5));
    }
}

TEST(Scene, IsDrawnWithoutADisplay) {
    const TestFolder folder;
    io::SceneOptions options;
    options.image_width_px = 642;  // not a multiple of 4: rounded down
    options.image_height_px = 360;
    const auto report =
        io::renderScene(*io::makeScene(content(), options), folder / "scene.png", options);
    if (!report.written) {
        EXPECT_FALSE(std::filesystem::exists(folder / "scene.png"));
        EXPECT_EQ(report.whyNot.find('\n'), std::string::npos);
        GTEST_SKIP() << report.whyNot;
    }
    mrpt::img::CImage image;
    ASSERT_TRUE(image.loadFromFile(folder / "scene.png"));
    ASSERT_EQ(image.getWidth(), 640U);
    ASSERT_EQ(image.getHeight(), 360U);
    std::size_t red = 0, green = 0, light = 0;
    for (unsigned v = 0; v < 360; ++v) {
        for (unsigned u = 0; u < 640; ++u) {
            const int b = image.at<uint8_t>(u, v, 0), g = image.at<uint8_t>(u, v, 1),
                      r = image.at<uint8_t>(u, v, 2);
            red += r > 230 && g < 80 && b < 40;
            green += g > 60 && r < 60 && b < 70;
            light += r > 220 && g > 220 && b > 220;
        }
    }
    EXPECT_GT(red, 30U);      // the car
    EXPECT_GT(green, 1000U);  // the meadow
    EXPECT_GT(light, 1000U);  // the sky
}

TEST(Scene, AnEmptyMapIsASceneToo) {
    const TestFolder folder;
    io::SceneContent empty;
    empty.map = std::make_shared<map::SlamMap>();
    io::SceneOptions options;
    options.bird_view = true;
    const auto scene = io::makeScene(empty, options);
    EXPECT_TRUE(scene->getByName("objects"));
    io::writeScene(*scene, folder / "scene.3Dscene");
    EXPECT_TRUE(std::filesystem::exists(folder / "scene.3Dscene"));
}

TEST(Scene, NamesTheFileThatCannotBeWritten) {
    const auto scene = io::makeScene(content(), {});
    EXPECT_THROW(io::writeScene(*scene, "/nowhere/scene.3Dscene"), obs::InputError);
    EXPECT_THROW(io::renderScene(*scene, "/nowhere/scene.png", {}), obs::InputError);
}

TEST(SceneOptions, EveryKeyMakesTheTrip) {
    mrpt::config::CConfigFileMemory file;
    io::SceneOptions().saveToConfigFile(file, "s");
    std::vector<std::string> keys;
    file.getAllKeys("s", keys);
    ASSERT_EQ(keys.size(), 11U);
    for (const auto& key : keys) {
        mrpt::config::CConfigFileMemory changed, again;
        const bool isBool = file.read_string("s", key, "").substr(0, 5) == "false";
        changed.setContent("[s]\n" + mrpt::system::trim(key) + " = " + (isBool ? "true" : "777"));
        io::SceneOptions options;
        obs::loadOptions(options, changed, "s", "test");
        options.saveToConfigFile(again, "s");
        EXPECT_EQ(again.read_string("s", key, "").substr(0, 3), isBool ? "tru" : "777") << key;
    }
}

}  // namespace
