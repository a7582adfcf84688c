#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/scene/technique.h"
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
