#include "bench/findings/findings_page.h"

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <tuple>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/cli/interrupt.h"
#include "app/cli/parser.h"
#include "bench/commands.h"
#include "bench/findings/conclusions.h"
#include "bench/findings/distance_plot.h"
#include "bench/findings/figures.h"
#include "bench/findings/judgement.h"
#include "tests/bench/bench_program.h"
#include "tests/support/plain_words.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

std::filesystem::path source_folder() {
    return RELJEF_SOURCE;
}

std::string committed_page() {
    return test::read_bytes(source_folder() / "docs" / "findings.md");
}

std::vector<Chapter::Sentence> all_sentences() {
    const Findings findings = all_findings();
    std::vector<Chapter::Sentence> sentences = findings.summary;
    for (const Chapter& chapter : findings.chapters) {
        sentences.insert(sentences.end(), chapter.answer.begin(), chapter.answer.end());
    }
    return sentences;
}

std::vector<Figure> all_figures() {
    std::vector<Figure> figures;
    for (const Chapter::Sentence& sentence : all_sentences()) {
        figures.insert(figures.end(), sentence.figures.begin(), sentence.figures.end());
    }
    for (const Chapter& chapter : all_findings().chapters) {
        for (const Conclusion& conclusion : chapter.conclusions) {
            figures.insert(figures.end(), conclusion.figures.begin(), conclusion.figures.end());
        }
    }
    return figures;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) {
        ++count;
    }
    return count;
}

// The arguments after "reljef-bench" of the commands on a page.
std::vector<std::vector<std::string>> commands_on(const std::string& page) {
    const std::string program = "build/release/bin/reljef-bench ";
    std::vector<std::vector<std::string>> commands;
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(program)) {
            std::istringstream words(line.substr(program.size()));
            commands.emplace_back(std::istream_iterator<std::string>(words),
                                  std::istream_iterator<std::string>());
        }
    }
    return commands;
}

// Written again by the command at the end of the page.
TEST(Findings, CommittedPageIsTheOneOfTheCommittedResults) {
    const auto results = read_all_results(source_folder() / "bench" / "results");
    ASSERT_TRUE(results) << results.error().message;
    const auto page = findings_page(*results);
    ASSERT_TRUE(page) << page.error().message;
    EXPECT_EQ(committed_page(), *page);
    const auto plot = distance_plot(*results);
    ASSERT_TRUE(plot) << plot.error().message;
    EXPECT_EQ(test::read_bytes(source_folder() / "docs" / distance_plot_file), *plot);
}

TEST(Findings, EveryCommandOnThePageIsOneThatTheProgramTakes) {
    const cli::Program program = reljef_bench_program();
    cli::Interrupt interrupt;
    const auto commands = commands_on(committed_page());
    EXPECT_EQ(commands.size(), results_sources().size());
    for (std::vector<std::string> words : commands) {
        std::vector<char*> arguments;
        std::transform(words.begin(), words.end(), std::back_inserter(arguments),
                       [](std::string& word) { return word.data(); });
        cli::Parser parser(program, interrupt);
        EXPECT_NO_THROW(parser.parse(arguments)) << testing::PrintToString(words);
    }
}

TEST(Findings, TheirResultsExistAndTheirCommandsAreThoseOfTheReadme) {
    const auto results = source_folder() / "bench" / "results";
    const std::string readme = test::read_bytes(results / "README.md");
    for (const ResultsSource& source : results_sources()) {
        EXPECT_TRUE(std::filesystem::exists(results / source.file())) << source.name;
        EXPECT_THAT(readme, HasSubstr("build/release/bin/" + source.command + "\n"));
        EXPECT_THAT(source.command, HasSubstr("--json bench/results/" + source.file()));
    }
}

TEST(Findings, UseNoTimesOfABusyMachineAndNoOtherFiles) {
    for (const Figure& figure : all_figures()) {
        if (figure.form == Figure::Form::constant) {
            continue;
        }
        const auto sources = results_sources();
        const auto source =
            std::find_if(sources.begin(), sources.end(), [&](const ResultsSource& candidate) {
                return candidate.file() == figure.row.file;
            });
        ASSERT_NE(source, sources.end()) << figure.row.file;
        EXPECT_TRUE(source->quiet || figure.quantity != Quantity::ms) << figure.words;
    }
}

TEST(Findings, AreSentencesWithAFigureForEachPlace) {
    for (const Chapter::Sentence& sentence : all_sentences()) {
        EXPECT_EQ(occurrences(sentence.text, "{}"), sentence.figures.size()) << sentence.text;
    }
    std::set<std::string> claims;
    for (const Chapter& chapter : all_findings().chapters) {
        for (const Conclusion& conclusion : chapter.conclusions) {
            EXPECT_TRUE(claims.insert(conclusion.source + conclusion.claim).second)
                << conclusion.claim;
            EXPECT_TRUE(conclusion.claim.ends_with('.')) << conclusion.claim;
            EXPECT_FALSE(conclusion.figures.empty() && conclusion.note.empty()) << conclusion.claim;
        }
    }
    EXPECT_GE(claims.size(), 50U);
}

// Two frames of 165 and 200 ms once stood at the end of an axis of 150.
TEST(Findings, NoPointOfThePlotLiesBeyondItsAxis) {
    const test::TemporaryFolder folder;
    const std::filesystem::path committed = source_folder() / "bench" / "results";
    std::filesystem::copy_file(committed / "distance.json", folder.path() / "distance.json");
    auto objects = nlohmann::json::parse(test::read_bytes(committed / "objects.json"));
    for (auto& row : objects["rows"]) {
        row["ms"]["median"] = 10.0 * row["ms"]["median"].get<double>();
        row["ms"].erase("interval");
    }
    folder.write("objects.json", objects.dump());
    const auto results = read_all_results(folder.path());
    ASSERT_TRUE(results) << results.error().message;
    const auto plot = distance_plot(*results);
    ASSERT_TRUE(plot) << plot.error().message;
    const std::regex height("cy=\"([0-9.]+)\"");
    std::size_t points = 0;
    for (auto found = std::sregex_iterator(plot->begin(), plot->end(), height);
         found != std::sregex_iterator(); ++found, ++points) {
        EXPECT_GT(std::stod((*found)[1]), 40.0);
        EXPECT_LT(std::stod((*found)[1]), 280.0);
    }
    EXPECT_GT(points, 20U);
}

TEST(Findings, UsePlainWords) {
    for (const char* const phrase : test::dialect_phrases) {
        EXPECT_THAT(committed_page(), Not(HasSubstr(phrase)));
    }
}

TEST(Findings, WithoutResultsNothingIsMeasuredAndNothingIsClaimed) {
    const test::TemporaryFolder folder;
    const auto results = read_all_results(folder.path());
    ASSERT_TRUE(results) << results.error().message;
    const auto page = findings_page(*results);
    ASSERT_TRUE(page) << page.error().message;
    EXPECT_THAT(*page, Not(HasSubstr("distance.svg)")));
    // J's table against J's text is all that is left.
    EXPECT_EQ(occurrences(*page, "| **refuted** |"), 2U);
    EXPECT_EQ(occurrences(*page, "| **confirmed** |"), 1U);
    EXPECT_EQ(occurrences(*page, "| **depends** |"), 0U);
    EXPECT_THAT(*page, Not(HasSubstr("In return")));
}

TEST(Findings, ReadNoResultsOfAnotherSuite) {
    for (const auto& [file, text, expected] :
         {std::tuple("objects.json", R"("rows": [{"suite": "tables"}])",
                     "tables found, those of "
                     "objects were"),
          {"distance.json", R"("suite": "tables-claims", "rows": [])",
           "tables-claims found, those of tables-distances were"}}) {
        const test::TemporaryFolder folder;
        const auto path =
            folder.write(file, fmt::format(R"({{"schema": "reljef-bench/1", {}}})", text));
        const auto results = read_all_results(folder.path());
        ASSERT_FALSE(results) << file;
        EXPECT_EQ(results.error().message,
                  fmt::format("{}: results of {} expected", path.string(), expected));
    }
}

TEST(Findings, ASentenceThatDoesNotHoldIsLeftOut) {
    const test::TemporaryFolder folder;
    folder.write("tables.json",
                 R"({"schema": "reljef-bench/1", "rows": [{"test": "relief-1",)"
                 R"( "label": "texture", "error": {"wrong_of_terrain_percent": 20}}]})");
    const std::vector<std::string> files{"tables.json"};
    const auto results = CommittedResults::read(folder.path(), files);
    ASSERT_TRUE(results);
    const RowName row = source_test("relief-1", {scene::Texture{}});
    Findings findings;
    findings.summary = {{"Over 10: {}.", {plain("", Quantity::wrong, row, at_least(10.0))}},
                        {"Over 30: {}.", {plain("", Quantity::wrong, row, at_least(30.0))}}};
    findings.limits = "- Only here.\n";
    findings.chapters = {{"What?",
                          {{"At most 30: {}.", {plain("", Quantity::wrong, row, at_most(30.0))}},
                           {"At most 10: {}.", {plain("", Quantity::wrong, row, at_most(10.0))}}},
                          {{"J 1",
                            "It is small.",
                            "at most 10 %",
                            {plain("it", Quantity::wrong, row, at_most(10.0))},
                            "",
                            "It grew."},
                           {"J 2",
                            "It is large.",
                            "over 10 %",
                            {plain("it", Quantity::wrong, row, at_least(10.0))},
                            "",
                            "It shrank."}}}};
    const auto page = findings_page(findings, {}, *results);
    ASSERT_TRUE(page) << page.error().message;
    EXPECT_THAT(*page, HasSubstr("At most 30: 20.0\u00a0%.\n"));
    EXPECT_THAT(*page, Not(HasSubstr("At most 10")));
    EXPECT_THAT(*page,
                HasSubstr("| J 1 | It is small. | at most 10 % | it: 20.0\u00a0% | **refuted** |"));
    EXPECT_THAT(*page,
                HasSubstr("| J 2 | It is large. | over 10 % | it: 20.0\u00a0% | **confirmed** |"));
    EXPECT_THAT(*page, HasSubstr("Of 2 conclusions, 1 are confirmed, 1 are refuted"));
    EXPECT_THAT(*page, HasSubstr("## In short\n\n- Over 10: 20.0\u00a0%.\n"));
    EXPECT_THAT(*page, Not(HasSubstr("Over 30")));
    EXPECT_THAT(*page, HasSubstr("Why some do not hold:\n\n- *It is small.* It grew.\n"));
    EXPECT_THAT(*page, Not(HasSubstr("It shrank")));
    EXPECT_THAT(*page, HasSubstr("## How far this holds\n\n- Only here.\n"));
}

TEST(Findings, GiveAReasonForEachConclusionThatDoesNotHold) {
    const auto results = read_all_results(source_folder() / "bench" / "results");
    ASSERT_TRUE(results) << results.error().message;
    for (const Chapter& chapter : all_findings().chapters) {
        EXPECT_FALSE(chapter.answer.empty()) << chapter.question;
        for (const Conclusion& conclusion : chapter.conclusions) {
            const auto judgement = judge(conclusion, *results);
            ASSERT_TRUE(judgement) << judgement.error().message;
            const bool fails =
                judgement->verdict == Finding::refuted || judgement->verdict == Finding::depends;
            EXPECT_TRUE(!fails || conclusion.reason.ends_with('.')) << conclusion.claim;
        }
    }
}

TEST(Findings, ShowTheFiguresOfAGpuApart) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "h100");
    const std::string row = R"("rows": [{"test": "relief-1", "label": "texture", "noise_floor": 0,)"
                            R"( "ms": {"median": 4}}]})";
    folder.write("tables.json", R"({"schema": "reljef-bench/1", "environment": {"cpu": "slow",)"
                                R"( "context": "egl", "renderer": "llvmpipe"}, )" +
                                    row);
    folder.write("h100/tables.json", R"({"schema": "reljef-bench/1", "environment": {)"
                                     R"("cpu": "fast", "context": "egl", "renderer": "H100"}, )" +
                                         row);
    const std::vector<ResultsSource> sources{{"tables", "", ""}, {"h100/tables", "", ""}};
    const std::vector<std::string> files{"tables.json", "h100/tables.json"};
    const auto results = CommittedResults::read(folder.path(), files);
    ASSERT_TRUE(results) << results.error().message;
    const Figure rate = frame_rate("", source_test("relief-1", {scene::Texture{}}), at_least(1.0));
    Findings findings;
    findings.chapters = {{"What?", {}, {{"J 1", "It is fast.", "always", and_on_gpu({rate})}}}};
    const auto page = findings_page(findings, sources, *results);
    ASSERT_TRUE(page) << page.error().message;
    EXPECT_THAT(*page, HasSubstr("| CPU: 250\u00a0a second<br>GPU: 250\u00a0a second |"));
    EXPECT_THAT(*page, HasSubstr("[tables](findings.md#tables), A; "
                                 "[h100/tables](findings.md#h100tables), B |"));
}

TEST(FindingsCommand, PrintsThePageOrWritesIt) {
    const std::string results = (source_folder() / "bench" / "results").string();
    EXPECT_EQ(test::reljef_bench({"findings", "--results", results}).out, committed_page());
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "page.md";
    const auto plot = folder.path() / "plot.svg";
    const auto run = test::reljef_bench(
        {"findings", "--results", results, "--markdown", file.string(), "--plot", plot.string()});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(test::read_bytes(file), committed_page());
    EXPECT_THAT(test::read_bytes(plot), HasSubstr("</svg>"));
    const auto refused = test::reljef_bench(
        {"findings", "--results", results, "--markdown", file.string(), "--plot", file.string()});
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
}

} // namespace
} // namespace reljef::bench
