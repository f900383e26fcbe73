#include "hamming.h"

#include <gmock/gmock.h>

#include "synthetic_place.h"

namespace djpete::places {
namespace {

obs::Descriptor random(djpete_test::Dice& dice) {
    return {dice.word(), dice.word(), dice.word(), dice.word()};
}

TEST(Hamming, countsEveryBit) {
    obs::Descriptor a{}, b{};
    EXPECT_EQ(hammingPortable(a, b), 0U);
    for (unsigned bit = 0; bit < 256; ++bit) {
        b[bit / 64] |= uint64_t{1} << (bit % 64);
        EXPECT_EQ(hammingPortable(a, b), bit + 1);
        EXPECT_EQ(hammingFunction()(a, b), bit + 1);
    }
}

TEST(Hamming, theProcessorsBitCountGivesTheSame) {
    djpete_test::Dice dice(5);
    std::vector<obs::Descriptor> from, to;
    for (int i = 0; i < 200; ++i) from.push_back(random(dice));
    for (int i = 0; i < 150; ++i) to.push_back(random(dice));
    to[100] = to[40];  // of equals, the first counts
    from[7] = to[40];
    const auto fast = nearest(from, to), portable = nearestPortable(from, to);
    ASSERT_EQ(fast.size(), from.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
        EXPECT_EQ(fast[i].best, portable[i].best);
        EXPECT_EQ(fast[i].second, portable[i].second);
        EXPECT_EQ(fast[i].index, portable[i].index);
        EXPECT_EQ(hammingFunction()(from[i], to[0]), hammingPortable(from[i], to[0]));
    }
    EXPECT_EQ(fast[7].index, 40U);
    EXPECT_EQ(fast[7].best, 0U);
    EXPECT_EQ(fast[7].second, 0U);
}

TEST(Hamming, nothingIsNearestAmongNone) {
    djpete_test::Dice dice(5);
    const auto found = nearest({random(dice)}, {});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].best, Nearest::kNone);
}

}  // namespace
}  // namespace djpete::places
