#include "djpete/backend/channel.h"

#include <gmock/gmock.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "djpete/backend/statistics.h"
#include "djpete/backend/worker.h"

namespace djpete::backend {
namespace {

TEST(Channel, keepsOrderBetweenThreads) {
    Channel<int> channel(2);
    std::thread producer([&] {
        for (int i = 0; i < 1000; ++i) channel.push(i);
        channel.close();
    });
    std::vector<int> got;
    while (const auto v = channel.pop()) got.push_back(*v);
    producer.join();
    ASSERT_EQ(got.size(), 1000U);
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(got[static_cast<std::size_t>(i)], i);
}

TEST(Channel, neverHoldsMoreThanItsCapacity) {
    Channel<int> channel(3);
    std::atomic<int> pushed{0};
    std::thread producer([&] {
        for (int i = 0; i < 10; ++i) {
            channel.push(i);
            ++pushed;
        }
    });
    for (int popped = 0; popped < 10; ++popped) {
        // What is pushed but not popped fits the channel, plus the one just handed over.
        EXPECT_LE(pushed - popped, 3 + 1);
        EXPECT_EQ(channel.pop(), popped);
    }
    producer.join();
}

TEST(Channel, closingWakesBothEnds) {
    Channel<int> channel(1);
    std::thread reader([&] { EXPECT_FALSE(channel.pop()); });
    channel.close();
    reader.join();
    EXPECT_FALSE(channel.push(1));

    Channel<int> full(1);
    full.push(1);
    std::thread writer([&] { EXPECT_FALSE(full.push(2)); });
    full.close();
    writer.join();
    EXPECT_EQ(full.pop(), 1);
    EXPECT_FALSE(full.pop());
}

TEST(Channel, tryPushNeverWaits) {
    Channel<int> channel(2);
    EXPECT_TRUE(channel.tryPush(1));
    EXPECT_TRUE(channel.tryPush(2));
    EXPECT_FALSE(channel.tryPush(3));
    EXPECT_EQ(channel.pop(), 1);
    EXPECT_TRUE(channel.tryPush(4));
    channel.close();
    EXPECT_EQ(channel.pop(), 2);
    EXPECT_FALSE(channel.tryPush(5));
    EXPECT_EQ(channel.pop(), 4);
    EXPECT_FALSE(channel.pop());
}

TEST(Channel, tryPushWakesAReader) {
    Channel<int> channel(1);
    std::thread reader([&] { EXPECT_EQ(channel.pop(), 7); });
    EXPECT_TRUE(channel.tryPush(7));
    reader.join();
}

class WorkerModes : public testing::TestWithParam<Mode> {};

TEST_P(WorkerModes, resultsComeInOrder) {
    Worker<int, int> worker([](const int& x) { return x * x; }, GetParam());
    worker.issue(3);
    worker.issue(4);
    EXPECT_EQ(worker.underWay(), 2U);
    EXPECT_EQ(worker.take(), 9);
    EXPECT_EQ(worker.take(), 16);
    EXPECT_THROW(worker.take(), std::logic_error);
}

TEST_P(WorkerModes, anExceptionComesBackInPlaceOfItsResult) {
    Worker<int, int> worker(
        [](const int& x) {
            if (x < 0) throw std::runtime_error("negative");
            return x;
        },
        GetParam());
    worker.issue(1);
    worker.issue(-1);
    worker.issue(2);
    EXPECT_EQ(worker.take(), 1);
    EXPECT_THROW(worker.take(), std::runtime_error);
    EXPECT_EQ(worker.take(), 2);
}

TEST_P(WorkerModes, mayBeDestroyedWithJobsUnderWay) {
    for (int i = 0; i < 20; ++i) {
        Worker<int, int> worker([](const int& x) { return x; }, GetParam());
        worker.issue(1);
        worker.issue(2);
        worker.issue(3);
    }
}

INSTANTIATE_TEST_SUITE_P(Modes, WorkerModes, testing::Values(Mode::Lockstep, Mode::Threaded));

TEST(StageTimes, percentiles) {
    StageTimes times;
    EXPECT_EQ(times.p50_ms(), 0);
    for (int i = 100; i >= 1; --i) times.add(i);
    EXPECT_EQ(times.count(), 100U);
    EXPECT_EQ(times.p50_ms(), 50);
    EXPECT_EQ(times.p95_ms(), 95);
    EXPECT_EQ(times.max_ms(), 100);
    EXPECT_EQ(times.total_ms(), 5050);
}

}  // namespace
}  // namespace djpete::backend
