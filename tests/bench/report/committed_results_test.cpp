// The documentation quotes measured results.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bench/report/report_json.h"

namespace reljef::bench {
namespace {

const std::filesystem::path source(RELJEF_SOURCE);

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                            std::string_view extension) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == extension) {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

// The rows of the tables with times of techniques.
std::vector<std::string> measured_rows(const std::filesystem::path& page) {
    std::ifstream stream(page);
    std::vector<std::string> rows;
    for (std::string line; std::getline(stream, line);) {
        if (line.rfind("| ", 0) == 0 && line.find(" % |") != std::string::npos) {
            rows.push_back(line);
        }
    }
    return rows;
}

std::set<std::string> committed_rows() {
    std::set<std::string> rows;
    for (const auto& file : files_in(source / "bench" / "results", ".md")) {
        const auto more = measured_rows(file);
        rows.insert(more.begin(), more.end());
    }
    return rows;
}

TEST(CommittedResults, are_what_readme_and_pages_show) {
    const std::set<std::string> committed = committed_rows();
    std::vector<std::filesystem::path> pages = files_in(source / "docs" / "techniques", ".md");
    pages.push_back(source / "README.md");
    std::size_t shown = 0;
    for (const auto& page : pages) {
        for (const std::string& row : measured_rows(page)) {
            EXPECT_TRUE(committed.contains(row)) << page << ": " << row;
            ++shown;
        }
    }
    EXPECT_GE(shown, 20U);
}

TEST(CommittedResults, of_the_tables_are_whole_and_miss_no_technique) {
    const Result<Results> tables = read_json_report(source / "bench" / "results" / "tables.json");
    ASSERT_TRUE(tables) << tables.error().message;
    EXPECT_FALSE(tables->stopped);
    EXPECT_TRUE(tables->left_out.empty());
    std::set<std::string> tests;
    for (const Row& row : tables->rows) {
        EXPECT_TRUE(row.error || row.null_row) << row.test << ' ' << row.setting.label;
        tests.insert(row.test);
    }
    EXPECT_EQ(tests.size(), 7U);
}

} // namespace
} // namespace reljef::bench
