#include "bench/claims/claim_suite.h"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/bench/bench_program.h"

namespace reljef::bench {
namespace {

ClaimOptions small_claims() {
    ClaimOptions options;
    options.suite.size = {160, 120};
    options.suite.context = session::BackendKind::osmesa;
    options.suite.quiet = true;
    options.suite.rounds = 1;
    options.tile = 64;
    options.copies = {3};
    options.lone = {.piece = 32, .city = 2, .pieces = 6};
    options.poses = {scene::Pose::overview};
    return options;
}

class ClaimSuite : public testing::Test {
protected:
    static const ClaimResults& results() {
        static const ClaimResults measured = run_claims(small_claims(), {});
        return measured;
    }

    static const ClaimRow& row(const std::string& test, const std::string& form,
                               const std::string& label) {
        for (const ClaimRow& row : results().rows) {
            if (row.test == test && row.form == form && row.label.starts_with(label)) {
                return row;
            }
        }
        ADD_FAILURE() << test << ", " << form << ", " << label;
        return results().rows.front();
    }
};

TEST_F(ClaimSuite, CopiesOfATileShowTheSamePlacesWithoutItsMemory) {
    ASSERT_FALSE(results().end.stopped) << results().end.stopped->message;
    for (const char* const form : {"one terrain", "one tile"}) {
        EXPECT_EQ(row("repeat", form, "exact").error->wrong_percent, 0.0) << form;
        EXPECT_LT(row("repeat", form, "exact").error->reprojection_px->distribution.rms, 0.01);
        EXPECT_GT(row("repeat", form, "texture").error->wrong_percent, 20.0) << form;
        EXPECT_LT(row("repeat", form, "relief").error->wrong_percent, 10.0) << form;
    }
    EXPECT_EQ(row("repeat", "one terrain", "relief").nodes, 1U);
    EXPECT_EQ(row("repeat", "one tile", "relief").nodes, 9U);
    EXPECT_GT(row("repeat", "one tile", "relief").bytes, 64U * 64U * sizeof(float))
        << "its heights";
    EXPECT_LT(row("repeat", "one tile", "relief").bytes,
              row("repeat", "one terrain", "relief").bytes / 4);
}

TEST_F(ClaimSuite, ATextureOnLevelGroundShowsItExactlyWithFewerTaps) {
    const ClaimRow& everywhere = row("city only", "pieces", "exact");
    const ClaimRow& city_only = row("city only", "city only", "exact");
    EXPECT_EQ(everywhere.nodes, 36U);
    EXPECT_EQ(city_only.nodes, 36U);
    EXPECT_EQ(everywhere.error->wrong_percent, 0.0);
    EXPECT_EQ(city_only.error->wrong_percent, 0.0);
    EXPECT_LT(*city_only.taps, *everywhere.taps);
    EXPECT_LT(*row("city only", "city only", "relief").taps,
              *row("city only", "pieces", "relief").taps);
    EXPECT_GT(row("city only", "one terrain", "texture").error->wrong_percent, 1.0);
}

TEST_F(ClaimSuite, FourLayersShowBricksAsWellAsOne) {
    EXPECT_GT(row("layers", "detail texture", "texture").error->wrong_percent, 20.0);
    EXPECT_LT(row("layers", "detail texture", "relief").error->wrong_percent, 10.0);
    EXPECT_LT(row("layers", "detail texture", "multi").error->wrong_percent, 10.0);
}

// The second drawing of the first form is for the noise alone.
TEST_F(ClaimSuite, EachFormOfATestHasOneRow) {
    std::map<std::string, int> count;
    for (const ClaimRow& row : results().rows) {
        ++count[row.test];
        EXPECT_GT(row.timing.ms.median, 0.0) << row.label;
    }
    EXPECT_THAT(count,
                testing::ElementsAre(testing::Pair("city only", 8), testing::Pair("layers", 4),
                                     testing::Pair("repeat", 8), testing::Pair("warping", 2)));
}

TEST_F(ClaimSuite, ItsTableHasWhatFindingsRead) {
    const auto json = nlohmann::json::parse(figure_json(figure_table(results())));
    ASSERT_EQ(json["rows"].size(), results().rows.size());
    const auto& first = json["rows"][0];
    EXPECT_EQ(first["test"], "repeat");
    EXPECT_EQ(first["scene"], "3 × 3 tiles of 64 cells");
    EXPECT_EQ(first["pose"], "overview");
    EXPECT_TRUE(first["ms"]["median"].is_number());
    EXPECT_TRUE(first["objects"]["bytes"].is_number());
    for (std::size_t i = 0; i < results().rows.size(); ++i) {
        const ClaimRow& row = results().rows[i];
        const auto& figures = json["rows"][i];
        EXPECT_EQ(figures["form"], row.form);
        EXPECT_EQ(figures["label"], row.label);
        EXPECT_EQ(figures["nodes"], row.nodes);
        if (row.error) {
            EXPECT_EQ(figures["triangles"], row.timing.stats.triangles);
            EXPECT_EQ(figures["error"]["wrong_percent"], row.error->wrong_percent);
            EXPECT_EQ(figures["error"]["flip"], row.error->flip);
        } else {
            EXPECT_EQ(row.test, "warping");
            EXPECT_TRUE(figures["triangles"].is_null());
            EXPECT_FALSE(figures["error"].contains("wrong_percent"));
            EXPECT_FALSE(figures["error"].contains("flip"));
        }
    }
    EXPECT_TRUE(json["rows"].back()["taps"].is_null());
}

TEST(ClaimOptionsOfTables, RefuseWhatTheyDoNotUse) {
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--pose", "low"},
                                                 {"--guesses"},
                                                 {"--technique", "relief"},
                                                 {"--terrain", "urban"}}) {
        std::vector<std::string> arguments{"tables", "--claims"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto run = test::reljef_bench(arguments);
        EXPECT_EQ(run.exit_code, 2) << more[0];
        EXPECT_THAT(run.err, testing::HasSubstr(more[0])) << run.err;
    }
}

} // namespace
} // namespace reljef::bench
