#include "bench/options/output_options.h"

#include <array>
#include <filesystem>
#include <fstream>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/page/page.h"
#include "tests/bench/bench_program.h"
#include "tests/bench/report/made_results.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

void expect_output_refusal(const std::string& suite, const std::string& terrain,
                           const std::vector<std::string>& arguments, int exit_code) {
    std::vector<std::string> all{suite, "--terrain", terrain};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const auto result = test::reljef_bench(all);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

TEST(BenchOutputs, are_all_checked_before_anything_is_measured) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", test::small_dem).string();
    const auto same = (folder.path() / "t.out").string();
    const std::vector<std::vector<std::string>> unwritable{{"--csv", "/nonexistent/t.csv"},
                                                           {"--markdown", "/nonexistent/t.md"}};
    for (const std::vector<std::string>& arguments : unwritable) {
        expect_output_refusal("tables", dem, arguments, 1);
    }
    const std::vector<std::vector<std::string>> misuses{{"--json", same, "--csv", same},
                                                        {"--csv", same, "--markdown", same},
                                                        {"--csv", dem},
                                                        {"--markdown", dem}};
    for (const char* suite : {"tables", "pareto"}) {
        expect_output_refusal(suite, dem, {"--json", same, "--csv", folder.path().string()}, 1);
    }
    for (const std::vector<std::string>& arguments : misuses) {
        for (const char* suite : {"tables", "pareto"}) {
            if (std::string_view(suite) == "tables" || arguments.size() == 4) {
                expect_output_refusal(suite, dem, arguments, 2);
            }
        }
    }
    EXPECT_THAT(folder.names(), ElementsAre("dem.asc"));
    EXPECT_EQ(test::read_bytes(dem), test::small_dem);
}

TEST(BenchOutputs, none_is_standard_output) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", test::small_dem).string();
    for (const char* const option : {"--json", "--csv", "--markdown"}) {
        expect_output_refusal("tables", dem, {option, "-"}, 2);
    }
    for (const char* const option : {"--markdown", "--plot"}) {
        const auto result = test::reljef_bench({"findings", option, "-"});
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_THAT(result.err,
                    HasSubstr(std::string(option) + ": '-' found, a file was expected"));
    }
    EXPECT_FALSE(std::filesystem::exists("-"));
}

TEST(BenchOutputs, one_that_fails_keeps_the_others_from_appearing) {
    const test::TemporaryFolder folder;
    const auto json = folder.write("t.json", "earlier");
    const OutputChoice choice{json, folder.path() / "gone" / "t.csv", {}, {}};
    testing::internal::CaptureStdout();
    const auto done = report(test::made_results(), choice);
    EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("polygons"));
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("gone"));
    EXPECT_EQ(test::read_bytes(json), "earlier");
    EXPECT_THAT(folder.names(), ElementsAre("t.json"));
}

TEST(BenchOutputs, page_holds_the_pictures_of_the_rows_that_have_a_view) {
    const test::TemporaryFolder folder;
    Results results = test::made_results();
    results.rows[0].view =
        RowViews()
            .make({Image(32, 24), std::make_shared<const Image>(32, 24), Grid<float>(32, 24, 0.5F)})
            .value();
    testing::internal::CaptureStdout();
    const auto done =
        report(results, {.json = {}, .csv = {}, .markdown = {}, .html = folder.path() / "page"});
    testing::internal::GetCapturedStdout();
    ASSERT_TRUE(done) << done.error().message;
    const std::string page = test::read_bytes(folder.path() / "page" / "index.html");
    EXPECT_THAT(page, HasSubstr("data:image/png;base64,"));
    EXPECT_THAT(page, HasSubstr("reljef-bench/1"));
}

TEST(BenchOutputs, page_that_cannot_be_written_is_refused_before_measuring) {
    const test::TemporaryFolder folder;
    const auto dem = folder.write("dem.asc", test::small_dem).string();
    const auto result = test::reljef_bench(
        {"tables", "--terrain", dem, "--html", (folder.path() / "no" / "page").string()});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("no"));
    EXPECT_EQ(result.out, "");
}

TEST(BenchOutputs, folder_named_with_a_slash_at_its_end_is_that_folder) {
    const test::TemporaryFolder folder;
    const OutputChoice choice{{}, {}, {}, folder.path() / "page" / ""};
    for (int time = 0; time < 2; ++time) { // without and with the folder
        ASSERT_TRUE(check_outputs(choice, {}));
        testing::internal::CaptureStdout();
        const auto done = report(test::made_results(), choice);
        testing::internal::GetCapturedStdout();
        ASSERT_TRUE(done) << done.error().message;
        EXPECT_THAT(test::read_bytes(folder.path() / "page" / "index.html"), HasSubstr("<html"));
    }
    EXPECT_THAT(folder.names(), ElementsAre("page"));
}

// The usage error; empty if there is none.
std::string misuse_of(const OutputChoice& choice) {
    try {
        static_cast<void>(check_outputs(choice, {}));
    } catch (const CLI::ParseError& error) {
        return error.what();
    }
    return "";
}

TEST(BenchOutputs, page_and_another_output_in_one_file_are_refused) {
    const test::TemporaryFolder folder;
    const auto page = folder.path() / "page";
    for (const auto& html : {page, page / ""}) {
        for (const auto& json : {page / "index.html", page}) {
            const std::string refused = misuse_of({json, {}, {}, html});
            EXPECT_THAT(refused, HasSubstr("--json"));
            EXPECT_THAT(refused, HasSubstr("--html"));
        }
    }
    std::filesystem::create_directory(page);
    EXPECT_NE(misuse_of({page / "index.html", {}, {}, page}), "");
    EXPECT_TRUE(check_outputs({page / "t.json", {}, {}, page}, {}));
}

TEST(BenchOutputs, run_without_rows_leaves_earlier_files_alone) {
    const test::TemporaryFolder folder;
    const auto json = folder.write("t.json", "earlier");
    Results nothing;
    nothing.stopped = Error{"interrupted before the first frame was timed"};
    const auto done = report(nothing, {json, {}, {}, {}});
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, "interrupted before the first frame was timed");
    EXPECT_EQ(test::read_bytes(json), "earlier");
}

TEST(BenchOutputs, files_that_a_scene_file_names_are_inputs_too) {
    const test::TemporaryFolder folder;
    folder.write("dem.asc", test::small_dem);
    const auto scene =
        folder.write("s.toml", "name = \"a scene\"\n[terrain]\nheights = \"dem.asc\"\n");
    const auto result = test::reljef_bench(
        {"tables", "--terrain", scene.string(), "--json", (folder.path() / "dem.asc").string()});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("read as the terrain's heights"));
    EXPECT_EQ(test::read_bytes(folder.path() / "dem.asc"), test::small_dem);
}

TEST(BenchOutputs, page_that_fails_keeps_the_other_files_as_they_were) {
    const test::TemporaryFolder folder;
    const auto json = folder.write("t.json", "earlier");
    std::filesystem::create_directories(folder.path() / "page" / "index.html");
    testing::internal::CaptureStdout();
    const auto done = report(test::made_results(), {json, {}, {}, folder.path() / "page"});
    testing::internal::GetCapturedStdout();
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("index.html"));
    EXPECT_EQ(test::read_bytes(json), "earlier");
}

TEST(BenchOutputs, folder_that_was_made_goes_again_where_it_stays_empty) {
    const test::TemporaryFolder folder;
    const auto page = folder.path() / "page";
    ASSERT_TRUE(make_folder(page));
    EXPECT_FALSE(std::filesystem::exists(page)); // the object is gone
    {
        const auto made = make_folder(page);
        ASSERT_TRUE(made);
        std::ofstream(page / "a file") << "kept";
    }
    EXPECT_TRUE(std::filesystem::exists(page / "a file"));
    std::filesystem::remove(page / "a file");
    ASSERT_TRUE(make_folder(page));
    EXPECT_TRUE(std::filesystem::exists(page)); // it was there before
}

TEST(BenchOutputs, file_in_place_of_the_page_s_folder_is_called_one) {
    const test::TemporaryFolder folder;
    const auto file = folder.write("old.json", "earlier");
    EXPECT_THAT(misuse_of({{}, {}, {}, file}), HasSubstr("which is a file; a folder was expected"));
    EXPECT_EQ(test::read_bytes(file), "earlier");
}

TEST(BenchOutputs, run_that_failed_on_the_way_keeps_earlier_results) {
    const test::TemporaryFolder folder;
    const auto json = folder.write("t.json", "earlier");
    Results part = test::made_results();
    part.stopped = Error{"b.asc, low: no pixel of terrain found"};
    part.failed = true;
    testing::internal::CaptureStdout();
    const auto done = report(part, {json, {}, {}, folder.path() / "page"});
    EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("polygons"));
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, part.stopped->message);
    EXPECT_EQ(test::read_bytes(json), "earlier");
    EXPECT_THAT(folder.names(), ElementsAre("t.json"));
}

TEST(BenchOutputs, run_that_ended_early_is_written_and_fails) {
    const test::TemporaryFolder folder;
    Results part = test::made_results();
    part.stopped = Error{"interrupted, the table holds the frames drawn until then"};
    testing::internal::CaptureStdout();
    const auto done = report(part, {folder.path() / "a.json", folder.path() / "b.csv", {}, {}});
    testing::internal::GetCapturedStdout();
    ASSERT_FALSE(done);
    EXPECT_THAT(folder.names(), ElementsAre("a.json", "b.csv"));
}

} // namespace
} // namespace reljef::bench
