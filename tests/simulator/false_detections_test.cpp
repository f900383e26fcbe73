/// False detections: as many as asked for, where a detector could see them, some for a while.
#include "djpete/simulator/false_detections.h"

#include <algorithm>
#include <iostream>

#include "small_drive.h"

using namespace small_drive;

namespace {

struct FalseRows : testing::Test {
    sim::World world{Scene::options(3)};
    StereoCamera camera = sim::rigCamera(1241, 376);
    sim::DetectorNoise noise;

    std::vector<sim::Detection> at(uint64_t frame, std::size_t trueRows) const {
        return sim::makeFalseDetections(world, frame, camera, sim::T_vehicle_camera(), trueRows,
                                        noise, 60);
    }
    SE3 T_world_obj(const sim::Label& l) const {
        return world.T_world_vehicle(l.frame) * sim::T_vehicle_camera() * poseOf(l);
    }
};

}  // namespace

TEST_F(FalseRows, NoneUnlessAskedFor) {
    for (uint64_t f = 0; f < 20; ++f) EXPECT_TRUE(at(f, 10).empty());
}

TEST_F(FalseRows, AreTheShareOfAllRows) {
    noise.falseShare = 0.25;
    std::size_t right = 0, wrong = 0;
    for (uint64_t f = 0; f < 40; ++f) {
        const std::size_t n = 3 + f % 17;
        right += n;
        wrong += at(f, n).size();
    }
    const double all = static_cast<double>(right + wrong);
    EXPECT_NEAR(static_cast<double>(wrong) / all, 0.25, 0.03);
}

TEST_F(FalseRows, StandOnTheGroundInViewWithTheSizesOfCars) {
    noise.falseShare = 0.5;
    noise.sigma_m = noise.sigma_rad = 0;
    for (uint64_t f = 0; f < 40; ++f) {
        for (const auto& d : at(f, 10)) {
            const sim::Label& l = d.label;
            EXPECT_EQ(l.frame, f);
            EXPECT_EQ(l.type, "Car");
            EXPECT_NEAR(T_world_obj(l).translation().z(), 0.5 * l.height_m, 0.1);  // flat street
            EXPECT_LE(poseOf(l).translation().norm(), 60 + 1e-9);
            EXPECT_LT(l.left, l.right);
            EXPECT_LT(l.top, l.bottom);
            EXPECT_TRUE(l.length_m > 3 && l.length_m < 5 && l.width_m > 1.5 && l.width_m < 2);
            EXPECT_TRUE(d.score > 0 && d.score < 1);
        }
    }
}

/// A false box is known again by its size, which is drawn when it first shows.
TEST_F(FalseRows, SomeStayInTheirPlaceForAtMostThreeFrames) {
    noise.falseShare = 0.5;
    noise.sigma_m = 0.05;
    std::map<double, std::vector<sim::Label>> byLength;
    std::size_t rows = 0;
    for (uint64_t f = 0; f < 40; ++f) {
        for (const auto& d : at(f, 20)) byLength[d.label.length_m].push_back(d.label), ++rows;
    }
    std::size_t staying = 0;
    for (const auto& [length, labels] : byLength) {
        EXPECT_LE(labels.back().frame - labels.front().frame, 2U);
        EXPECT_LE(labels.size(), 3U);
        if (labels.size() > 1) ++staying;
        for (const auto& l : labels) {
            const Vec3 way = T_world_obj(l).translation() - T_world_obj(labels[0]).translation();
            EXPECT_LT(way.norm(), 0.5);
        }
    }
    EXPECT_GT(rows, byLength.size());
    EXPECT_GT(staying, byLength.size() / 20);
    EXPECT_LT(staying, byLength.size() / 4);
}

TEST_F(FalseRows, HaveLowerScoresThanTrueOnesThatOverlap) {
    noise.falseShare = 0.5;
    std::vector<double> wrong, right;
    for (uint64_t f = 0; f < 40; ++f) {
        std::vector<sim::Label> labels;
        for (const auto& d : at(f, 10)) {
            wrong.push_back(d.score);
            labels.push_back(d.label);  // true ones at the same ranges
            labels.back().trackId = static_cast<uint32_t>(labels.size());
        }
        for (const auto& d : sim::makeDetections(labels, noise, 1)) right.push_back(d.score);
    }
    std::sort(wrong.begin(), wrong.end());
    std::sort(right.begin(), right.end());
    EXPECT_LT(wrong[wrong.size() / 2], right[right.size() / 2] - 0.15);
    EXPECT_GT(wrong[9 * wrong.size() / 10], right[right.size() / 10]);
}

TEST_F(FalseRows, RepeatForASeed) {
    noise.falseShare = 0.5;
    const auto rows = [&] {
        std::string out;
        for (uint64_t f = 0; f < 5; ++f) {
            for (const auto& d : at(f, 10)) out += sim::toPointRcnnRow(d);
        }
        return out;
    };
    EXPECT_FALSE(rows().empty());
    EXPECT_EQ(rows(), rows());
}

TEST(FalseDetections, LeaveTheOtherRowsAloneAndTheBytesForAnyThreads) {
    const auto dir = djpete_test::scratch("sim_false");
    const auto rows = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> words{
            "--out", (dir / name).string(), "--frames",  "0:3", "--size", "310x94", "--seed",
            "2",     "--no-scans",          "--no-color"};
        words.insert(words.end(), more.begin(), more.end());
        simulate(words);
        return textOf(dir / name / "detections.txt");
    };
    const std::string none = rows("none", {"--threads", "1"});
    const std::string one = rows("one", {"--detection-false", "0.5", "--threads", "1"});
    const std::string two = rows("two", {"--detection-false", "0.5", "--threads", "2"});
    EXPECT_EQ(one, two);
    EXPECT_GT(one.size(), none.size());
    std::istringstream in(none);
    for (std::string line; std::getline(in, line);) EXPECT_NE(one.find(line), std::string::npos);
}

TEST(FewFeatures, FogHidesTheDistanceAndPlainStreetsHaveNoTexture) {
    /// Median step between neighbours in the image of a camera without noise, without actors.
    sim::CameraModel quiet;
    quiet.shotNoise = quiet.readNoise = 0;
    const auto contrast = [&](double visibility_m, bool plain, double beyond_m) {
        auto o = Scene::options(2);
        o.visibility_m = visibility_m;
        o.plain = plain;
        const sim::World world(o);
        sim::Renderer renderer(world, 2, quiet);
        const auto image =
            renderer.renderCamera(5, sim::rigCamera(310, 94), sim::T_vehicle_camera(), 0);
        std::vector<int> steps;
        for (std::size_t i = 1; i < image.rgb.size(); ++i) {
            if (image.actorId[i] != 0 || image.actorId[i - 1] != 0) continue;
            if (image.depth_m[i] <= 0 || static_cast<double>(image.depth_m[i]) < beyond_m) continue;
            steps.push_back(std::abs(image.rgb[i][1] - image.rgb[i - 1][1]));
        }
        EXPECT_GT(steps.size(), 100U);
        std::nth_element(steps.begin(), steps.begin() + long(steps.size() / 2), steps.end());
        return steps[steps.size() / 2];
    };
    const int clear = contrast(0, false, 0), clearFar = contrast(0, false, 25);
    std::cout << "median step: " << clear << ", far " << clearFar << "\n";
    EXPECT_LT(3 * contrast(20, false, 25), clearFar);
    EXPECT_LT(2 * contrast(0, true, 0), clear);
}
