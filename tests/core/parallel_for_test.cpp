#include "engine/core/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <latch>
#include <mutex>
#include <new>
#include <set>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef {
namespace {

using testing::Each;

ParallelOptions with_threads(unsigned threads) {
    ParallelOptions options;
    options.threads = threads;
    return options;
}

TEST(WorkerPool, ThreadCountIsTheRequestedOrTheMachines) {
    EXPECT_EQ(thread_count(3), 3U);
    EXPECT_GE(thread_count(0), 1U);
}

TEST(WorkerPool, EveryIndexIsCalledOnce) {
    for (const unsigned threads : {0U, 1U, 2U, 7U, 16U}) {
        for (const int count : {0, 1, 2, 15, 1000, 20000}) {
            std::vector<std::atomic<int>> calls(static_cast<std::size_t>(count));
            EXPECT_TRUE(parallel_for(
                count, [&](int index) { ++calls[static_cast<std::size_t>(index)]; },
                with_threads(threads)));
            std::vector<int> seen(calls.begin(), calls.end());
            EXPECT_THAT(seen, Each(1)) << threads << " threads, " << count << " items";
        }
    }
}

TEST(WorkerPool, NegativeCountCallsNothing) {
    EXPECT_TRUE(parallel_for(-5, [](int) { FAIL(); }));
}

TEST(WorkerPool, OneThreadIsTheCallersAndKeepsTheOrder) {
    std::vector<int> order;
    const auto caller = std::this_thread::get_id();
    parallel_for(
        100,
        [&](int index) {
            EXPECT_EQ(std::this_thread::get_id(), caller);
            order.push_back(index);
        },
        with_threads(1));
    EXPECT_EQ(order.size(), 100U);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(WorkerPool, ItemsRunAtTheSameTimeOnAsManyThreadsAsAskedFor) {
    constexpr int threads = 4;
    std::latch all_are_here(threads);
    std::atomic<int> met{0};
    parallel_for(
        threads,
        [&](int) {
            all_are_here.count_down();
            const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
            while (!all_are_here.try_wait() && std::chrono::steady_clock::now() < deadline) {
                std::this_thread::yield();
            }
            met += all_are_here.try_wait() ? 1 : 0;
        },
        with_threads(threads));
    EXPECT_EQ(met.load(), threads);
}

TEST(WorkerPool, NoMoreThreadsThanItems) {
    std::mutex mutex;
    std::set<std::thread::id> threads;
    parallel_for(
        3,
        [&](int) {
            const std::lock_guard lock(mutex);
            threads.insert(std::this_thread::get_id());
        },
        with_threads(1000000));
    EXPECT_LE(threads.size(), 3U);
}

TEST(WorkerPool, ProgressGrowsToOneWithOneCallAtATime) {
    for (const unsigned threads : {1U, 4U}) {
        std::vector<double> told;
        std::atomic<int> inside{0};
        ParallelOptions options = with_threads(threads);
        options.progress = [&](double fraction) {
            EXPECT_EQ(++inside, 1);
            told.push_back(fraction);
            --inside;
        };
        parallel_for(
            500, [](int) {}, options);
        ASSERT_EQ(told.size(), 500U);
        EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
        EXPECT_GT(told.front(), 0.0);
        EXPECT_EQ(told.back(), 1.0);
    }
}

TEST(WorkerPool, AfterAStopNoItemBegins) {
    for (const unsigned threads : {1U, 4U}) {
        std::stop_source source;
        std::atomic<unsigned> begun_after{0};
        ParallelOptions options = with_threads(threads);
        options.stop = source.get_token();
        const bool finished = parallel_for(
            1000000,
            [&](int index) {
                begun_after += source.stop_requested() ? 1U : 0U;
                if (index == 100) {
                    source.request_stop();
                }
            },
            options);
        EXPECT_FALSE(finished);
        EXPECT_LT(begun_after.load(), threads) << "those that had been let in already";
    }
}

TEST(WorkerPool, WithoutMemoryTheCallerGetsTheExceptionAndNoItemBegins) {
    for (const unsigned threads : {1U, 4U}) {
        std::atomic<unsigned> begun{0};
        EXPECT_THROW(parallel_for(
                         1000000,
                         [&](int) {
                             ++begun;
                             throw std::bad_alloc();
                         },
                         with_threads(threads)),
                     std::bad_alloc);
        EXPECT_LE(begun.load(), threads);
    }
}

TEST(WorkerPool, StoppedBeforeItBeginsDoesNothing) {
    std::stop_source source;
    source.request_stop();
    ParallelOptions options;
    options.stop = source.get_token();
    EXPECT_FALSE(parallel_for(
        10, [](int) { FAIL(); }, options));
}

TEST(WorkerPool, StopAfterTheLastItemIsStillFinished) {
    std::stop_source source;
    ParallelOptions options = with_threads(1);
    options.stop = source.get_token();
    EXPECT_TRUE(parallel_for(
        10,
        [&](int index) {
            if (index == 9) {
                source.request_stop();
            }
        },
        options));
}

} // namespace
} // namespace reljef
