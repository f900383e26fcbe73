#include "djpete/texture/editing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "djpete/obs/errors.h"
#include "djpete/texture/region.h"
#include "made_car.h"

namespace {

using namespace djpete::texture;
using djpete_test::MadeCar;
using djpete_test::Vec3;
using testing::HasSubstr;
using Rgb = std::array<float, 3>;

std::size_t count(const ObjectModel& model, const std::string& region) {
    const Region r(region);
    std::size_t n = 0;
    for (std::size_t i = 0; i < model.size(); ++i) n += r.contains(model, i) ? 1U : 0U;
    return n;
}

std::string sentenceOf(const Edit& edit, const ObjectModel& model) {
    try {
        apply(model, edit);
    } catch (const djpete::obs::InputError& e) {
        return e.what();
    }
    return "";
}

TEST(Region, TermsAndTheirJoin) {
    const ObjectModel car = MadeCar().model();
    EXPECT_EQ(count(car, ""), car.size());
    EXPECT_EQ(count(car, "box :,:,:"), car.size());
    const std::size_t front = count(car, "box 0:,:,:"), left = count(car, "normal 0,1,0,10");
    EXPECT_GT(front, 500U);
    EXPECT_EQ(front + count(car, "not box 0:,:,:"), car.size());
    const std::size_t both = count(car, "box 0:,:,: & normal 0,1,0,10");
    EXPECT_GT(both, 100U);
    EXPECT_LT(both, std::min(front, left));
    for (std::size_t i = 0; i < car.size(); ++i) {
        const auto p = car.point(i);
        EXPECT_EQ(Region("sphere 2.1,0,0,0.5").contains(car, i),
                  (Vec3(p[0], p[1], p[2]) - Vec3(2.1, 0, 0)).norm() <= 0.5);
        EXPECT_EQ(Region("colour 170:190,30:50,:").contains(car, i), car.colours[i].mean[0] == 180);
    }
}

TEST(Region, WrongWordsAreTold) {
    const auto sentence = [](const std::string& text) -> std::string {
        try {
            Region r(text);
        } catch (const djpete::obs::InputError& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_THAT(sentence("ball 1,2,3,4"), HasSubstr("'sphere x,y,z,r'"));
    EXPECT_THAT(sentence("sphere 1,2,3"), HasSubstr("sphere x,y,z,r in metres"));
    EXPECT_THAT(sentence("sphere 1,2,3,-1"), HasSubstr("r above 0"));
    EXPECT_THAT(sentence("sphere 1,2,x,1"), HasSubstr("got 'x'"));
    EXPECT_THAT(sentence("box 1:0,:,:"), HasSubstr("the lower end first"));
    EXPECT_THAT(sentence("box 1,2,3"), HasSubstr("x0:x1,y0:y1,z0:z1"));
    EXPECT_THAT(sentence("box nan:,:,:"), HasSubstr("box"));
    EXPECT_THAT(sentence("normal 0,0,0,5"), HasSubstr("not 0"));
    EXPECT_THAT(sentence("normal 0,0,1,200"), HasSubstr("0..180"));
    EXPECT_THAT(sentence("box :,:,: &"), HasSubstr("expected"));
    EXPECT_THAT(sentence("not"), HasSubstr("expected"));
}

TEST(Editing, RecolourKeepsLightAndShade) {
    const ObjectModel car = MadeCar().model();
    EditReport report;
    const ObjectModel blue = apply(car, {"recolour", "30,60,200", "", {}}, &report);
    ASSERT_EQ(blue.size(), car.size());
    EXPECT_EQ(report.changed, car.size());
    const auto light = [](const Rgb& c) { return 0.299F * c[0] + 0.587F * c[1] + 0.114F * c[2]; };
    float darkest = 255, lightest = 0;
    for (std::size_t i = 0; i < car.size(); ++i) {
        const Rgb& now = blue.colours[i].mean;
        EXPECT_GT(now[2], now[0]);  // blue
        EXPECT_EQ(blue.flags[i], flag::kEdited);
        EXPECT_EQ(blue.colours[i].count, car.colours[i].count);
        darkest = std::min(darkest, light(now));
        lightest = std::max(lightest, light(now));
        for (std::size_t j : {std::size_t{0}, car.size() / 2}) {  // the order of shades stays
            if (light(car.colours[i].mean) > 1.1F * light(car.colours[j].mean)) {
                EXPECT_GT(light(now), light(blue.colours[j].mean));
            }
        }
    }
    EXPECT_GT(lightest, 2 * darkest);
    EXPECT_EQ(car.flags[0], 0);  // the given model stays
}

TEST(Editing, RecolourLeavesDarkPartsAndTurnsTheAlbedo) {
    ObjectModel car = MadeCar().model();
    car.albedo.assign(car.size(), {120, 20, 20});
    for (std::size_t i = 0; i < car.size(); i += 3) {
        car.flags[i] = flag::kDarkPart;
        car.albedo[i] = {40, 40, 40};
    }
    EditReport report;
    const ObjectModel blue = apply(car, {"recolour", "30,60,200", "", {}}, &report);
    EXPECT_EQ(report.changed, car.size() - (car.size() + 2) / 3);
    for (std::size_t i = 0; i < car.size(); ++i) {
        if (i % 3 == 0) {
            EXPECT_EQ(blue.colours[i].mean, car.colours[i].mean);
            EXPECT_EQ(blue.albedo[i], car.albedo[i]);
        } else {
            EXPECT_EQ(blue.albedo[i], (std::array<uint8_t, 3>{30, 60, 200}));
        }
    }
}

TEST(Editing, BrushPaintsTheRegionOnly) {
    const ObjectModel car = MadeCar().model();
    const std::string roof = "normal 0,0,1,20 & box :,:,0.5:";
    EditReport report;
    const ObjectModel painted = apply(car, {"brush", "1,2,3", roof, {}}, &report);
    EXPECT_EQ(report.changed, count(car, roof));
    EXPECT_EQ(report.text, std::to_string(report.changed) + " points changed");
    const Region region(roof);
    for (std::size_t i = 0; i < car.size(); ++i) {
        const bool in = region.contains(car, i);
        EXPECT_EQ(painted.colours[i].mean, in ? (Rgb{1, 2, 3}) : car.colours[i].mean);
        EXPECT_EQ(painted.flags[i], in ? flag::kEdited : 0);
    }
}

TEST(Editing, SmoothTakesNoiseAndKeepsEdges) {
    ObjectModel model;
    for (int i = 0; i < 30; ++i) {
        for (int j = 0; j < 20; ++j) {
            model.addPoint({0.04F * static_cast<float>(i), 0.04F * static_cast<float>(j), 0},
                           {0, 0, 1}, 0.04F);
            const float level = i < 15 ? 60.0F : 200.0F;
            const float noise = static_cast<float>((i * 7 + j * 13) % 11) - 5;
            model.colours.back().add({level + noise, level, level - noise}, 1);
        }
    }
    const ObjectModel smooth = apply(model, {"smooth", "", "", {}});
    double before = 0, after = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const float level = i / 20 < 15 ? 60.0F : 200.0F;
        before += std::pow(model.colours[i].mean[0] - level, 2);
        after += std::pow(smooth.colours[i].mean[0] - level, 2);
        EXPECT_NEAR(smooth.colours[i].mean[1], level, 2) << "the edge stays";
    }
    EXPECT_LT(after, 0.1 * before);
}

TEST(Editing, CropRemovesOrKeeps) {
    const ObjectModel car = MadeCar().model();
    const std::string front = "box 0.5:,:,:";
    const std::size_t inside = count(car, front);
    EXPECT_EQ(apply(car, {"crop", "", front, {}}).size(), car.size() - inside);
    EXPECT_EQ(apply(car, {"crop", "keep", front, {}}).size(), inside);
    EXPECT_THAT(sentenceOf({"crop", "", "", {}}, car), HasSubstr("expected a region"));
}

TEST(Editing, DenoiseRemovesLonelyPointsAndOddColours) {
    ObjectModel car = MadeCar().model();
    const std::size_t whole = car.size();
    for (float y = -0.8F; y < 0.8F; y += 0.4F) car.addPoint({0, y, 1.3F}, {0, 0, 1}, 0.04F);
    std::size_t odd = 0;  // a point in the middle of the roof
    for (std::size_t i = 0; i < whole; ++i) {
        const auto p = car.point(i);
        if (car.normals[i][2] > 0.9F && p[2] > 0.5F && std::abs(p[0]) + std::abs(p[1]) < 0.2F) {
            odd = i;
        }
    }
    ASSERT_GT(odd, 0U);
    const Rgb roof = car.colours[odd].mean;
    car.colours[odd] = ColourSum();
    car.colours[odd].add({10, 250, 250}, 1);
    EditReport report;
    const ObjectModel clean = apply(car, {"denoise", "", "", {}}, &report);
    EXPECT_EQ(report.removed, 4U);
    ASSERT_EQ(clean.size(), whole);
    EXPECT_EQ(clean.colours[odd].mean, roof);
    EXPECT_EQ(clean.flags[odd], flag::kEdited);
}

TEST(Editing, ReplaceTakesTheOthersColoursAtTheirPlaces) {
    MadeCar small, large;
    small.paint = {20, 120, 20};
    large.size_m = Vec3(5.2, 2.1, 1.9);
    const ObjectModel other = large.model();
    const Edit edit = replaceFrom(other, "other.object");
    EXPECT_EQ(edit.parameters, "other.object");
    const ObjectModel car = small.model();
    const ObjectModel replaced = apply(car, edit);
    std::size_t green = 0, right = 0;
    for (std::size_t i = 0; i < car.size(); ++i) {
        if (car.colours[i].mean != small.paint) continue;
        ++green;
        right += std::abs(replaced.colours[i].mean[0] - large.paint[0]) < 15 ? 1U : 0U;
    }
    EXPECT_GT(static_cast<double>(right), 0.93 * static_cast<double>(green));  // but at stripes
    EXPECT_THAT(sentenceOf({"replace-from", "x", "", {}}, car), HasSubstr("holds the other"));
    EXPECT_THAT(sentenceOf({"replace-from", "x", "", {1, 2, 3}}, car), HasSubstr("damaged"));
    EXPECT_THROW(replaceFrom(ObjectModel(), "empty"), djpete::obs::InputError);
}

TEST(Editing, SymmetriseAndFillWithinARegion) {
    MadeCar made;
    made.seen = [](const Vec3&, const Vec3& n) { return n.y() > -0.5; };
    const ObjectModel half = made.model();
    EditReport report;
    const ObjectModel front = apply(half, {"symmetrise", "", "box 0:,:,:", {}}, &report);
    EXPECT_GT(report.added, 300U);
    EXPECT_THAT(report.text, HasSubstr("of the box"));
    for (std::size_t i = half.size(); i < front.size(); ++i) EXPECT_GE(front.point(i)[0], 0);
    made.keepUnseen = true;
    const ObjectModel grey = made.model();
    const ObjectModel filled = apply(grey, {"fill", "", "box 0:,:,:", {}}, &report);
    EXPECT_GT(report.changed, 300U);
    for (std::size_t i = 0; i < grey.size(); ++i) {
        const bool wasEmpty = grey.colours[i].count == 0, in = grey.point(i)[0] >= 0;
        EXPECT_EQ(filled.flags[i], wasEmpty && in ? flag::kInferredColour : 0);
    }
}

TEST(Editing, ReplayIsTheSameAfterSavingAndLoading) {
    SavedObject object{MadeCar().model(), {}};
    MadeCar other;
    other.paint = {30, 30, 150};
    object.edits = {{"recolour", "200,200,40", "colour 150:200,:,:", {}},
                    replaceFrom(other.model(), "blue", "box :,:,0:"),
                    {"crop", "", "sphere 2.1,0.9,-0.7,0.3", {}},
                    {"smooth", "3", "", {}}};
    const auto file = std::filesystem::path(testing::TempDir()) / "djpete_replay.object";
    saveObject(object, file);
    const SavedObject loaded = loadObject(file);
    std::filesystem::remove(file);
    EXPECT_TRUE(packObject(replay(object)) == packObject(replay(loaded)));
    EXPECT_TRUE(packObject(loaded.original) == packObject(MadeCar().model()));
    object.edits.clear();
    EXPECT_TRUE(packObject(replay(object)) == packObject(object.original));
}

TEST(Editing, BadParametersAreToldInOneSentence) {
    const ObjectModel car = MadeCar().model();
    EXPECT_THAT(sentenceOf({"recolour", "1,2", "", {}}, car), HasSubstr("R,G,B"));
    EXPECT_THAT(sentenceOf({"brush", "1,2,300", "", {}}, car), HasSubstr("0..255"));
    EXPECT_THAT(sentenceOf({"brush", "", "", {}}, car), HasSubstr("brush: expected"));
    EXPECT_THAT(sentenceOf({"smooth", "0", "", {}}, car), HasSubstr("1 to 50"));
    EXPECT_THAT(sentenceOf({"smooth", "1.5", "", {}}, car), HasSubstr("1 to 50"));
    EXPECT_THAT(sentenceOf({"denoise", "many", "", {}}, car), HasSubstr("standard deviations"));
    EXPECT_THAT(sentenceOf({"crop", "all", "", {}}, car), HasSubstr("'remove' or 'keep'"));
    EXPECT_THAT(sentenceOf({"fill", "1", "", {}}, car), HasSubstr("no parameters"));
    EXPECT_THAT(sentenceOf({"polish", "", "", {}}, car), HasSubstr("one of recolour, brush"));
    EXPECT_THAT(sentenceOf({"brush", "1,2,3", "cube", {}}, car), HasSubstr("region"));
    try {
        replay({car, {{"fill", "", "", {}}, {"polish", "", "", {}}}});
        FAIL();
    } catch (const djpete::obs::InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("edit 2 of object 7"));
    }
    for (const auto& name : editNames()) {  // an empty model is no reason to crash
        const Edit edit = name == "replace-from" ? replaceFrom(car, "x") : Edit{name, "", "", {}};
        sentenceOf(edit, ObjectModel());
    }
}

}  // namespace
