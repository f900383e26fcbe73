/// The program djpete-texture, in-process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "djpete/obs/errors.h"
#include "djpete_texture_app.h"
#include "made_car.h"

namespace {

using namespace djpete::texture;
using djpete::apps::DjpeteTextureApp;
using djpete_test::MadeCar;
using djpete_test::Vec3;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

struct Outcome {
    std::string text;      ///< what it printed
    std::string sentence;  ///< of the error, if any
};

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

class TextureApp : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) /
                  (std::string("djpete_app_") +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        MadeCar car;
        car.step_m = 0.08;
        car.seen = [](const Vec3&, const Vec3& n) { return n.y() > -0.5; };
        saveObject({car.model(), {}}, path("a.object"));
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    /// A result folder with two objects.
    void makeResult() {
        fs::create_directories(folder_ / "result" / "objects");
        for (const char* name : {"0003.object", "0012.object"}) {
            fs::copy_file(path("a.object"), folder_ / "result" / "objects" / name);
        }
    }

    Outcome run(const std::vector<std::string>& words) {
        std::vector<const char*> argv{"djpete-texture"};
        for (const auto& word : words) argv.push_back(word.c_str());
        std::ostringstream out;
        try {
            DjpeteTextureApp app;
            if (app.initialize(static_cast<int>(argv.size()), argv.data())) app.run(out);
        } catch (const djpete::obs::InputError& e) {
            EXPECT_THAT(e.what(), Not(HasSubstr("\n")));
            return {out.str(), e.what()};
        }
        return {out.str(), ""};
    }

    fs::path folder_;
};

TEST_F(TextureApp, EditsGoIntoTheFileInTheirOrder) {
    const auto before = loadObject(path("a.object"));
    const Outcome done = run({path("a.object"), "--brush", "250,250,250", "--region",
                              "normal 0,0,1,20", "--region", "box :,:,0.5:", "--symmetrise",
                              "--brush", "0,0,250", "--region", "sphere 2,0,-0.5,0.4", "--fill"});
    EXPECT_EQ(done.sentence, "");
    EXPECT_THAT(done.text, HasSubstr("4 edits"));
    EXPECT_THAT(done.text, HasSubstr("symmetrise: "));
    const auto after = loadObject(path("a.object"));
    EXPECT_TRUE(packObject(after.original) == packObject(before.original));
    ASSERT_EQ(after.edits.size(), 4U);
    EXPECT_EQ(after.edits[0].name, "brush");
    EXPECT_EQ(after.edits[0].region, "normal 0,0,1,20 & box :,:,0.5:");
    EXPECT_EQ(after.edits[1].name, "symmetrise");
    EXPECT_EQ(after.edits[2].parameters, "0,0,250");
    EXPECT_EQ(after.edits[2].region, "sphere 2,0,-0.5,0.4");
    EXPECT_EQ(after.edits[3].name, "fill");
    EXPECT_GT(replay(after).size(), before.original.size());
}

TEST_F(TextureApp, UndoTakesBackTheLast) {
    const std::string original = bytesOf(path("a.object"));
    run({path("a.object"), "--brush", "1,2,3", "--smooth", "--denoise"});
    EXPECT_EQ(loadObject(path("a.object")).edits.size(), 3U);
    run({path("a.object"), "--undo", "--undo", "--recolour", "0,200,0"});
    const auto edits = loadObject(path("a.object")).edits;
    ASSERT_EQ(edits.size(), 2U);
    EXPECT_EQ(edits[0].name, "brush");
    EXPECT_EQ(edits[1].name, "recolour");
    run({path("a.object"), "--undo", "--undo"});
    EXPECT_TRUE(bytesOf(path("a.object")) == original);
    EXPECT_THAT(run({path("a.object"), "--undo"}).sentence, HasSubstr("expected 1 edits to undo"));
}

TEST_F(TextureApp, ListsAndLeavesTheFileAlone) {
    run({path("a.object"), "--crop", "--region", "box 1:,:,:", "--keep", "--region",
         "box :,0:,:", "--out", path("b.object")});
    const std::string before = bytesOf(path("b.object"));
    const auto time = fs::last_write_time(path("b.object"));
    const Outcome listed = run({path("b.object"), "--list"});
    EXPECT_THAT(listed.text, HasSubstr("  1 crop remove in box 1:,:,:\n"));
    EXPECT_THAT(listed.text, HasSubstr("  2 crop keep in box :,0:,:\n"));
    EXPECT_TRUE(bytesOf(path("b.object")) == before);
    EXPECT_EQ(fs::last_write_time(path("b.object")), time);
    EXPECT_EQ(loadObject(path("a.object")).edits.size(), 0U);  // --out: the input stays
}

TEST_F(TextureApp, ReplaceNeedsTheOtherFileOnlyOnce) {
    MadeCar green;
    green.step_m = 0.08;
    green.paint = {20, 150, 30};
    saveObject({green.model(), {{"brush", "9,9,9", "normal 0,0,1,5 & box :,:,0.5:", {}}}},
               path("green.object"));
    EXPECT_EQ(run({path("a.object"), "--replace-from", path("green.object")}).sentence, "");
    fs::remove(path("green.object"));
    const ObjectModel model = replay(loadObject(path("a.object")));
    std::size_t roof = 0, painted = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (model.point(i)[2] < 0.7F || std::abs(model.point(i)[1]) > 0.6F) continue;
        ++roof;
        painted += model.colours[i].mean[0] < 40 ? 1U : 0U;  // with the other's edits
    }
    EXPECT_GT(roof, 20U);
    EXPECT_GT(static_cast<double>(painted), 0.9 * static_cast<double>(roof));
    EXPECT_THAT(run({path("a.object"), "--list"}).text, HasSubstr("replace-from green.object"));
}

TEST_F(TextureApp, ExportsAndPictures) {
    const Outcome done =
        run({path("a.object"), "--symmetrise", "--export", path("car.ply"), "--export",
             path("car.obj"), "--export", path("car.glb"), "--export-points", path("points.ply"),
             "--pictures", path("pictures")});
    EXPECT_EQ(done.sentence, "");
    for (const char* name : {"car.ply", "car.obj", "car.mtl", "car.png", "car.glb", "points.ply",
                             "pictures/a_01_symmetrise.png"}) {
        EXPECT_GT(fs::file_size(folder_ / name), 100U) << name;
    }
    EXPECT_THAT(done.text, HasSubstr("car.glb: "));
    // Pictures of edits made earlier, too.
    fs::remove_all(folder_ / "pictures");
    run({path("a.object"), "--pictures", path("pictures")});
    EXPECT_TRUE(fs::exists(folder_ / "pictures" / "a_01_symmetrise.png"));
}

TEST_F(TextureApp, ClosedSurfacesHaveMoreOfIt) {
    run({path("a.object"), "--export", path("open.obj")});
    run({path("a.object"), "--closed", "--export", path("closed.obj")});
    const auto faces = [&](const std::string& name) {
        std::ifstream in(path(name));
        std::string line;
        std::size_t count = 0;
        while (std::getline(in, line)) count += line.rfind("f ", 0) == 0 ? 1 : 0;
        return count;
    };
    EXPECT_GT(faces("open.obj"), 100U);
    EXPECT_GT(faces("closed.obj"), faces("open.obj") + 100);
}

TEST_F(TextureApp, AlbedoIsExportedWhereThereIsOne) {
    EXPECT_THAT(run({path("a.object"), "--albedo", "--export-points", path("a.ply")}).sentence,
                HasSubstr("expected an object with albedo"));
    ObjectModel car = loadObject(path("a.object")).original;
    car.albedo.assign(car.size(), {1, 2, 3});
    saveObject({car, {}}, path("b.object"));
    EXPECT_EQ(run({path("b.object"), "--albedo", "--export-points", path("b.ply")}).sentence, "");
    EXPECT_EQ(run({path("b.object"), "--export-points", path("c.ply")}).sentence, "");
    EXPECT_NE(bytesOf(path("b.ply")), bytesOf(path("c.ply")));
    EXPECT_EQ(loadObject(path("b.object")).original.colours[9].mean, car.colours[9].mean);
}

TEST_F(TextureApp, ARunAgainGivesTheSameBytes) {
    const std::vector<std::string> edits{"--symmetrise", "--fill",         "--smooth",
                                         "--denoise",    "--replace-from", path("a.object")};
    for (const char* name : {"one", "two"}) {
        auto words = edits;
        words.insert(words.begin(), path("a.object"));
        for (const auto& w : {std::string("--out"), path(std::string(name) + ".object"),
                              std::string("--export"), path(std::string(name) + ".glb")}) {
            words.push_back(w);
        }
        EXPECT_EQ(run(words).sentence, "");
    }
    EXPECT_TRUE(bytesOf(path("one.object")) == bytesOf(path("two.object")));
    EXPECT_TRUE(bytesOf(path("one.glb")) == bytesOf(path("two.glb")));
}

TEST_F(TextureApp, AFolderMeansAllOfItsObjects) {
    makeResult();
    const Outcome done =
        run({path("result"), "--recolour", "20,20,200", "--export", path("car.ply")});
    EXPECT_EQ(done.sentence, "");
    for (const char* name : {"0003", "0012"}) {
        const auto file = folder_ / "result" / "objects" / (std::string(name) + ".object");
        EXPECT_EQ(loadObject(file).edits.size(), 1U);
        EXPECT_TRUE(fs::exists(folder_ / (std::string("car_") + name + ".ply")));
    }
    run({path("result"), "--undo", "--out", path("plain")});
    EXPECT_EQ(loadObject(path("plain/0012.object")).edits.size(), 0U);
    EXPECT_EQ(loadObject(path("result/objects/0012.object")).edits.size(), 1U);
}

TEST_F(TextureApp, NothingIsWrittenIfOneFileIsBad) {
    makeResult();
    const auto good = path("result/objects/0003.object");
    const std::string before = bytesOf(good);
    fs::resize_file(path("result/objects/0012.object"), 300);
    EXPECT_THAT(run({path("result"), "--smooth"}).sentence, HasSubstr("0012.object"));
    EXPECT_TRUE(bytesOf(good) == before);
}

TEST_F(TextureApp, BadCommandLinesAreToldInOneSentence) {
    const auto expect = [&](std::vector<std::string> words, const std::string& part) {
        EXPECT_THAT(run(words).sentence, HasSubstr(part));
    };
    const std::string a = path("a.object");
    const std::string before = bytesOf(a);
    expect({}, "see --help");
    expect({a, "--polish"}, "--polish");
    expect({"--polish", a}, "--polish");
    expect({a, path("b.object")}, "expected one .object file");
    expect({a, "--brush"}, "brush");
    expect({a, "--brush", "red"}, "expected a colour R,G,B");
    expect({a, "--brush", "1,2,999"}, "0..255");
    expect({a, "--region", "box :,:,:"}, "expected an edit first");
    expect({a, "--brush", "1,2,3", "--region", "cube"}, "'sphere x,y,z,r'");
    expect({a, "--crop"}, "expected a region");
    expect({a, "--replace-from", path("none.object")}, "none.object");
    expect({a, "--replace-from", path("pictures")}, "pictures");
    expect({a, "--export", path("car.stl")}, "ending .ply, .obj or .glb");
    expect({a, "--export-points", path("car.obj")}, "ending .ply");
    expect({path("none.object")}, "none.object");
    fs::create_directories(folder_ / "empty");
    expect({path("empty")}, "expected files like 0000.object");
    std::ofstream(path("text.object")) << "not an object";
    expect({path("text.object")}, "text.object");
    expect({a, "--list", "--out", path("no/such/b.object")}, "b.object");
    expect({a, "--pictures", path("text.object")}, "text.object");
    EXPECT_TRUE(bytesOf(a) == before);
}

}  // namespace
