#include "djpete/pipeline/stage_times.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace djpete::pipeline {
namespace {

TEST(StageTimes, BooksEveryCallAlsoThoseThatThrow) {
    StageTable table;
    EXPECT_EQ(measured(table, "work", [] { return 7; }), 7);
    EXPECT_THROW(measured(table, "work", []() -> int { throw std::runtime_error("x"); }),
                 std::runtime_error);
    EXPECT_EQ(table.at("work").count(), 2U);
    EXPECT_GE(table.at("work").total_ms(), 0.0);
}

}  // namespace
}  // namespace djpete::pipeline
