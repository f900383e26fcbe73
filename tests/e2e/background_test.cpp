/// The octree of the background through the whole line, and the figures from its result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <mrpt/opengl/COctoMapVoxels.h>
#include <mrpt/opengl/COpenGLScene.h>

#include <fstream>
#include <sstream>

#include "djpete/obs/errors.h"
#include "djpete_eval_app.h"
#include "djpete_test/shared_data.h"
#include "drive.h"

namespace djpete_test {
namespace {

using testing::HasSubstr;

/// A drive and its result with background = octomap, made once.
struct Run {
    fs::path rawlog, result;
};
const Run& octoRun() {
    static const Run run = [] {
        const auto folder = scratch("e2e_octomap");
        Run out{folder / "drive.rawlog", folder / "result"};
        std::ofstream(folder / "octomap.ini") << "[pipeline]\nbackground = octomap\n";
        const auto made = convert({"--input", smallDrive().string(), "--out", out.rawlog.string()});
        EXPECT_EQ(made.code, 0) << made.sentence;
        djpete::apps::DjpeteSlamApp app;
        const auto ran = slam(app, {out.rawlog.string(), "--out", out.result.string()},
                              (folder / "octomap.ini").string());
        EXPECT_EQ(ran.code, 0) << ran.sentence;
        return out;
    }();
    return run;
}

std::string evaluate(const std::vector<std::string>& words) {
    djpete::apps::DjpeteEvalApp app;
    std::vector<const char*> argv{"djpete-eval"};
    for (const auto& w : words) argv.push_back(w.c_str());
    std::ostringstream out;
    try {
        if (app.initialize(static_cast<int>(argv.size()), argv.data())) app.run(out);
    } catch (const djpete::obs::InputError& e) {
        return std::string("error: ") + e.what();
    }
    return out.str();
}

TEST(Background, OctreeIsWrittenDrawnAndTheSameInLockstep) {
    const auto& run = octoRun();
    for (const char* name : {"background.ot", "background.bt"}) {
        EXPECT_GT(fs::file_size(run.result / name), 10000U) << name;
    }
    mrpt::opengl::COpenGLScene scene;
    ASSERT_TRUE(scene.loadFromFile((run.result / "scene.3Dscene").string()));
    const auto layer =
        std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(scene.getByName("background"));
    ASSERT_TRUE(layer);
    const auto cubes = layer->getByClass<mrpt::opengl::COctoMapVoxels>();
    ASSERT_TRUE(cubes);
    EXPECT_GT(cubes->getVoxelCount(0), 1000U);
    const auto other = run.rawlog.parent_path() / "lockstep";
    djpete::apps::DjpeteSlamApp app;
    const auto ran = slam(app, {run.rawlog.string(), "--mode", "lockstep", "--out", other.string()},
                          (run.rawlog.parent_path() / "octomap.ini").string());
    ASSERT_EQ(ran.code, 0) << ran.sentence;
    EXPECT_EQ(textOf(run.result / "background.ot"), textOf(other / "background.ot"));
}

TEST(Figures, AreDrawnFromAResultAndItsDrive) {
    const auto& run = octoRun();
    const auto folder = scratch("e2e_figures");
    const std::string said = evaluate({"--figures", folder.string(), "--result",
                                       run.result.string(), "--drive", run.rawlog.string()});
    std::size_t textures = 0, objects = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const auto name = entry.path().filename().string();
        EXPECT_THAT(said, HasSubstr(name));
        mrpt::img::CImage image;
        ASSERT_TRUE(image.loadFromFile(entry.path().string())) << name;
        EXPECT_GT(image.getWidth(), 300U) << name;
        textures += name.rfind("figure04_texture_", 0) == 0 ? 1U : 0U;
        objects += name.rfind("figure11_object_", 0) == 0 ? 1U : 0U;
    }
    EXPECT_GE(textures, 2U);
    EXPECT_EQ(objects, textures);
    EXPECT_TRUE(fs::exists(folder / "figure07_perception.png"));
    EXPECT_TRUE(fs::exists(folder / "figure10_trajectory.png"));
    for (const char* name : {"figure06_map.png", "figure08_joint.png"}) {
        if (fs::exists(folder / name)) continue;
        EXPECT_THAT(said, HasSubstr(std::string(name) + " is not drawn: no off-screen OpenGL"));
    }
}

TEST(Figures, SayWhatIsMissing) {
    const auto& run = octoRun();
    const auto folder = scratch("e2e_figures_no_drive");
    const std::string said =
        evaluate({"--figures", folder.string(), "--result", run.result.string()});
    EXPECT_THAT(said, HasSubstr("figure07_perception.png is not drawn: it needs the drive"));
    EXPECT_FALSE(fs::exists(folder / "figure07_perception.png"));
    EXPECT_TRUE(fs::exists(folder / "figure10_trajectory.png"));
    EXPECT_THAT(evaluate({"--figures", folder.string()}), HasSubstr("--result"));
    EXPECT_THAT(evaluate({"--drive", run.rawlog.string()}), HasSubstr("--figures"));
    EXPECT_THAT(evaluate({"--figures", folder.string(), "--result", run.result.string(), "--json"}),
                HasSubstr("--figures goes with"));
    EXPECT_THAT(evaluate({"--figures", folder.string(), "--result", "/nowhere"}),
                HasSubstr("/nowhere"));
    const auto broken = scratch("e2e_figures_broken");
    fs::copy(run.result, broken, fs::copy_options::recursive);
    fs::resize_file(broken / "scene.3Dscene", 500);
    EXPECT_THAT(evaluate({"--figures", folder.string(), "--result", broken.string()}),
                HasSubstr("scene.3Dscene"));
}

}  // namespace
}  // namespace djpete_test
