/// A drive along given poses, with a map and the shapes of its objects.
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "small_drive.h"

using namespace small_drive;

TEST(SimulatedDriveAlongPoses, FollowsThemAndWritesMapAndShapes) {
    const auto dir = djpete_test::scratch("sim_along_poses");
    {
        // Around a wide bend to the right, seen from the camera (z ahead, x to the right).
        std::ofstream out(dir / "given.txt");
        for (int i = 0; i < 120; ++i) {
            const double a = 0.01 * i, r = 80;
            out << std::cos(a) << " 0 " << std::sin(a) << " " << r * (1 - std::cos(a))
                << " 0 1 0 0 " << -std::sin(a) << " 0 " << std::cos(a) << " " << r * std::sin(a)
                << "\n";
        }
    }
    const auto drive = dir / "drive";
    simulate({"--out", drive.string(), "--poses", (dir / "given.txt").string(), "--frames", "30:32",
              "--size", "310x94", "--no-color", "--map", "--meshes", "0.2"});
    const auto given = numbersOf(dir / "given.txt"), written = numbersOf(drive / "poses.txt");
    ASSERT_EQ(written.size(), 32U);  // rows from frame 0 on
    for (std::size_t row = 0; row < written.size(); ++row) {
        ASSERT_EQ(written[row].size(), 12U);
        for (std::size_t k = 0; k < 12; ++k)
            EXPECT_NEAR(written[row][k], given[row][k], k % 4 == 3 ? 0.02 : 1e-5)
                << "row " << row << ", number " << k;
    }
    const cv::Mat map = cv::imread((drive / "map.png").string());
    EXPECT_EQ(std::max(map.cols, map.rows), 1400);
    // A shape per labelled object, and no other.
    std::set<int> labelled, shapes;
    std::istringstream labels(textOf(drive / "label_02.txt"));
    for (std::string line; std::getline(labels, line);) {
        std::istringstream words(line);
        int frame = 0, id = 0;
        words >> frame >> id;
        labelled.insert(id);
    }
    for (const auto& e : fs::directory_iterator(drive / "objects")) {
        EXPECT_EQ(e.path().extension(), ".ply");
        EXPECT_EQ(textOf(e.path()).substr(0, 4), "ply\n");
        shapes.insert(std::stoi(e.path().stem().string()));
    }
    EXPECT_FALSE(labelled.empty());
    EXPECT_EQ(shapes, labelled);
}
