#include "djpete/texture/editing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "djpete/obs/errors.h"
#include "djpete/texture/region.h"

namespace {

using namespace djpete::texture;
using djpete::obs::InputError;
using testing::HasSubstr;

/// A plate in y = 0.9, blue (shaded to the right), with one stray point and one stray colour.
ObjectModel plate() {
    ObjectModel model;
    model.size_m = {4, 1.8, 1.5};
    for (int a = -20; a <= 20; ++a) {
        for (int b = -10; b <= 10; ++b) {
            model.addPoint({0.05F * static_cast<float>(a), 0.9F, 0.05F * static_cast<float>(b)},
                           {0, 1, 0}, 0.05F);
            const float light = a < 0 ? 1.0F : 0.5F;
            const std::size_t i = model.size() - 1;
            for (int k = 0; k < 4; ++k)
                model.colours[i].add({40 * light, 60 * light, 200 * light}, 1);
            model.showColour(i);
        }
    }
    return model;
}

std::string sentenceOf(const Edit& edit) {
    try {
        applied(plate(), edit);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(Region, HoldsWhatAllConditionsHold) {
    const ObjectModel model = plate();
    const auto count = [&](const std::string& text) {
        const Region region = Region::parse(text);
        std::size_t n = 0;
        for (std::size_t i = 0; i < model.size(); ++i) n += region.contains(model, i) ? 1U : 0U;
        return n;
    };
    EXPECT_EQ(count(""), 41U * 21U);
    EXPECT_EQ(count("box -0.12:0.12,0:1,-0.12:0.12"), 25U);
    EXPECT_EQ(count("sphere 0,0.9,0,0.051"), 5U);
    EXPECT_EQ(count("normal 0,2,0,10"), 41U * 21U);
    EXPECT_EQ(count("normal 1,0,0,80"), 0U);
    EXPECT_EQ(count("colour 0:25,0:255,0:255"), 21U * 21U);
    EXPECT_EQ(count("colour 0:25,0:255,0:255; box -9:9,-9:9,0.01:9"), 21U * 10U);
    for (const char* wrong : {"boxes 1", "box 0:1,0:1", "box 0:1,0:1,1:0", "sphere 0,0,0,-1",
                              "sphere 0,0,0", "normal 0,0,0,10", "colour 0:1,0:1,0:x", "box"}) {
        EXPECT_THROW(Region::parse(wrong), InputError) << wrong;
    }
}

TEST(Edits, RecolouringKeepsLightAndShade) {
    const ObjectModel red = applied(plate(), {"recolour", "200,30,30", "", {}});
    std::array<float, 2> brightest{0, 0};
    for (std::size_t i = 0; i < red.size(); ++i) {
        const auto& c = red.colours[i].mean;
        EXPECT_GT(c[0], 3 * c[2]);
        EXPECT_EQ(red.flags[i], flag::kEdited);
        auto& side = brightest[red.point(i)[0] < 0 ? 0 : 1];
        side = std::max(side, c[0]);
    }
    EXPECT_NEAR(brightest[1] / brightest[0], 0.5, 0.3);
    EXPECT_LT(brightest[1], brightest[0]);
}

TEST(Edits, TheBrushPaintsItsRegionOnly) {
    const ObjectModel model = applied(plate(), {"brush", "1,2,3", "sphere 0,0.9,0,0.051", {}});
    std::size_t painted = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (model.flags[i] == 0) continue;
        ++painted;
        EXPECT_EQ(model.colours[i].mean, (std::array<float, 3>{1, 2, 3}));
    }
    EXPECT_EQ(painted, 5U);
}

TEST(Edits, CropAndKeepAreEachOthersRest) {
    const std::string region = "box -9:0,-9:9,-9:9";
    const std::size_t kept = applied(plate(), {"keep", "", region, {}}).size();
    const std::size_t left = applied(plate(), {"crop", "", region, {}}).size();
    EXPECT_EQ(kept, 21U * 21U);
    EXPECT_EQ(kept + left, plate().size());
}

TEST(Edits, SmoothingEvensSpecklesAndLeavesEdges) {
    ObjectModel model = plate();
    for (std::size_t i = 0; i < model.size(); i += 2) {
        ColourSum darker;
        auto rgb = model.colours[i].mean;
        for (float& c : rgb) c *= 0.9F;
        darker.add(rgb, 1);
        model.colours[i] = darker;
    }
    const ObjectModel smooth = applied(model, {"smooth", "0.12", "", {}});
    for (std::size_t i = 0; i < smooth.size(); ++i) {
        const float x = smooth.point(i)[0];
        const float expected = x < 0 ? 190 : 95;
        EXPECT_NEAR(smooth.colours[i].mean[2], expected, 12) << x;
    }
}

TEST(Edits, DenoisingTakesStrayPointsAndColoursOut) {
    ObjectModel model = plate();
    model.addPoint({0, 1.6F, 0}, {0, 1, 0}, 0.05F);
    const std::size_t odd = 17;
    model.colours[odd] = ColourSum();
    model.colours[odd].add({255, 255, 0}, 1);
    const ObjectModel clean = applied(model, {"denoise", "", "", {}});
    for (std::size_t i = 0; i < clean.size(); ++i) EXPECT_LT(clean.point(i)[1], 1);
    EXPECT_GT(clean.size(), plate().size() * 95 / 100);
    std::size_t yellow = 0;
    for (const auto& colour : clean.colours) yellow += colour.mean[0] > 100 ? 1U : 0U;
    EXPECT_EQ(yellow, 0U);
}

TEST(Edits, ColoursOfAnotherObjectComeBoxOnBox) {
    ObjectModel green = plate();
    green.size_m = {2, 1.8, 1.5};  // half as long: its end is at the end of the long one
    std::vector<bool> half;
    for (std::size_t i = 0; i < green.size(); ++i) {
        green.colours[i] = ColourSum();
        green.colours[i].add({0, green.point(i)[0] > 0.25F ? 250.0F : 100.0F, 0}, 1);
    }
    const ObjectModel model = applied(plate(), {"replace", "", "", packObject(green)});
    for (std::size_t i = 0; i < model.size(); ++i) {
        const float x = model.point(i)[0];
        if (std::abs(x - 0.5F) < 0.11F) continue;
        EXPECT_EQ(model.colours[i].mean[1], x > 0.5F ? 250.0F : 100.0F) << x;
    }
}

TEST(Edits, AreReplayedOverTheOriginal) {
    SavedObject object{plate(),
                       {{"brush", "9,9,9", "", {}}, {"crop", "", "box 0:9,-9:9,-9:9", {}}}};
    const ObjectModel model = replayed(object);
    EXPECT_EQ(model.size(), 20U * 21U);
    EXPECT_EQ(model.colours[0].mean[0], 9);
    EXPECT_EQ(object.original.size(), 41U * 21U);
    EXPECT_NEAR(object.original.colours[0].mean[0], 40, 1e-3);
    EXPECT_EQ(applied(ObjectModel(), {"fill", "", "", {}}).size(), 0U);
}

TEST(Edits, TellWhatWasExpected) {
    EXPECT_THAT(sentenceOf({"varnish", "", "", {}}), HasSubstr("expected one of brush, crop"));
    EXPECT_THAT(sentenceOf({"brush", "1,2", "", {}}), HasSubstr("red,green,blue"));
    EXPECT_THAT(sentenceOf({"brush", "1,2,300", "", {}}), HasSubstr("0 to 255"));
    EXPECT_THAT(sentenceOf({"smooth", "-1", "", {}}), HasSubstr("metres"));
    EXPECT_THAT(sentenceOf({"crop", "", "", {}}), HasSubstr("needs a region"));
    EXPECT_THAT(sentenceOf({"fill", "3", "", {}}), HasSubstr("takes no parameters"));
    EXPECT_THAT(sentenceOf({"fill", "", "sphere 0,0,0,1", {}}), HasSubstr("whole object"));
    EXPECT_THAT(sentenceOf({"replace", "", "", {1, 2, 3}}), HasSubstr("damaged"));
}

}  // namespace
