/// Figures of textures on a world small enough to count by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "djpete/evaluation/silhouette.h"
#include "djpete/evaluation/texture_curve.h"
#include "djpete/evaluation/texture_errors.h"
#include "made_board.h"

namespace djpete::evaluation {
namespace {

using ::testing::DoubleNear;
using ::testing::Optional;

TEST(TextureErrors, aModelOfHalfTheBoardCoversHalfOfIt) {
    const MadeBoard board;
    const auto seen = seenVertices(board.mesh, {board.view()}, board.camera, 25);
    const auto all = coverageOf(board.model(-1, 1), board.T_identity, board.mesh, seen);
    EXPECT_NEAR(all.seen_m2, 2.0, 1e-5);
    EXPECT_THAT(all.share10(), Optional(DoubleNear(1, 1e-9)));
    const auto half = coverageOf(board.model(-1, 0), board.T_identity, board.mesh, seen);
    EXPECT_THAT(half.share5(), Optional(DoubleNear(0.5 + 0.05 / 2, 0.02)));
    EXPECT_THAT(half.share10(), Optional(DoubleNear(0.5 + 0.10 / 2, 0.02)));
}

TEST(TextureErrors, coverageKnowsOnlySeenColours) {
    const MadeBoard board;
    const auto seen = seenVertices(board.mesh, {board.view()}, board.camera, 25);
    auto model = board.model(-1, 1);
    for (std::size_t i = 0; i < model.size(); ++i) model.flags[i] = texture::flag::kInferredColour;
    EXPECT_THAT(coverageOf(model, board.T_identity, board.mesh, seen).share10(), Optional(0.0));
    // A pose that is wrong by half a metre towards the camera takes the points away.
    const geometry::SE3 wrong(geometry::Mat3::Identity(), {0.5, 0, 0});
    EXPECT_THAT(coverageOf(board.model(-1, 1), wrong, board.mesh, seen).share10(), Optional(0.0));
}

TEST(TextureErrors, maskRangeAndSideDecideWhatIsSeen) {
    const MadeBoard board;
    const auto count = [&](const TruthView& view, double range) {
        const auto seen = seenVertices(board.mesh, {view}, board.camera, range);
        return std::count(seen.begin(), seen.end(), true);
    };
    EXPECT_EQ(count(board.view(), 25), static_cast<long>(board.mesh.size()));
    EXPECT_EQ(count(board.view(), MadeBoard::kDistance_m - 0.5), 0);
    TruthView hidden = board.view();
    std::fill(hidden.mask.pixels.begin(), hidden.mask.pixels.end(), uint8_t{0});
    EXPECT_EQ(count(hidden, 25), 0);
    TruthView behind = board.view();
    const Eigen::AngleAxisd turn(M_PI, geometry::Vec3::UnitZ());
    behind.T_cam_true =
        behind.T_cam_true * geometry::SE3(turn.toRotationMatrix(), geometry::Vec3::Zero());
    behind.view = viewOfMesh(board.mesh, board.camera, behind.T_cam_true);
    EXPECT_EQ(count(behind, 25), 0);
}

TEST(TextureErrors, oneGainExplainsADarkerImage) {
    const MadeBoard board;
    auto model = board.model(-1, 1);
    for (auto& c : model.colours) c = MadeBoard::sample(board.cameraColour(0.4));
    const auto pairs = colourPairs(model, board.T_identity, board.mesh);
    ASSERT_EQ(pairs.size(), model.size());
    const double gain = fitGain(pairs);
    EXPECT_NEAR(gain, 1 / 0.4, 0.02);
    for (double e : colourErrors(pairs, gain)) EXPECT_LT(e, 0.3);
    for (double e : colourErrors(pairs, 1)) EXPECT_GT(e, 10);
}

TEST(TextureErrors, theModelsAlbedoIsComparedAsItIs) {
    const MadeBoard board;
    auto model = board.model(-1, 1);
    EXPECT_TRUE(albedoPairs(model, board.T_identity, board.mesh).empty());
    model.albedo.assign(model.size(), board.mesh.srgb[0]);
    const auto pairs = albedoPairs(model, board.T_identity, board.mesh);
    ASSERT_EQ(pairs.size(), model.size());
    for (double e : colourErrors(pairs, 1)) EXPECT_LT(e, 0.01);
    for (auto& a : model.albedo) a = {255, 255, 255};
    for (double e : colourErrors(albedoPairs(model, board.T_identity, board.mesh), 1)) {
        EXPECT_GT(e, 5);
    }
}

TEST(TextureErrors, surfacesThatFaceAwayAreNotCompared) {
    const MadeBoard board;
    auto model = board.model(-1, 1);
    for (auto& n : model.normals) n = {-n[0], -n[1], -n[2]};
    EXPECT_TRUE(colourPairs(model, board.T_identity, board.mesh).empty());
}

TEST(TextureErrors, samplesOfAnotherMaskOrBehindTheSurfaceBleed) {
    const MadeBoard board;
    const auto model = board.model(-1, 1);
    const auto clean = bleedingOf(model, {board.view()}, board.camera);
    EXPECT_EQ(clean.points, model.size());
    EXPECT_EQ(clean.wrongPoints, 0U);

    TruthView halfHidden = board.view();
    for (int v = 0; v < halfHidden.mask.height_px; ++v) {
        for (int u = 0; u < halfHidden.mask.width_px / 2; ++u) {
            halfHidden.mask.pixels[halfHidden.mask.index(u, v)] = 0;
        }
    }
    const auto half = bleedingOf(model, {halfHidden}, board.camera);
    EXPECT_NEAR(static_cast<double>(half.wrongPoints) / static_cast<double>(half.points), 0.5,
                0.03);

    TruthView tooDeep = board.view();
    tooDeep.T_cam_est = geometry::SE3(geometry::Mat3::Identity(), {0, 0, 0.3}) * tooDeep.T_cam_est;
    EXPECT_EQ(bleedingOf(model, {tooDeep}, board.camera).wrongSamples, model.size());
    TruthView deep = board.view();
    deep.T_cam_est = geometry::SE3(geometry::Mat3::Identity(), {0, 0, 0.2}) * deep.T_cam_est;
    EXPECT_EQ(bleedingOf(model, {deep}, board.camera).wrongSamples, 0U);
}

TEST(TextureErrors, spreadIsOfPointsWithTwoSamples) {
    const MadeBoard board;
    auto model = board.model(-1, 1);
    EXPECT_EQ(colourSpread(model), std::nullopt);
    model.colours[0].add({10, 10, 10}, 1);
    const float one = model.colours[0].standardDeviation();
    ASSERT_GT(one, 1);
    EXPECT_THAT(colourSpread(model), Optional(DoubleNear(static_cast<double>(one), 1e-6)));
}

TEST(TextureErrors, sunnyIsWhatFacesTheSun) {
    const MadeBoard board;
    auto pairs = colourPairs(board.model(-1, 1), board.T_identity, board.mesh);
    markSunny(pairs, geometry::Vec3(1, 0, 1).normalized());
    EXPECT_TRUE(pairs.front().sunny);
    markSunny(pairs, geometry::Vec3(-1, 0, 1).normalized());
    EXPECT_FALSE(pairs.front().sunny);
}

TEST(Silhouette, psnrForgivesOneGainAndOffsetAndNothingElse) {
    const MadeBoard board;
    const auto view = board.view();
    auto rendered = texture::renderModel(board.model(-1, 1), board.camera, view.T_cam_est);
    RgbImage image{rendered.width_px, rendered.height_px, {}};
    for (std::size_t i = 0; i < rendered.rgb.size(); ++i) {
        const auto value = static_cast<uint8_t>(i % 3 == 0 ? 40 : 100);
        rendered.rgb[i] = {value, value, value};
        const auto shown = static_cast<uint8_t>(2 * value + 10);
        image.pixels.push_back({shown, shown, shown});
    }
    const auto same = matchImages(rendered, image, view.mask);
    ASSERT_TRUE(same);
    EXPECT_GE(same->psnr_dB, 59);
    // Half of 120 away from the middle: a third of the pixels, 2/9 * 120^2 around the mean.
    EXPECT_NEAR(same->flatPsnr_dB, 10 * std::log10(255 * 255 / (2 / 9.0 * 120 * 120)), 0.05);
    for (auto& p : image.pixels) p = {static_cast<uint8_t>(255 - p[0]), p[1], p[2]};
    EXPECT_LT(matchImages(rendered, image, view.mask)->psnr_dB, 20);
}

TEST(Silhouette, whatIsMissingCountsAsTheMeanOfTheMask) {
    const MadeBoard board;
    const auto view = board.view();
    MaskImage mask = view.mask;
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        const auto at =
            view.view.at(static_cast<int>(i) % mask.width_px, static_cast<int>(i) / mask.width_px);
        mask.pixels[i] = at && view.view.vertex[*at] != MeshView::kNothing ? 255 : 0;
    }
    const auto whole = board.model(-1, 1);
    const auto rendered = texture::renderModel(whole, board.camera, view.T_cam_est);
    const RgbImage image{rendered.width_px, rendered.height_px, rendered.rgb};
    const auto none = imageErrorOf(whole.subset(std::vector<bool>(whole.size(), false)), image,
                                   mask, board.camera, view.T_cam_est);
    const auto half = imageErrorOf(board.model(-1, 0), image, mask, board.camera, view.T_cam_est);
    const auto all = imageErrorOf(whole, image, mask, board.camera, view.T_cam_est);
    ASSERT_TRUE(none && half && all);
    EXPECT_NEAR(*all, 0, 1e-6);
    EXPECT_NEAR(*half / *none, std::sqrt(0.5), 0.05);
    EXPECT_GT(*none, 10);
}

TEST(Silhouette, iouCountsPixelsThatAreNotIgnored) {
    const MaskImage left{4, 1, {255, 255, 255, 0}}, right{4, 1, {0, 255, 255, 255}};
    EXPECT_THAT(silhouetteIou(left, right, {}), Optional(0.5));
    EXPECT_THAT(silhouetteIou(left, right, {4, 1, {255, 0, 0, 0}}),
                Optional(DoubleNear(2.0 / 3, 1e-12)));
    const MaskImage none{2, 1, {0, 0}};
    EXPECT_EQ(silhouetteIou(none, none, {}), std::nullopt);
}

}  // namespace
}  // namespace djpete::evaluation
