#include <gmock/gmock.h>

#include "djpete/places/place_database.h"
#include "synthetic_place.h"

namespace djpete::places {
namespace {

using djpete_test::look;
using djpete_test::SightOptions;
using djpete_test::SyntheticPlace;
using geometry::SE3;

const auto kAll = [](map::KeyframeId) { return true; };

SE3 ahead(double metres) { return {geometry::Mat3::Identity(), {0, 0, metres}}; }

/// Places 0..9, each seen twice, one metre apart: ids 100 * place + 0, 1.
PlaceDatabase tenPlaces(const DatabaseOptions& options = {}) {
    PlaceDatabase database(options);
    for (uint64_t place = 0; place < 10; ++place) {
        const SyntheticPlace points(place + 1);
        database.add(look(points, ahead(0), 100 * place));
        database.add(look(points, ahead(1), 100 * place + 1));
    }
    return database;
}

DatabaseOptions pairsOfNeighbours() {
    DatabaseOptions options;
    options.neighbours = 1;
    return options;
}

TEST(PlaceDatabase, aPlaceIsFoundAmongOthers) {
    const PlaceDatabase database = tenPlaces(pairsOfNeighbours());
    for (uint64_t place = 0; place < 10; ++place) {
        const auto view = look(SyntheticPlace(place + 1), ahead(0.5), 5000);
        const auto found = database.query(view, 5, kAll);
        ASSERT_FALSE(found.empty());
        EXPECT_EQ(found[0].id.value / 100, place);
        // The second is another place and far behind.
        if (found.size() > 1) {
            EXPECT_NE(found[1].id.value / 100, place);
            EXPECT_LT(found[1].score, 0.2 * found[0].score);
        }
    }
}

TEST(PlaceDatabase, onlyAllowedViewsAnswerAndTheirNeighboursStepIn) {
    const PlaceDatabase database = tenPlaces(pairsOfNeighbours());
    const auto view = look(SyntheticPlace(4), ahead(0), 5000);
    const auto best = database.query(view, 1, kAll).at(0).id;
    EXPECT_EQ(best.value / 100, 3U);
    const auto other = database.query(view, 1, [&](auto id) { return id != best; });
    EXPECT_EQ(other.at(0).id.value, best.value == 300 ? 301U : 300U);
    for (const auto& c : database.query(view, 9, [](auto id) { return id.value / 100 != 3; })) {
        EXPECT_NE(c.id.value / 100, 3U);
    }
    EXPECT_TRUE(database.query(view, 9, [](auto) { return false; }).empty());
}

TEST(PlaceDatabase, bestFirstAndNoMoreThanWanted) {
    DatabaseOptions single;
    single.neighbours = 0;
    const PlaceDatabase database = tenPlaces(single);
    const auto view = look(SyntheticPlace(4), ahead(0), 5000);
    const auto found = database.query(view, 2, kAll);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_GT(found[0].score, found[1].score);
    EXPECT_EQ(found[0].id.value / 100, 3U);
    EXPECT_EQ(found[1].id.value / 100, 3U);
    EXPECT_TRUE(database.query(view, 0, kAll).empty());
}

TEST(PlaceDatabase, nothingIsFoundByNothing) {
    EXPECT_TRUE(PlaceDatabase().query(look(SyntheticPlace(1), ahead(0), 1), 5, kAll).empty());
    const PlaceDatabase database = tenPlaces();
    PlaceView bare;
    EXPECT_TRUE(database.query(bare, 5, kAll).empty());
    bare.corners.resize(10);  // a dark image
    EXPECT_TRUE(database.query(bare, 5, kAll).empty());
}

TEST(PlaceDatabase, keepsTheViews) {
    const PlaceDatabase database = tenPlaces();
    EXPECT_EQ(database.size(), 20U);
    ASSERT_NE(database.find({301}), nullptr);
    EXPECT_EQ(database.find({301})->id.value, 301U);
    EXPECT_EQ(database.find({302}), nullptr);
    EXPECT_EQ(database.find({9999}), nullptr);
}

TEST(PlaceDatabase, idsMustRise) {
    PlaceDatabase database = tenPlaces();
    EXPECT_ANY_THROW(database.add(look(SyntheticPlace(1), ahead(0), 901)));
    database.add(look(SyntheticPlace(1), ahead(0), 902));
    EXPECT_EQ(database.size(), 21U);
}

TEST(PlaceDatabase, theSameDriveGivesTheSameAnswers) {
    const PlaceDatabase one = tenPlaces(), two = tenPlaces();
    const auto view = look(SyntheticPlace(7), ahead(2), 5000);
    const auto a = one.query(view, 9, kAll), b = two.query(view, 9, kAll);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].id, b[i].id);
        EXPECT_EQ(a[i].score, b[i].score);
    }
}

TEST(PlaceDatabase, holdsMoreCornersThanItIndexes) {
    PlaceDatabase database;
    auto view = look(SyntheticPlace(1, 9000), ahead(0), 1);
    ASSERT_GT(view.corners.size(), 3000U);
    database.add(view);
    const auto found = database.query(view, 1, kAll);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(database.find({1})->corners.size(), view.corners.size());
}

}  // namespace
}  // namespace djpete::places
