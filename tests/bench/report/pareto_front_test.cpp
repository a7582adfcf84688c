#include "bench/report/pareto_front.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/report/made_results.h"

namespace reljef::bench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Row row_at(const std::string& label, double ratio, double rms_px) {
    Row row = test::made_results().rows[0];
    row.setting.label = label;
    row.timing = test::made_timing(2.0 * ratio, ratio);
    row.timing.noise_floor = 0.0;
    row.error = test::made_error(rms_px);
    return row;
}

std::vector<std::string> dominated_of(const Front& front) {
    std::vector<std::string> pairs;
    for (const Front::Dominated& setting : front.dominated) {
        pairs.push_back(setting.label + "<" + setting.by);
    }
    return pairs;
}

TEST(ParetoFront, holds_what_nothing_beats_and_names_what_beats_the_rest) {
    const std::vector<Row> rows{row_at("slow", 10.0, 1.0),  row_at("texture", 1.0, 50.0),
                                row_at("bad", 12.0, 20.0),  row_at("middle", 3.0, 10.0),
                                row_at("worse", 4.0, 10.0), row_at("worst", 2.0, 60.0)};
    const Front front = front_of(rows);
    EXPECT_THAT(front.front, ElementsAre("texture", "middle", "slow"));
    EXPECT_THAT(dominated_of(front), ElementsAre("worst<texture", "worse<middle", "bad<slow"));
    EXPECT_EQ(front.scene, "natural");
    EXPECT_EQ(front.pose, scene::Pose::overview);
}

// A is 1 % faster and as accurate, which may be chance.
TEST(ParetoFront, nothing_dominates_within_the_noise_of_either) {
    const auto dominated = [](double floor_a, double floor_b) {
        Row a = row_at("a", 1.00, 3.0);
        Row b = row_at("b", 1.01, 3.0);
        a.timing.noise_floor = floor_a;
        b.timing.noise_floor = floor_b;
        const std::vector<Row> rows{a, b};
        return dominated_of(front_of(rows));
    };
    EXPECT_THAT(dominated(0.0, 0.009), ElementsAre("b<a"));
    EXPECT_THAT(dominated(0.0, 0.011), IsEmpty());
    EXPECT_THAT(dominated(0.011, 0.0), IsEmpty());
}

TEST(ParetoFront, nothing_dominates_where_the_noise_is_not_known) {
    std::vector<Row> rows{row_at("a", 1.0, 3.0), row_at("b", 10.0, 30.0)};
    EXPECT_THAT(dominated_of(front_of(rows)), ElementsAre("b<a"));
    rows[1].timing.noise_floor.reset();
    EXPECT_THAT(dominated_of(front_of(rows)), IsEmpty());
    EXPECT_THAT(front_of(rows).front, ElementsAre("a", "b"));
}

TEST(ParetoFront, pictures_with_many_holes_have_no_place_and_are_named) {
    std::vector<Row> rows{row_at("a", 2.0, 3.0), row_at("b", 1.0, 1.0)};
    rows[1].error->holes = 786; // of 1024 x 768 pixels a thousandth is 786.4
    EXPECT_THAT(front_of(rows).front, ElementsAre("b"));
    EXPECT_THAT(front_of(rows).holed, IsEmpty());
    const double area = *front_of(rows).area;
    rows[1].error->holes = 787;
    EXPECT_THAT(front_of(rows).front, ElementsAre("a"));
    EXPECT_THAT(front_of(rows).holed, ElementsAre("b"));
    EXPECT_GT(*front_of(rows).area, area);
}

TEST(ParetoFront, without_ratios_there_is_a_front_and_no_area) {
    std::vector<Row> rows{row_at("a", 2.0, 3.0), row_at("b", 3.0, 4.0)};
    for (Row& row : rows) {
        row.timing.ratio_to_texture.reset();
    }
    EXPECT_THAT(front_of(rows).front, ElementsAre("a"));
    EXPECT_FALSE(front_of(rows).area);
}

TEST(ParetoFront, equals_are_both_on_it) {
    const std::vector<Row> rows{row_at("a", 2.0, 3.0), row_at("b", 2.0, 3.0)};
    EXPECT_THAT(front_of(rows).front, ElementsAre("a", "b"));
    EXPECT_THAT(front_of(rows).dominated, IsEmpty());
}

TEST(ParetoFront, rows_without_bounded_error_are_left_out) {
    Row null_row = row_at("null", 0.5, 0.1);
    null_row.null_row = true;
    Row without = row_at("without", 0.5, 0.1);
    without.error->reprojection_px.reset();
    Row unbounded = row_at("unbounded", 0.5, 0.1);
    unbounded.error->reprojection_px->unbounded = 1;
    const std::vector<Row> rows{null_row, without, unbounded, row_at("real", 1.0, 1.0)};
    EXPECT_THAT(front_of(rows).front, ElementsAre("real"));
    EXPECT_THAT(front_of(rows).dominated, IsEmpty());
}

// The box of four decades by six holds 24 square decades.
TEST(ParetoFront, area_is_what_counting_squares_gives) {
    const auto area = [](const std::vector<Row>& rows) { return *front_of(rows).area; };
    EXPECT_NEAR(area({row_at("ideal", 0.1, 1e-3)}), 0.0, 1e-12);
    EXPECT_NEAR(area({row_at("useless", 1000.0, 1e3)}), 1.0, 1e-12);
    EXPECT_NEAR(area({row_at("texture", 1.0, 100.0)}), (6.0 + 3.0 * 5.0) / 24.0, 1e-12);
    EXPECT_NEAR(area({row_at("texture", 1.0, 100.0), row_at("exact", 100.0, 1e-3)}),
                (6.0 + 2.0 * 5.0) / 24.0, 1e-12);
    EXPECT_NEAR(area({row_at("beyond", 1e-3, 1e-9)}), 0.0, 1e-12); // clamped to the box
    EXPECT_NEAR(area({row_at("endless", 1e6, 1e-9)}), 1.0, 1e-12);
}

struct RandomRows {
    explicit RandomRows(unsigned seed) : random(seed) {}
    std::vector<Row> next() {
        std::lognormal_distribution<double> figure(0.0, 2.0);
        std::vector<Row> rows;
        const int count = std::uniform_int_distribution<int>(1, 12)(random);
        for (int i = 0; i < count; ++i) { // rounded, for ties
            rows.push_back(row_at(std::to_string(i), std::ceil(10.0 * figure(random)) / 10.0,
                                  std::ceil(10.0 * figure(random)) / 10.0));
            rows.back().timing.noise_floor = 0.1 * figure(random);
        }
        return rows;
    }
    std::mt19937 random;
};

bool beats(const Row& a, const Row& b) {
    const double floor = std::max(*a.timing.noise_floor, *b.timing.noise_floor);
    return a.error->reprojection_px->distribution.rms <=
               b.error->reprojection_px->distribution.rms &&
           b.timing.ms.median / a.timing.ms.median > 1.0 + floor;
}

TEST(ParetoFront, agrees_with_the_definition) {
    RandomRows random(1);
    for (int i = 0; i < 2000; ++i) {
        const std::vector<Row> rows = random.next();
        const Front front = front_of(rows);
        ASSERT_EQ(front.front.size() + front.dominated.size(), rows.size());
        for (const Row& row : rows) {
            const bool is_beaten = std::any_of(rows.begin(), rows.end(),
                                               [&](const Row& other) { return beats(other, row); });
            ASSERT_EQ(is_beaten,
                      std::count(front.front.begin(), front.front.end(), row.setting.label) == 0);
        }
        for (const Front::Dominated& setting : front.dominated) {
            const auto by = static_cast<std::size_t>(std::stoi(setting.by));
            const auto loser = static_cast<std::size_t>(std::stoi(setting.label));
            ASSERT_TRUE(beats(rows[by], rows[loser]));
            ASSERT_EQ(std::count(front.front.begin(), front.front.end(), setting.by), 1);
        }
    }
}

TEST(ParetoFront, area_never_rises_by_a_setting_more_nor_depends_on_the_order) {
    RandomRows random(2);
    for (int i = 0; i < 2000; ++i) {
        std::vector<Row> rows = random.next();
        const double area = *front_of(rows).area;
        ASSERT_GE(area, 0.0);
        ASSERT_LE(area, 1.0);
        std::shuffle(rows.begin(), rows.end(), random.random);
        ASSERT_EQ(*front_of(rows).area, area);
        rows.pop_back();
        if (!rows.empty()) {
            ASSERT_GE(*front_of(rows).area, area - 1e-12);
        }
    }
}

TEST(ParetoFront, there_is_one_for_each_scene_and_pose) {
    std::vector<Row> rows{row_at("a", 1.0, 2.0), row_at("b", 2.0, 1.0), row_at("c", 1.0, 1.0),
                          row_at("d", 1.0, 1.0)};
    rows[2].pose = scene::Pose::low;
    rows[3].scene = "urban";
    const std::vector<Front> fronts = fronts_of(rows);
    ASSERT_EQ(fronts.size(), 3U);
    EXPECT_THAT(fronts[0].front, ElementsAre("a", "b"));
    EXPECT_THAT(fronts[1].front, ElementsAre("c"));
    EXPECT_EQ(fronts[1].pose, scene::Pose::low);
    EXPECT_EQ(fronts[2].scene, "urban");
}

} // namespace
} // namespace reljef::bench
