/// The noisy detector errs as much as it was told to.
#include "small_drive.h"

using namespace small_drive;

namespace {

/// Made-up labels of many frames.
std::vector<sim::Label> manyLabels() {
    std::vector<sim::Label> out;
    for (uint64_t f = 0; f < 200; ++f) {
        for (uint32_t id = 1; id <= 20; ++id) {
            sim::Label l;
            l.frame = f;
            l.trackId = id;
            l.type = "Car";
            l.length_m = 4;
            l.width_m = 1.8;
            l.height_m = 1.5;
            l.x_m = -10.0 + id;
            l.y_m = 1.6;
            l.z_m = 5.0 + 2.0 * id;
            l.rotationY_rad = -3.1 + 0.3 * id;
            out.push_back(l);
        }
    }
    return out;
}

}  // namespace

TEST(SimulatedDetections, HaveTheSigmasAskedForAndNoBias) {
    const auto labels = manyLabels();
    sim::DetectorNoise noise;
    noise.sigma_m = 0.3;
    noise.sigma_rad = 5 * M_PI / 180;
    const auto detections = sim::makeDetections(labels, noise, 11);
    ASSERT_EQ(detections.size(), labels.size());
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const auto &d = detections[i].label, &l = labels[i];
        const Eigen::Vector4d e(d.x_m - l.x_m, d.y_m - l.y_m, d.z_m - l.z_m,
                                std::remainder(d.rotationY_rad - l.rotationY_rad, 2 * M_PI));
        sum += e;
        squares += e * e.transpose();
        EXPECT_LE(std::abs(d.rotationY_rad), M_PI);
        EXPECT_GT(detections[i].score, 0);
        EXPECT_LE(detections[i].score, 1);
        EXPECT_EQ(d.length_m, l.length_m);
    }
    const double n = static_cast<double>(labels.size());
    const Eigen::Vector4d sigma(0.3, 0.3, 0.3, 5 * M_PI / 180);
    for (int i = 0; i < 4; ++i) {
        EXPECT_LT(std::abs(sum[i] / n), 4 * sigma[i] / std::sqrt(n)) << i;
        // Four sigmas of the estimate of a sigma: 4 / sqrt(2 n).
        EXPECT_NEAR(std::sqrt(squares(i, i) / n) / sigma[i], 1.0, 4 / std::sqrt(2 * n)) << i;
        for (int j = 0; j < i; ++j) {
            EXPECT_LT(std::abs(squares(i, j) / n), 4 * sigma[i] * sigma[j] / std::sqrt(n));
        }
    }
}

TEST(SimulatedDetections, MissAsOftenAsAskedAndAreExactWithoutNoise) {
    const auto labels = manyLabels();
    sim::DetectorNoise noise;
    noise.missRate = 0.25;
    const auto n = static_cast<double>(labels.size());
    EXPECT_NEAR(static_cast<double>(sim::makeDetections(labels, noise, 3).size()) / n, 0.75,
                4 * std::sqrt(0.25 * 0.75 / n));
    noise = {0, 0, 0};
    const auto exact = sim::makeDetections(labels, noise, 3);
    ASSERT_EQ(exact.size(), labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
        EXPECT_EQ(exact[i].label.x_m, labels[i].x_m);
        EXPECT_NEAR(
            std::remainder(exact[i].label.rotationY_rad - labels[i].rotationY_rad, 2 * M_PI), 0,
            1e-12);
    }
}

TEST(SimulatedDetections, RepeatForASeedAndDifferForAnother) {
    const auto labels = manyLabels();
    const auto rows = [&](uint32_t seed) {
        std::string out;
        for (const auto& d : sim::makeDetections(labels, {}, seed)) out += sim::toPointRcnnRow(d);
        return out;
    };
    EXPECT_EQ(rows(1), rows(1));
    EXPECT_NE(rows(1), rows(2));
}
