#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "djpete/io/ply_writer.h"
#include "djpete/obs/errors.h"
#include "small_map.h"

namespace {

using namespace djpete_test;

std::string contentOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

template <class T>
T valueAt(const std::string& bytes, std::size_t offset) {
    T out;
    std::memcpy(&out, bytes.data() + offset, sizeof(T));
    return out;
}

TEST(ObjectPly, HasColoursNormalsCountsAndSpread) {
    const TestFolder folder;
    const auto model = redModel(12);
    io::writeObjectPlys({{map::ObjectId{12}, model}}, folder / "objects");
    const std::string all = contentOf(folder / "objects/0012.ply");
    const std::string end = "end_header\n";
    const std::size_t body = all.find(end) + end.size();
    EXPECT_EQ(all.substr(0, body),
              "ply\nformat binary_little_endian 1.0\ncomment object 12 Car, frame obj, metres\n"
              "element vertex 400\nproperty float x\nproperty float y\nproperty float z\n"
              "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n"
              "property uchar green\nproperty uchar blue\nproperty uint count\n"
              "property float std\nend_header\n");
    constexpr std::size_t kRecord = 24 + 3 + 4 + 4;
    ASSERT_EQ(all.size() - body, 400 * kRecord);
    EXPECT_EQ(valueAt<uint8_t>(all, body + 24), 128);  // nobody saw point 0
    EXPECT_EQ(valueAt<uint32_t>(all, body + 27), 0U);
    const std::size_t last = body + 399 * kRecord;
    float x = 0, y = 0, z = 0;
    model.cloud->getPointFast(399, x, y, z);
    EXPECT_EQ(valueAt<float>(all, last), x);
    EXPECT_EQ(valueAt<float>(all, last + 8), z);
    EXPECT_EQ(valueAt<float>(all, last + 16), -1.0F);
    EXPECT_EQ(valueAt<uint8_t>(all, last + 24), 255);
    EXPECT_EQ(valueAt<uint8_t>(all, last + 25), 51);
    EXPECT_EQ(valueAt<uint8_t>(all, last + 26), 0);
    EXPECT_EQ(valueAt<uint32_t>(all, last + 27), 2U);
    EXPECT_NEAR(valueAt<float>(all, last + 31), 5 / std::sqrt(3.0), 1e-4);
}

TEST(PointsPly, HoldsPositionsAndColours) {
    const TestFolder folder;
    io::writePointsPly({{1, 2, 3, {4, 5, 6}}, {-1, 0.5F, 0, {255, 0, 128}}}, folder / "p.ply");
    const std::string all = contentOf(folder / "p.ply");
    const std::size_t body = all.find("end_header\n") + 11;
    EXPECT_THAT(all.substr(0, body), testing::HasSubstr("element vertex 2\n"));
    ASSERT_EQ(all.size() - body, 30U);
    EXPECT_EQ(valueAt<float>(all, body + 15), -1.0F);
    EXPECT_EQ(valueAt<uint8_t>(all, body + 15 + 14), 128);
}

TEST(ObjectPly, NamesTheFolderThatCannotBeMade) {
    EXPECT_THROW(io::writeObjectPlys({{map::ObjectId{1}, redModel(1)}}, "/proc/objects"),
                 obs::InputError);
    EXPECT_THROW(io::writePointsPly({}, "/nowhere/p.ply"), obs::InputError);
}

}  // namespace
