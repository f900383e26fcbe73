/// Masks, depth, types and motion of objects in the written drive.
#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "small_drive.h"

using namespace small_drive;
using testing::HasSubstr;

namespace {

struct ObjectRow {
    uint64_t frame = 0;
    uint32_t id = 0;
    std::string type;
    bool moving = false;
    SE3 T_world_obj;
    Vec3 velocity_mps = Vec3::Zero();
    double turnRate_radps = 0;
};

std::vector<ObjectRow> objectsOf(const fs::path& dir) {
    std::vector<ObjectRow> out;
    std::istringstream in(textOf(dir / "objects.txt"));
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        ObjectRow r;
        words >> r.frame >> r.id >> r.type >> r.moving;
        Eigen::Matrix<double, 3, 4> m;
        for (int i = 0; i < 12; ++i) words >> m(i / 4, i % 4);
        for (int i = 0; i < 3; ++i) words >> r.velocity_mps[i];
        words >> r.turnRate_radps;
        EXPECT_TRUE(words && words.peek() == EOF) << line;
        r.T_world_obj = SE3(m.leftCols<3>(), m.col(3));
        out.push_back(r);
    }
    return out;
}

/// Three frames with depth of the last two.
const fs::path& drive() {
    static const fs::path dir = [] {
        const auto d = djpete_test::scratch("sim_truth_files");
        simulate({"--out", d.string(), "--frames", "0:3", "--size", "310x94", "--seed", "2",
                  "--no-scans", "--no-color", "--depth", "1:2,2:3"});
        return d;
    }();
    return dir;
}

sim::Label labelOf(const std::string& type, uint32_t id) {
    sim::Label l;
    l.type = type;
    l.trackId = id;
    return l;
}

}  // namespace

TEST(SimulatedTruth, ObjectsAreWhereTheWorldHasThem) {
    const sim::World world([] {
        sim::WorldOptions o;
        o.seed = 2;
        o.frames = 3;
        return o;
    }());
    std::map<uint32_t, sim::Actor> actors;
    for (const auto& a : world.actors()) actors[a.id] = a;
    // World of the files: the vehicle at frame 0.
    const SE3 T_first_world = world.T_world_vehicle(0).inverse();
    int moving = 0;
    std::map<uint64_t, int> perFrame;
    for (const auto& r : objectsOf(drive())) {
        const auto& a = actors.at(r.id);
        EXPECT_EQ(r.type, sim::nameOf(a.type));
        EXPECT_EQ(r.moving, a.moving);
        const SE3 error = r.T_world_obj.inverse() * T_first_world * world.T_world_obj(a, r.frame);
        EXPECT_LT(error.translation().norm(), 1e-9);
        EXPECT_LT(error.angle_rad(), 1e-9);
        if (!a.moving) {
            EXPECT_EQ(r.velocity_mps.norm(), 0);
            EXPECT_EQ(r.turnRate_radps, 0);
        } else if (r.frame == 1 && world.present(a, 0) && world.present(a, 2)) {
            const Vec3 way = T_first_world.rotation() * (world.T_world_obj(a, 2).translation() -
                                                         world.T_world_obj(a, 0).translation());
            EXPECT_LT((r.velocity_mps - way / 0.2).norm(), 1e-5);
            // Who moves looks where it goes.
            EXPECT_GT(way.dot(r.T_world_obj.rotation().col(0)), 0.9 * way.norm());
            ++moving;
        }
        ++perFrame[r.frame];
    }
    EXPECT_GT(moving, 1);
    for (uint64_t f = 0; f < 3; ++f) EXPECT_GT(perFrame[f], 10);
}

TEST(SimulatedTruth, EveryLabelHasAnObjectRow) {
    std::set<std::pair<uint64_t, uint32_t>> objects;
    for (const auto& r : objectsOf(drive())) objects.insert({r.frame, r.id});
    std::istringstream in(textOf(drive() / "label_02.txt"));
    int labels = 0;
    for (std::string line; std::getline(in, line); ++labels) {
        std::istringstream words(line);
        std::pair<uint64_t, uint32_t> key;
        words >> key.first >> key.second;
        EXPECT_EQ(objects.count(key), 1U) << line;
    }
    EXPECT_GT(labels, 10);
}

TEST(SimulatedTruth, DepthOfTheChosenFramesIsTheRenderers) {
    EXPECT_FALSE(fs::exists(drive() / "depth" / "000000.png"));
    sim::WorldOptions o;
    o.seed = 2;
    o.frames = 3;
    const sim::World world(o);
    sim::Renderer renderer(world, 2);
    for (uint64_t f : {1U, 2U}) {
        const auto image =
            renderer.renderCamera(f, sim::rigCamera(310, 94), sim::T_vehicle_camera(), 0);
        const auto file = drive() / "depth" / (f == 1 ? "000001.png" : "000002.png");
        const cv::Mat depth = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
        ASSERT_EQ(depth.type(), CV_16UC1);
        ASSERT_EQ(depth.size(), cv::Size(310, 94));
        int known = 0;
        for (int v = 0; v < depth.rows; ++v) {
            for (int u = 0; u < depth.cols; ++u) {
                const double truth = static_cast<double>(image.depth_m[image.index(u, v)]);
                const double stated = depth.at<uint16_t>(v, u) / 256.0;
                if (truth < 255) {
                    EXPECT_NEAR(stated, truth, 0.5 / 256 + 1e-4);
                }
                known += stated > 0 ? 1 : 0;
            }
        }
        EXPECT_GT(known, 310 * 94 / 3);
    }
}

TEST(SimulatedTruth, MasksShowTheLabelled) {
    const cv::Mat ids =
        cv::imread((drive() / "instances" / "000001.png").string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(ids.type(), CV_16UC1);
    std::set<int> shown, labelled;
    for (int v = 0; v < ids.rows; ++v) {
        for (int u = 0; u < ids.cols; ++u) shown.insert(ids.at<uint16_t>(v, u));
    }
    std::istringstream in(textOf(drive() / "label_02.txt"));
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        int frame = 0, id = 0;
        std::string type;
        words >> frame >> id >> type;
        if (frame == 1 && type != "Cyclist")
            labelled.insert((type == "Pedestrian" ? 2000 : 1000) + id);
    }
    shown.erase(0);
    shown.erase(10000);
    EXPECT_EQ(shown, labelled);
    EXPECT_GT(shown.size(), 2U);
}

TEST(SimulatedTruth, ActorsBeyondTheLastTrackIdAreIgnoredAndNothingFails) {
    sim::DriveOptions options;
    options.world.frames = options.end = 1;
    options.world.seed = 2;
    options.width_px = 310, options.height_px = 94;
    options.scans = options.colour = false;
    options.labels.maxTrackId = 3;  // a drive of kilometres in small
    const auto dir = djpete_test::scratch("sim_many_ids");
    sim::writeDrive(options, dir, nullptr);
    int beyond = 0;
    for (const auto& r : objectsOf(dir)) beyond += r.id > 3 ? 1 : 0;
    EXPECT_GT(beyond, 0);
    std::istringstream in(textOf(dir / "label_02.txt"));
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        int number = 0, id = 0;
        words >> number >> id;
        EXPECT_LE(id, 3);
    }
    const cv::Mat ids =
        cv::imread((dir / "instances" / "000000.png").string(), cv::IMREAD_UNCHANGED);
    int ignored = 0;
    for (int v = 0; v < ids.rows; ++v) {
        for (int u = 0; u < ids.cols; ++u) {
            const int id = ids.at<uint16_t>(v, u);
            EXPECT_TRUE(id == 10000 || id % 1000 <= 3) << id;
            ignored += id == 10000 ? 1 : 0;
        }
    }
    EXPECT_GT(ignored, 100);
}

TEST(SimulatedTruth, DetectionsNameTypesAsPointRcnnDoes) {
    const std::vector<std::pair<std::string, std::string>> expected{{"Pedestrian", "0,1,"},
                                                                    {"Car", "0,2,"},
                                                                    {"Van", "0,2,"},
                                                                    {"Truck", "0,2,"},
                                                                    {"Cyclist", "0,3,"}};
    for (const auto& [type, begin] : expected) {
        const std::string row = sim::toPointRcnnRow({labelOf(type, 5), 1});
        EXPECT_EQ(row.rfind(begin, 0), 0U) << type << ": " << row;
    }
}

TEST(SimulatedTruth, ExposureHasARowPerFrame) {
    const auto rows = numbersOf(drive() / "exposure.txt");
    ASSERT_EQ(rows.size(), 3U);
    for (std::size_t f = 0; f < 3; ++f) {
        ASSERT_EQ(rows[f].size(), 3U);
        EXPECT_EQ(rows[f][0], static_cast<double>(f));
        EXPECT_GT(rows[f][1], 0);
        EXPECT_GT(rows[f][2], 0);
    }
}
