#include "engine/scene/motion/path_editing.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

Keyframe view_at(double time, double place) {
    return {time, {place, 0.0, 10.0}, {place, 1.0, 10.0}};
}

CameraPath three_keys() {
    return CameraPath::create({view_at(1.0, 10.0), view_at(2.0, 20.0), view_at(4.0, 40.0)}).value();
}

std::vector<double> times_of(const CameraPath& path) {
    std::vector<double> times;
    for (const Keyframe& key : path.keys()) {
        times.push_back(key.time);
    }
    return times;
}

TEST(PathEditing, InsertedKeyIsThereAndReplacesTheOneAtItsTime) {
    const auto longer = with_key(three_keys(), view_at(3.0, 99.0));
    ASSERT_TRUE(longer);
    EXPECT_THAT(times_of(*longer), testing::ElementsAre(1.0, 2.0, 3.0, 4.0));
    EXPECT_EQ(longer->at(3.0).eye.x, 99.0);
    const auto replaced = with_key(three_keys(), view_at(2.0, 99.0));
    ASSERT_TRUE(replaced);
    EXPECT_THAT(times_of(*replaced), testing::ElementsAre(1.0, 2.0, 4.0));
    EXPECT_EQ(replaced->at(2.0).eye.x, 99.0);
    EXPECT_FALSE(with_key(three_keys(), view_at(std::nan(""), 1.0)));
    EXPECT_FALSE(with_key(three_keys(), view_at(1.0, HUGE_VAL)));
}

TEST(PathEditing, RemovedKeyIsGoneButOneRemains) {
    auto path = without_key(three_keys(), 1);
    ASSERT_TRUE(path);
    EXPECT_THAT(times_of(*path), testing::ElementsAre(1.0, 4.0));
    EXPECT_FALSE(without_key(*path, 2));
    path = without_key(*path, 0);
    ASSERT_TRUE(path);
    EXPECT_FALSE(without_key(*path, 0)) << "the only one";
}

TEST(PathEditing, MovedKeyKeepsItsTimeAndRetimedKeyItsView) {
    const auto moved = with_moved_key(three_keys(), 1, view_at(77.0, 5.0));
    ASSERT_TRUE(moved);
    EXPECT_THAT(times_of(*moved), testing::ElementsAre(1.0, 2.0, 4.0));
    EXPECT_EQ(moved->at(2.0).eye.x, 5.0);
    const auto retimed = with_retimed_key(three_keys(), 0, 5.0); // beyond its neighbours
    ASSERT_TRUE(retimed);
    EXPECT_THAT(times_of(*retimed), testing::ElementsAre(2.0, 4.0, 5.0));
    EXPECT_EQ(retimed->at(5.0).eye.x, 10.0);
    EXPECT_FALSE(with_retimed_key(three_keys(), 0, 2.0)) << "another key is there";
    EXPECT_TRUE(with_retimed_key(three_keys(), 1, 2.0)) << "its own time";
    EXPECT_FALSE(with_retimed_key(three_keys(), 0, std::nan("")));
    EXPECT_FALSE(with_retimed_key(three_keys(), 3, 9.0));
    EXPECT_FALSE(with_moved_key(three_keys(), 3, view_at(0.0, 1.0)));
}

TEST(PathEditing, DurationStretchesAllTimes) {
    const auto path = with_duration(three_keys(), 6.0);
    ASSERT_TRUE(path);
    EXPECT_THAT(times_of(*path), testing::ElementsAre(1.0, 3.0, 7.0));
    for (const double seconds : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
        EXPECT_FALSE(with_duration(three_keys(), seconds)) << seconds;
    }
    EXPECT_FALSE(with_duration(CameraPath::create({view_at(0.0, 1.0)}).value(), 1.0));
}

TEST(PathEditing, NearestKeyIsThatOfTheTime) {
    EXPECT_EQ(nearest_key(three_keys(), -5.0), 0U);
    EXPECT_EQ(nearest_key(three_keys(), 1.5), 0U);
    EXPECT_EQ(nearest_key(three_keys(), 2.9), 1U);
    EXPECT_EQ(nearest_key(three_keys(), 99.0), 2U);
    EXPECT_EQ(nearest_key(three_keys(), std::nan("")), 0U);
}

TEST(PathRecorder, RecordsWhatWasFlown) {
    PathRecorder recorder;
    EXPECT_FALSE(recorder.path());
    for (int i = 0; i <= 600; ++i) {
        recorder.add(view_at(i / 60.0, 3.0 * i / 60.0));
    }
    recorder.add(view_at(3.0, 500.0)); // backwards
    recorder.add(view_at(std::nan(""), 500.0));
    const auto path = recorder.path();
    ASSERT_TRUE(path);
    EXPECT_EQ(path->end(), 10.0);
    EXPECT_LE(path->keys().size(), 42U);
    for (double time = 0.0; time <= 10.0; time += 0.01) {
        // A path starts and ends at rest: there it is at most the way of one interval off.
        const bool is_end = time < 0.3 || time > 9.7;
        ASSERT_NEAR(path->at(time).eye.x, 3.0 * time, is_end ? 3.0 * 0.3 : 1e-6) << time;
    }
}

TEST(PathRecorder, RestIsTwoKeysAndAPathStandsStillThere) {
    PathRecorder recorder;
    for (int i = 0; i <= 1200; ++i) {
        const double time = i / 60.0;
        recorder.add(view_at(time, time < 5.0 ? time : std::max(5.0, time - 10.0)));
    }
    const auto path = recorder.path();
    ASSERT_TRUE(path);
    EXPECT_LE(path->keys().size(), 46U);
    for (double time = 5.3; time < 15.0; time += 0.1) {
        ASSERT_NEAR(path->at(time).eye.x, 5.0, 0.02) << time;
    }
    EXPECT_NEAR(path->at(20.0).eye.x, 10.0, 1e-6);
}

TEST(PathRecorder, OneViewIsAPathOfOneKey) {
    PathRecorder recorder;
    recorder.add(view_at(0.0, 1.0));
    ASSERT_TRUE(recorder.path());
    EXPECT_EQ(recorder.path()->keys().size(), 1U);
}

} // namespace
} // namespace reljef::scene
