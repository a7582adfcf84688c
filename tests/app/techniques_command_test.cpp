#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/scene/technique/technique.h"
#include "tests/app/command_line.h"

namespace reljef {
namespace {

TEST(TechniquesCommand, json_lists_the_catalogue_with_ranges) {
    const auto result = test::reljef({"techniques", "--json"});
    ASSERT_EQ(result.exit_code, 0);
    const auto list = nlohmann::json::parse(result.out);
    const auto catalogue = scene::technique_catalogue();
    ASSERT_EQ(list.size(), catalogue.size());
    for (std::size_t i = 0; i < catalogue.size(); ++i) {
        EXPECT_EQ(list[i]["id"], std::string(catalogue[i].name));
        EXPECT_FALSE(list[i]["source"].get<std::string>().empty());
        for (const auto& parameter : list[i]["parameters"]) {
            EXPECT_LE(parameter["low"], parameter["default"]);
            EXPECT_LE(parameter["default"], parameter["high"]);
            EXPECT_FALSE(parameter["meaning"].get<std::string>().empty());
        }
        ASSERT_EQ(list[i]["options"].size(), scene::options_of(catalogue[i].id).size());
        for (const auto& option : list[i]["options"]) {
            for (const char* key : {"name", "form", "default", "meaning"}) {
                EXPECT_FALSE(option[key].get<std::string>().empty()) << key;
            }
            for (const auto& number : option["numbers"]) {
                EXPECT_LE(number["low"], number["high"]);
            }
        }
    }
}

// "| `relief` | `n` | 11 | 1 to 4096 | equal steps along the ray |"
std::string table_row(const std::string& owner, const nlohmann::json& number) {
    const std::string range =
        number.contains("min_above_low")
            ? fmt::format("{}, {} to {}", number["low"].get<double>(),
                          number["min_above_low"].get<double>(), number["high"].get<double>())
            : fmt::format("{} to {}", number["low"].get<double>(), number["high"].get<double>());
    return fmt::format("| `{}` | `{}` | {} | {} | {} |", owner, number["name"].get<std::string>(),
                       number["default"].get<double>(), range,
                       number["meaning"].get<std::string>());
}

// The rows of the pages' tables of parameters.
std::multiset<std::string> shown_rows() {
    std::multiset<std::string> rows;
    for (const auto& entry : std::filesystem::directory_iterator(RELJEF_TECHNIQUE_PAGES)) {
        std::ifstream page(entry.path());
        for (std::string line; std::getline(page, line);) {
            if (line.rfind("| `", 0) == 0 && std::count(line.begin(), line.end(), '|') == 6) {
                rows.insert(line);
            }
        }
    }
    return rows;
}

TEST(TechniquesCommand, every_parameter_stands_once_in_the_pages_as_it_is) {
    const auto list = nlohmann::json::parse(test::reljef({"techniques", "--json"}).out);
    std::set<std::string> expected;
    for (const auto& technique : list) {
        for (const auto& parameter : technique["parameters"]) {
            expected.insert(table_row(technique["id"], parameter));
        }
        for (const auto& option : technique["options"]) {
            for (const auto& number : option["numbers"]) {
                expected.insert(table_row(option["name"], number));
            }
        }
    }
    const auto shown = shown_rows();
    EXPECT_EQ(shown, std::multiset<std::string>(expected.begin(), expected.end()));
}

TEST(TechniquesCommand, version_and_help_succeed) {
    EXPECT_EQ(test::reljef({"--version"}).out.rfind("reljef ", 0), 0U);
    for (const char* verb : {"view", "render", "info", "height", "maps", "techniques"}) {
        const auto help = test::reljef({verb, "--help"});
        EXPECT_EQ(help.exit_code, 0);
        EXPECT_NE(help.out.find("Example"), std::string::npos) << verb;
    }
}

} // namespace
} // namespace reljef
