/// Registers and plain C++ give the same bytes.
#include "simd_test.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "patch_alignment.h"
#include "synthetic_street.h"

using namespace djpete_test;

TEST(Simd, RegistersAndPlainCodeGiveTheSameBytes) {
    using namespace djpete::frontend;
    const SyntheticStreet street;
    const auto left = street.render(SE3());
    const auto right = street.render(SE3(Eigen::Matrix3d::Identity(), Vec3(0.05, 0.01, 0.2)));
    std::mt19937_64 random(7);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() >> 11) / 9007199254740992.0;
    };
    int found = 0;
    for (int i = 0; i < 400; ++i) {
        PatchTask task;
        task.from = left.asCvMatRef();
        task.to = right.asCvMatRef();
        task.u_px = uniform(2, 637);
        task.v_px = uniform(2, 237);
        task.startU_px = task.u_px + uniform(-4, 4);
        task.startV_px = task.v_px + uniform(-2, 2);
        task.stepsPerPixel << uniform(0.8, 1.2), uniform(-0.1, 0.1), uniform(-0.1, 0.1),
            uniform(0.8, 1.2);
        task.sheared = i % 2 == 0;
        const auto byRegisters = align<PatchTemplate, PlacePrior, PatchPlace>(task);
        const auto plain = alignScalar(task);
        EXPECT_EQ(0, std::memcmp(byRegisters.data(), plain.data(), sizeof(plain))) << "patch " << i;
        found += byRegisters[0] > 0 ? 1 : 0;
    }
    EXPECT_GT(found, 100);  // else little was compared
}
