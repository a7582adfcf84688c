#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/atomic_file.h"
#include "engine/io/formats/scene_file.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

struct KnownTable {
    std::string header; // empty: the top of the file
    std::string keys;   // without which an earlier error is reported
};

// The keys that the reader knows, from its error for one that it does not know.
std::vector<std::string> known_keys(const KnownTable& table) {
    const std::string generator = table.header == "[gallery]" ? "gallery" : "urban";
    const std::string terrain = "[terrain]\ngenerator = \"" + generator + "\"\n";
    const bool is_terrain = table.header == "[terrain]";
    const std::string text = table.header.empty()
                                 ? "unknown_key = 1\n" + terrain
                                 : (is_terrain ? terrain : terrain + table.header + "\n") +
                                       table.keys + "unknown_key = 1\n";
    const auto scene = parse_scene(text, "scene.toml", "/folder");
    EXPECT_FALSE(scene) << text;
    const std::string message = scene ? "" : scene.error().message;
    std::smatch found;
    const std::regex list("unknown_key is unknown, one of (.*) was expected");
    EXPECT_TRUE(std::regex_search(message, found, list)) << message;
    std::vector<std::string> keys;
    const std::string names = found.size() > 1 ? found[1].str() : "";
    const std::regex word("[a-z_]+");
    for (std::sregex_iterator i(names.begin(), names.end(), word), end; i != end; ++i) {
        keys.push_back(i->str());
    }
    return keys;
}

const std::vector<KnownTable>& known_tables() {
    static const std::vector<KnownTable> tables{
        {"", ""},
        {"[terrain]", ""},
        {"[area]", "south = 1\nwest = 1\nnorth = 2\neast = 2\n"},
        {"[gallery]", ""},
        {"[detail]", ""},
        {"[sun]", ""},
        {"[air]", ""},
        {"[picture]", ""},
        {"[camera]", ""},
        {"[surface_shader]", "file = \"a.glsl\"\n"},
        {"[[object]]", "file = \"a.obj\"\nat = [1, 2]\n"},
        {"[[footprints]]", "file = \"a.geojson\"\nheight = \"h\"\n"},
        {"[[light]]", "azimuth = 1\naltitude = 2\n"},
        {"[[point_light]]", "at = [1, 2]\n"}};
    return tables;
}

fs::path source_folder() {
    return fs::path(__FILE__).parent_path().parent_path().parent_path().parent_path();
}

// Lines of all scene files that come with reljef, by their table; comments count.
bool is_in_an_example(const std::string& header, const std::string& key) {
    for (const fs::directory_entry& file : fs::directory_iterator(source_folder() / "terrains")) {
        if (file.path().extension() != ".toml") {
            continue;
        }
        std::string text = read_text_file(file.path()).value();
        text = std::regex_replace(text, std::regex("(^|\n)# "), "$1");
        std::string table;
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            const std::string line = text.substr(begin, end - begin);
            begin = end + 1;
            if (line.starts_with('[')) {
                table = line.substr(0, line.rfind(']', line.find_first_of(" #")) + 1);
            } else if (table == header && line.starts_with(key + " = ")) {
                return true;
            }
        }
    }
    return false;
}

TEST(SceneKeys, AllTablesAreKnownToThisTest) {
    for (const std::string& key : known_keys({"", ""})) {
        const bool is_table = std::ranges::any_of(known_tables(), [&](const KnownTable& table) {
            return table.header == "[" + key + "]" || table.header == "[[" + key + "]]";
        });
        EXPECT_TRUE(is_table || key == "name") << key;
    }
}

TEST(SceneKeys, EachIsInTheDocumentation) {
    const std::string page = read_text_file(source_folder() / "docs" / "scene_files.md").value();
    for (const KnownTable& table : known_tables()) {
        EXPECT_THAT(page, testing::HasSubstr(table.header.empty() ? "`name`" : table.header));
        for (const std::string& key : known_keys(table)) {
            const bool is_named = page.find("`" + key + "`") != std::string::npos ||
                                  page.find("`[" + key + "]`") != std::string::npos ||
                                  page.find("`[[" + key + "]]`") != std::string::npos;
            EXPECT_TRUE(is_named) << table.header << ' ' << key;
        }
    }
}

TEST(SceneKeys, EachIsInAnExample) {
    for (const KnownTable& table : known_tables()) {
        if (table.header.empty()) {
            continue; // the tables themselves
        }
        const auto keys = known_keys(table);
        EXPECT_FALSE(keys.empty()) << table.header;
        for (const std::string& key : keys) {
            EXPECT_TRUE(is_in_an_example(table.header, key)) << table.header << ' ' << key;
        }
    }
}

} // namespace
} // namespace reljef::io
