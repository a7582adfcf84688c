#include "bench/findings/committed_results.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/findings/findings_page.h"
#include "tests/bench/bench_program.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> files{"r.json"};

class ReadCommittedResults : public testing::Test {
protected:
    Result<CommittedResults> read(std::string_view text) {
        folder_.write("r.json", text);
        return CommittedResults::read(folder_.path(), files);
    }

    std::string refusal(std::string_view text) {
        const auto results = read(text);
        return results ? "" : results.error().message;
    }

    static std::string with_rows(const std::string& rows) {
        return R"({"schema": "reljef-bench/1", "stopped": null, "rows": [)" + rows + "]}";
    }

    // The error of a number of the row "a"; "none" if it does not exist.
    std::string number_refusal(const std::string& rows, Quantity quantity) {
        const auto results = read(with_rows(rows));
        if (!results) {
            return results.error().message;
        }
        const auto number = results->number({"r.json", {{"label", "a"}}}, quantity);
        if (!number) {
            return number.error().message;
        }
        return number->has_value() ? "" : "none";
    }

    test::TemporaryFolder folder_;
};

TEST_F(ReadCommittedResults, RefusesDamageAndOtherVersionsInOneSentence) {
    const std::vector<std::pair<std::string, std::string>> damaged{
        {"", "its end is missing"},
        {"{", "its end is missing"},
        {"results", "no JSON found"},
        {R"({"schema": "reljef-bench/1", "rows": [{"ms": NaN}]})", "no JSON found"},
        {R"({"schema": "reljef-bench/1", "rows": [{"ms": 1e999}]})", "beyond all range"},
        {"[]", "no schema found"},
        {"{}", "no schema found"},
        {R"({"schema": 1})", "no schema found"},
        {R"({"schema": "reljef-bench/2", "rows": []})", "'reljef-bench/2' found"},
        {R"({"schema": "other/1", "rows": []})", "'other/1' found"},
        {R"({"schema": "reljef-bench/1", "rows": {}})", "rows: no array found"},
        {R"({"schema": "reljef-bench/1", "stopped": "interrupted", "rows": []})", "ended early"}};
    for (const auto& [text, part] : damaged) {
        const std::string message = refusal(text);
        EXPECT_THAT(message, AllOf(HasSubstr("r.json: "), HasSubstr(part), Not(HasSubstr("\n"))))
            << text;
    }
}

TEST_F(ReadCommittedResults, RefusesNumbersThatCannotBe) {
    for (const char* const wrong : {"-1", "100.5", "\"many\"", "true", "[]"}) {
        const std::string row =
            std::string(R"({"label": "a", "error": {"wrong_of_terrain_percent": )") + wrong + "}}";
        EXPECT_THAT(
            number_refusal(row, Quantity::wrong),
            AllOf(HasSubstr("row 'a': /error/wrong_of_terrain_percent: "), HasSubstr("0 to 100")));
    }
    for (const char* const median : {"0", "-2", "1e-300"}) {
        const std::string row = std::string(R"({"label": "a", "ms": {"median": )") + median + "}}";
        EXPECT_THAT(number_refusal(row, Quantity::ms), HasSubstr("/ms/median: "));
    }
    EXPECT_THAT(
        number_refusal(R"({"label": "a", "ms": {"median": 2}, "noise_floor": -1})", Quantity::ms),
        HasSubstr("/noise_floor: -1 found"));
    EXPECT_THAT(number_refusal(R"({"label": "a"}, {"label": "a"})", Quantity::wrong),
                HasSubstr("several rows 'a' found"));
}

TEST_F(ReadCommittedResults, HasNoNumberWithoutFileRowOrValue) {
    EXPECT_EQ(number_refusal(R"({"label": "b"}, 3, null, {"label": 7})", Quantity::wrong), "none");
    EXPECT_EQ(number_refusal(R"({"label": "a"})", Quantity::wrong), "none");
    EXPECT_EQ(number_refusal(R"({"label": "a", "error": null})", Quantity::wrong), "none");
    EXPECT_EQ(number_refusal(R"({"label": "a", "error": 3})", Quantity::wrong), "none");
    EXPECT_EQ(number_refusal(R"({"label": "a", "error": {"reprojection_px": {"rms": null}}})",
                             Quantity::error_px),
              "none");
    const auto results = read(with_rows(""));
    ASSERT_TRUE(results);
    const auto other = results->number({"other.json", {}}, Quantity::wrong);
    ASSERT_TRUE(other);
    EXPECT_FALSE(other->has_value());
    EXPECT_FALSE(results->machine("other.json"));
}

TEST_F(ReadCommittedResults, SkipsNullRows) {
    EXPECT_EQ(number_refusal(
                  R"({"label": "a", "null_row": true, "error": {"wrong_of_terrain_percent": 1}},)"
                  R"({"label": "a", "null_row": false, "error": {"wrong_of_terrain_percent": 2}})",
                  Quantity::wrong),
              "");
}

// Rows of earlier versions know the share of the picture only.
TEST_F(ReadCommittedResults, HaveTheWrongPixelsOfTheTerrainNotOfThePicture) {
    const auto wrong = [&](const std::string& error) {
        const auto results = read(with_rows(
            R"({"label": "a", "size": "100x50", "error": {"wrong_percent": 2, )" + error + "}}"));
        const auto number = results->number({"r.json", {{"label", "a"}}}, Quantity::wrong);
        return number && *number ? (*number)->value : -1.0;
    };
    const std::string counts = R"("reprojection_px": {"count": 300, "unbounded": 60}, "holes": 40)";
    EXPECT_DOUBLE_EQ(wrong(counts), 25.0); // 100 of 400 pixels
    EXPECT_DOUBLE_EQ(wrong(counts + R"(, "wrong_of_terrain_percent": 7)"), 7.0);
    EXPECT_DOUBLE_EQ(wrong(R"("reprojection_px": null, "holes": 40)"), -1.0);
    EXPECT_DOUBLE_EQ(wrong(R"("reprojection_px": {"count": 0, "unbounded": 0}, "holes": 0)"), -1.0);
}

TEST_F(ReadCommittedResults, HaveTheHolesOfTheTerrainNotOfThePicture) {
    const auto holes = [&](const std::string& error) {
        const auto results =
            read(with_rows(R"({"label": "a", "size": "100x50", "error": {)" + error + "}}"));
        const auto number = results->number({"r.json", {{"label", "a"}}}, Quantity::holes);
        return number && *number ? (*number)->value : -1.0;
    };
    EXPECT_DOUBLE_EQ(holes(R"("reprojection_px": {"count": 300, "unbounded": 60}, "holes": 40)"),
                     10.0);
    EXPECT_DOUBLE_EQ(holes(R"("reprojection_px": null, "holes": 40)"), 100.0);
    EXPECT_DOUBLE_EQ(holes(R"("reprojection_px": null, "holes": 0)"), -1.0);
    EXPECT_DOUBLE_EQ(holes(R"("reprojection_px": {"count": 300, "unbounded": 60})"), -1.0);
    EXPECT_DOUBLE_EQ(holes(R"("holes": -1)"), -1.0);
}

TEST_F(ReadCommittedResults, AreAsUncertainAsTheIntervalIfItIsWiderThanTheNoise) {
    const auto uncertainty = [&](const char* const interval) {
        const auto results = read(with_rows(
            std::string(R"({"label": "a", "noise_floor": 0.02, "ms": {"median": 2, "interval": )") +
            interval + "}}"));
        const auto number = results->number({"r.json", {{"label", "a"}}}, Quantity::ms);
        return number && *number ? (*number)->uncertainty() : -1.0;
    };
    EXPECT_DOUBLE_EQ(uncertainty("[1.99, 2.01]"), 0.04);
    EXPECT_DOUBLE_EQ(uncertainty("[1.5, 2.25]"), 0.5);
    EXPECT_DOUBLE_EQ(uncertainty("[1.75, 3]"), 1.0);
    EXPECT_DOUBLE_EQ(uncertainty("null"), 0.04);
    EXPECT_DOUBLE_EQ(uncertainty("[1.5, \"many\"]"), -1.0);
}

// A byte of committed results is another one: the page or one sentence, nothing else.
TEST(DamagedResults, AreAPageOrOneSentence) {
    const std::filesystem::path source = std::filesystem::path(RELJEF_SOURCE) / "bench" / "results";
    const std::string whole = test::read_bytes(source / "tables.json");
    ASSERT_FALSE(whole.empty());
    std::mt19937 random(3);
    std::uniform_int_distribution<std::size_t> place(0, whole.size() - 1);
    std::uniform_int_distribution<int> byte(0, 255);
    const test::TemporaryFolder folder;
    for (int round = 0; round < 40; ++round) {
        std::string damaged = whole;
        for (int i = 0; i <= round % 4; ++i) {
            damaged[place(random)] = static_cast<char>(byte(random));
        }
        folder.write("tables.json", round % 10 == 9 ? damaged.substr(0, place(random)) : damaged);
        const auto results = read_all_results(folder.path());
        const auto page = results ? findings_page(*results) : results.error();
        if (!page) {
            EXPECT_THAT(page.error().message,
                        AllOf(HasSubstr("tables.json"), Not(HasSubstr("\n"))));
        }
    }
}

TEST(FindingsCommand, RefusesAFolderThatIsMissingAndAnOutputAmongItsResults) {
    const auto missing = test::reljef_bench({"findings", "--results", "/none"});
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_EQ(missing.out, "");
    EXPECT_THAT(missing.err, HasSubstr("/none: no folder found"));
    const test::TemporaryFolder folder;
    const auto inside = folder.write("tables.json", "earlier");
    const auto among = test::reljef_bench(
        {"findings", "--results", folder.path().string(), "--markdown", inside.string()});
    EXPECT_EQ(among.exit_code, 2);
    EXPECT_THAT(among.err, HasSubstr("--results"));
    EXPECT_EQ(test::read_bytes(inside), "earlier");
}

TEST(FindingsCommand, KeepsAnEarlierPageIfResultsAreDamaged) {
    const test::TemporaryFolder folder;
    const test::TemporaryFolder results;
    results.write("tables.json", "{");
    const auto page = folder.write("page.md", "earlier");
    const auto run = test::reljef_bench(
        {"findings", "--results", results.path().string(), "--markdown", page.string()});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr("tables.json: its end is missing"));
    EXPECT_EQ(test::read_bytes(page), "earlier");
}

} // namespace
} // namespace reljef::bench
