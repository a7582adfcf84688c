#include "bench/findings/judgement.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/findings/figures.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using Numbers = std::vector<std::optional<Number>>;

std::vector<Figure> figures_at_most(double high, std::size_t count) {
    Figure figure;
    figure.expected = at_most(high);
    return std::vector<Figure>(count, figure);
}

TEST(VerdictOf, ConfirmsIfAllRefutesIfNoneAndDependsIfSomeLieInTheirRanges) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> value(0.0, 20.0);
    std::uniform_int_distribution<std::size_t> counts(1, 5);
    for (int round = 0; round < 2000; ++round) {
        const auto figures = figures_at_most(10.0, counts(random));
        Numbers numbers;
        std::size_t inside = 0;
        for (std::size_t i = 0; i < figures.size(); ++i) {
            numbers.emplace_back(Number{value(random)});
            inside += numbers.back()->value <= 10.0 ? 1U : 0U;
        }
        const Finding expected = inside == figures.size() ? Finding::confirmed
                                 : inside == 0            ? Finding::refuted
                                                          : Finding::depends;
        EXPECT_EQ(verdict_of(figures, numbers), expected);
    }
}

TEST(VerdictOf, IsNotMeasuredWithoutOneOfTheNumbersOrAnyFigure) {
    const auto figures = figures_at_most(10.0, 3);
    EXPECT_EQ(verdict_of(figures, Numbers{Number{1.0}, std::nullopt, Number{2.0}}),
              Finding::not_measured);
    EXPECT_EQ(verdict_of({}, {}), Finding::not_measured);
}

TEST(VerdictOf, IsOpenWhereNoiseReachesTheEndOfTheRangeAndNeverTurns) {
    const auto figures = figures_at_most(10.0, 1);
    EXPECT_EQ(verdict_of(figures, Numbers{Number{9.0, 0.5}}), Finding::confirmed);
    EXPECT_EQ(verdict_of(figures, Numbers{Number{9.0, 1.5}}), Finding::open);
    EXPECT_EQ(verdict_of(figures, Numbers{Number{11.0, 1.5}}), Finding::open);
    EXPECT_EQ(verdict_of(figures, Numbers{Number{11.0, 0.5}}), Finding::refuted);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> value(0.0, 20.0);
    for (int round = 0; round < 2000; ++round) {
        const Number exact{value(random)};
        const Finding noisy = verdict_of(figures, Numbers{Number{exact.value, value(random)}});
        EXPECT_TRUE(noisy == Finding::open || noisy == verdict_of(figures, Numbers{exact}));
    }
}

TEST(VerdictOf, DependsIfAFigureIsOutsideAndOthersAreOpenOrInside) {
    const auto figures = figures_at_most(10.0, 2);
    const Number inside{9.0, 0.5};
    const Number open{9.0, 1.5};
    const Number outside{11.0, 0.5};
    EXPECT_EQ(verdict_of(figures, Numbers{inside, open}), Finding::open);
    EXPECT_EQ(verdict_of(figures, Numbers{inside, outside}), Finding::depends);
    EXPECT_EQ(verdict_of(figures, Numbers{open, outside}), Finding::depends);
    EXPECT_EQ(verdict_of(figures, Numbers{outside, outside}), Finding::refuted);
}

// Results of one file with two rows.
class JudgedFigures : public testing::Test {
protected:
    Result<std::optional<Number>> number(const Figure& figure, const std::string& a,
                                         const std::string& b) {
        folder_.write("r.json", R"({"schema": "reljef-bench/1", "rows": [{"label": "a", )" + a +
                                    R"(}, {"label": "b", )" + b + "}]}");
        const std::vector<std::string> files{"r.json"};
        const auto results = CommittedResults::read(folder_.path(), files);
        return results ? number_of(figure, *results) : results.error();
    }

    static RowName row(const std::string& label) { return {"r.json", {{"label", label}}}; }

    static std::string ms(double median, double noise) {
        return R"("ms": {"median": )" + std::to_string(median) + R"(}, "noise_floor": )" +
               std::to_string(noise);
    }

private:
    test::TemporaryFolder folder_;
};

TEST_F(JudgedFigures, ARatioOfTimesIsAsNoisyAsItsRun) {
    const auto found =
        number(ratio("", Quantity::ms, row("a"), row("b"), {}), ms(30.0, 0.02), ms(20.0, 0.02));
    ASSERT_TRUE(found && *found);
    EXPECT_DOUBLE_EQ((*found)->value, 1.5);
    EXPECT_DOUBLE_EQ((*found)->uncertainty(), 0.03);
}

TEST_F(JudgedFigures, ADropIsTheShareOfFramesThatIsLost) {
    const auto found = number(drop("", row("a"), row("b"), {}), ms(40.0, 0.02), ms(10.0, 0.02));
    ASSERT_TRUE(found && *found);
    EXPECT_DOUBLE_EQ((*found)->value, 75.0);
    EXPECT_DOUBLE_EQ((*found)->uncertainty(), 0.5);
}

TEST_F(JudgedFigures, ARateIsInFramesPerSecond) {
    const auto found = number(frame_rate("", row("a"), {}), ms(40.0, 0.1), ms(1.0, 0.0));
    ASSERT_TRUE(found && *found);
    EXPECT_DOUBLE_EQ((*found)->value, 25.0);
    EXPECT_DOUBLE_EQ((*found)->uncertainty(), 2.5);
}

TEST_F(JudgedFigures, TimesWithoutANoiseFloorCountAsNoisy) {
    const auto found =
        number(frame_rate("", row("a"), {}), R"("ms": {"median": 100})", R"("ms": {"median": 1})");
    ASSERT_TRUE(found && *found);
    EXPECT_DOUBLE_EQ((*found)->uncertainty(), 1.0);
}

TEST_F(JudgedFigures, ARatioToNothingOrToAMissingRowIsNoNumber) {
    const std::string wrong = R"("error": {"wrong_of_terrain_percent": 1})";
    const std::string none = R"("error": {"wrong_of_terrain_percent": 0})";
    const auto to_nothing = number(ratio("", Quantity::wrong, row("a"), row("b"), {}), wrong, none);
    ASSERT_TRUE(to_nothing);
    EXPECT_FALSE(to_nothing->has_value());
    const auto to_missing = number(ratio("", Quantity::wrong, row("a"), row("c"), {}), wrong, none);
    ASSERT_TRUE(to_missing);
    EXPECT_FALSE(to_missing->has_value());
}

TEST(Judge, AConclusionWithoutARuleIsAnswered) {
    const test::TemporaryFolder folder;
    const auto results = CommittedResults::read(folder.path(), {});
    ASSERT_TRUE(results);
    Figure figure;
    figure.form = Figure::Form::constant;
    figure.constant = {5.0, 0.0};
    const auto answered = judge({"J", "a claim", "", {figure}}, *results);
    ASSERT_TRUE(answered);
    EXPECT_EQ(answered->verdict, Finding::answered);
    const auto open = judge({"J", "a claim", "", {}}, *results);
    ASSERT_TRUE(open);
    EXPECT_EQ(open->verdict, Finding::not_measured);
}

// The means of J's table: 75, 71.4 and 64.7 % of three tests, 93.3 % of the fourth.
TEST(ThesisDrop, IsTheMeanOfTheTableWithItsRounding) {
    const ThesisDrop three = thesis_drop("relief", {"relief-1", "relief-2", "relief-3"});
    EXPECT_NEAR(three.mean, (75.0 + 100.0 * 140 / 196 + 100.0 * 110 / 170) / 3.0, 1e-9);
    EXPECT_NEAR(thesis_drop("relief", {"relief-4"}).mean, 100.0 * 769 / 824, 1e-9);
    EXPECT_NEAR(three.highest, 75.0, 1e-9);
    EXPECT_NEAR(three.lowest, 100.0 * 110 / 170, 1e-9);
    // Half a frame of 44 of 176 is at most (0.5 + 0.125) / 175.5 of the frame rate.
    EXPECT_NEAR(thesis_drop("relief", {"relief-1"}).rounding, 100.0 * 0.625 / 175.5, 1e-9);
}

} // namespace
} // namespace reljef::bench
