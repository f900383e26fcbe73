#include "djpete/io/scene_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "djpete/io/scene_writer.h"
#include "djpete/obs/errors.h"
#include "small_map.h"

namespace {

using namespace djpete_test;

mrpt::opengl::COpenGLScene::Ptr redCarOnGreen() {
    io::SceneContent content;
    content.map = std::make_shared<map::SlamMap>(smallMap());
    content.models[map::ObjectId{0}] = redModel(0);
    for (int i = 0; i < 2000; ++i) {
        content.background.push_back(
            {static_cast<float>(i % 40), static_cast<float>(i / 40) - 25, -1.5F, {30, 90, 40}});
    }
    return io::makeScene(content, {});
}

io::SceneView fromBehind() {
    io::SceneView view;
    view.eye = {-12, 0, 9};
    view.target = {22, 0, 0};
    view.width_px = 640;
    view.height_px = 360;
    return view;
}

std::size_t greenPixels(const mrpt::img::CImage& image) {
    std::size_t count = 0;
    for (unsigned v = 0; v < image.getHeight(); ++v) {
        for (unsigned u = 0; u < image.getWidth(); ++u) {
            const int b = image.at<uint8_t>(u, v, 0), g = image.at<uint8_t>(u, v, 1),
                      r = image.at<uint8_t>(u, v, 2);
            count += g > 60 && r < 60 && b < 70;
        }
    }
    return count;
}

TEST(SceneView, OneSceneIsDrawnAgainAndAgain) {
    const auto scene = redCarOnGreen();
    const auto first = io::pictureOf(*scene, fromBehind());
    if (!first.image) GTEST_SKIP() << first.whyNot;
    const auto second = io::pictureOf(*scene, fromBehind());
    ASSERT_TRUE(second.image) << second.whyNot;
    EXPECT_GT(greenPixels(*first.image), 1000U);
    EXPECT_EQ(greenPixels(*first.image), greenPixels(*second.image));
}

TEST(SceneView, HiddenLayersAreNotDrawn) {
    const TestFolder folder;
    io::writeScene(*redCarOnGreen(), folder / "scene.3Dscene");
    const auto scene = io::loadScene(folder / "scene.3Dscene");
    io::showLayers(*scene, {"background"});
    EXPECT_TRUE(scene->getByName("background")->isVisible());
    EXPECT_FALSE(scene->getByName("objects")->isVisible());
    const auto with = io::pictureOf(*scene, fromBehind());
    if (!with.image) GTEST_SKIP() << with.whyNot;
    io::showLayers(*scene, {"objects"});
    const auto without = io::pictureOf(*scene, fromBehind());
    ASSERT_TRUE(without.image) << without.whyNot;
    EXPECT_GT(greenPixels(*with.image), 1000U);
    EXPECT_EQ(greenPixels(*without.image), 0U);
}

TEST(SceneView, NamesTheFileThatIsNoScene) {
    const TestFolder folder;
    std::ofstream(folder / "broken.3Dscene") << "no scene";
    for (const auto& file : {folder / "broken.3Dscene", folder / "missing.3Dscene"}) {
        try {
            io::loadScene(file);
            FAIL() << file;
        } catch (const obs::InputError& e) {
            EXPECT_THAT(e.what(), testing::HasSubstr(file));
        }
    }
}

}  // namespace
