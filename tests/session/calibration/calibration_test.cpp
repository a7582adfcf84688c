#include "engine/session/calibration/calibration.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/atomic_file.h"
#include "engine/session/calibration/measure_costs.h"
#include "tests/support/temporary_folder.h"

namespace reljef::session {
namespace {

using testing::HasSubstr;

const CalibrationPlace here_of_test{"a processor", "reljef 1", "osmesa", "llvmpipe"};

Calibration made_calibration() {
    return {here_of_test,
            {.frame_ms = 1.5,
             .triangle_ns = 100.25,
             .touched_pixel_ns = 8.0,
             .covered_pixel_ns = 7.0,
             .rays_ms = 0.0,
             .ray_pixel_ns = 50.0,
             .search_pixel_ns = 25.0,
             .search_step_ns = 4.0,
             .frame_sample_ms = 0.5,
             .touched_sample_ns = 3.0,
             .covered_sample_ns = 2.0}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(Calibration, IsReadAsItWasWritten) {
    const Calibration made = made_calibration();
    EXPECT_EQ(parse_calibration(to_text(made), "a.json").value(), made);
}

TEST(Calibration, OtherTextsAreErrorsThatNameTheFileAndARemedy) {
    const std::string good = to_text(made_calibration());
    for (const std::string& bad :
         {std::string(), std::string("[]"), std::string("{}"), std::string("\xff\x00{", 3),
          replaced(good, "calibration/3", "calibration/1"), replaced(good, "100.25", "-1"),
          replaced(good, "100.25", "1e999"), replaced(good, "100.25", "\"much\""),
          replaced(good, "\"osmesa\"", "3"), replaced(good, "\"costs\"", "\"prices\""),
          good.substr(0, good.size() / 2)}) {
        const auto parsed = parse_calibration(bad, "a.json");
        ASSERT_FALSE(parsed) << bad;
        EXPECT_THAT(parsed.error().message, HasSubstr("a.json: "));
        EXPECT_THAT(parsed.error().message, HasSubstr("'reljef calibrate"));
    }
}

TEST(Calibration, ErrorsNameWhatWasFound) {
    const std::string good = to_text(made_calibration());
    const auto message = [](const std::string& bad) {
        return parse_calibration(bad, "a.json").error().message;
    };
    EXPECT_THAT(message(replaced(good, "100.25", "-1")), HasSubstr("triangle_ns -1 found"));
    EXPECT_THAT(message(replaced(good, "\"osmesa\"", "3")), HasSubstr("context 3 found"));
    EXPECT_THAT(message(replaced(good, "calibration/3", "calibration/1")),
                HasSubstr("schema \"reljef-calibration/1\" found"));
    EXPECT_THAT(message("{}"), HasSubstr("no schema found"));
    EXPECT_THAT(message("[]"), HasSubstr("no JSON object found"));
    EXPECT_THAT(message(replaced(good, "osmesa", std::string(9999, 'x')) + "]"),
                HasSubstr("no JSON object found"));
}

TEST(Calibration, HoldsInItsPlaceOnly) {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "costs.json";
    ASSERT_TRUE(write_text_file(file, to_text(made_calibration())));
    EXPECT_EQ(read_costs(file, here_of_test).value(), made_calibration().costs);
    for (std::string CalibrationPlace::*const member :
         {&CalibrationPlace::machine, &CalibrationPlace::version, &CalibrationPlace::context,
          &CalibrationPlace::renderer}) {
        CalibrationPlace other = here_of_test;
        other.*member = "another";
        const auto costs = read_costs(file, other);
        ASSERT_FALSE(costs);
        EXPECT_THAT(costs.error().message, HasSubstr("'another' was expected"));
    }
    Calibration elsewhere = made_calibration();
    elsewhere.place.renderer = std::string(100'000, 'r');
    ASSERT_TRUE(write_text_file(file, to_text(elsewhere)));
    EXPECT_LT(read_costs(file, here_of_test).error().message.size(), 1000U);
    EXPECT_FALSE(read_costs(folder.path() / "none.json", here_of_test));
}

TEST(Calibration, CostsHaveAShortText) {
    EXPECT_EQ(costs_text({}), "built-in");
    const std::string text = costs_text({.frame_ms = 0.25, .triangle_ns = 123.456});
    EXPECT_THAT(text, testing::StartsWith("frame 0.25 ms, triangle 123.5 ns, touched pixel "));
}

TEST(Calibration, CostsFollowFromFrames) {
    // 2 ms; 100 ns a triangle, 30 a touched and 10 a covered pixel; 3 ms and 50 ns a ray; 20 ns a
    // search and 2 a step; of a further sample 1 ms, 5 ns a touched and 4 a covered pixel.
    const MeasuredFrames frames{.sky = {2.0, 0.0, 0.0},
                                .few = {2.0 + 0.1 + 0.6 + 5.0, 1e3, 2e4, 5e5},
                                .many = {2.0 + 10.0 + 6.0 + 5.0, 1e5, 2e5, 5e5},
                                .flat = {2.0 + 12.0 + 3.0 + 2.0, 1.2e5, 1e5, 2e5},
                                .rays = {2.0 + 3.0 + 25.0, 12.0, 0.0, 5e5},
                                .fewer_pixels = {2.0 + 3.0 + 5.0, 12.0, 0.0, 1e5},
                                .few_steps = {2.0 + 3.0 + 10.0 + 4.0, 12.0, 0.0, 5e5, 2e6},
                                .many_steps = {2.0 + 3.0 + 10.0 + 16.0, 12.0, 0.0, 5e5, 8e6},
                                .sampled_sky = {2.0 + 3.0, 0.0, 0.0},
                                .sampled_few = {7.7 + 3.0 * (1.0 + 0.1 + 2.0), 1e3, 2e4, 5e5},
                                .sampled_many = {23.0 + 3.0 * (1.0 + 1.0 + 2.0), 1e5, 2e5, 5e5}};
    const Costs costs = costs_from(frames);
    EXPECT_NEAR(costs.frame_ms, 2.0, 1e-9);
    EXPECT_NEAR(costs.triangle_ns, 100.0, 1e-6);
    EXPECT_NEAR(costs.touched_pixel_ns, 30.0, 1e-6);
    EXPECT_NEAR(costs.covered_pixel_ns, 10.0, 1e-6);
    EXPECT_NEAR(costs.rays_ms, 3.0, 1e-9);
    EXPECT_NEAR(costs.ray_pixel_ns, 50.0, 1e-6);
    EXPECT_NEAR(costs.search_pixel_ns, 20.0, 1e-6);
    EXPECT_NEAR(costs.search_step_ns, 2.0, 1e-6);
    EXPECT_NEAR(costs.frame_sample_ms, 1.0, 1e-9);
    EXPECT_NEAR(costs.touched_sample_ns, 5.0, 1e-6);
    EXPECT_NEAR(costs.covered_sample_ns, 4.0, 1e-6);
}

TEST(Calibration, CostsAreNeverNegative) {
    const FrameCost same{1.0, 10.0, 10.0, 10.0, 10.0};
    const FrameCost cheaper{0.5, 20.0, 20.0, 20.0, 20.0};
    const Costs costs = costs_from(
        {same, cheaper, same, same, cheaper, same, same, cheaper, cheaper, cheaper, same});
    for (const double cost :
         {costs.frame_ms, costs.triangle_ns, costs.touched_pixel_ns, costs.covered_pixel_ns,
          costs.rays_ms, costs.ray_pixel_ns, costs.search_pixel_ns, costs.search_step_ns,
          costs.frame_sample_ms, costs.touched_sample_ns, costs.covered_sample_ns}) {
        EXPECT_TRUE(std::isfinite(cost));
        EXPECT_GE(cost, 0.0);
    }
}

} // namespace
} // namespace reljef::session
