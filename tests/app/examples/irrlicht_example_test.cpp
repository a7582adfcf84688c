// The programs of docs/irrlicht.md.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/command_line.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

using testing::HasSubstr;

std::string grey_slope() {
    std::string text = "P5\n32 32\n255\n";
    for (int i = 0; i < 32 * 32; ++i) {
        text += static_cast<char>(4 * (i % 32));
    }
    return text;
}

test::ProgramResult run_example(const std::string& answer, test::ProgramOptions options) {
    const test::TemporaryFolder folder;
    const auto heights = folder.write("heights.pgm", grey_slope());
    const auto colors = folder.write("colors.pgm", grey_slope());
    options.input = folder.write("answer", answer);
    return test::run_program(RELJEF_IRRLICHT_EXAMPLE, {heights.string(), colors.string(), "2"},
                             options);
}

// Of each C++ block of the page.
std::vector<int> lines_of_programs() {
    std::ifstream page(RELJEF_IRRLICHT_PAGE);
    std::vector<int> lines;
    bool inside = false;
    for (std::string line; std::getline(page, line);) {
        if (line.rfind("```", 0) == 0) {
            inside = line == "```cpp";
            lines.resize(lines.size() + (inside ? 1 : 0));
        } else if (inside) {
            ++lines.back();
        }
    }
    return lines;
}

TEST(IrrlichtExample, HasAtMost120Lines) {
    const std::vector<int> lines = lines_of_programs();
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_GT(lines[0], 50);
    EXPECT_LE(lines[0], 120);
    EXPECT_LE(lines[1], 60);
}

// "Scene::add_mesh", "session::Device" …
std::vector<std::string> names_on_page() {
    const std::string page = test::read_bytes(RELJEF_IRRLICHT_PAGE);
    const std::regex name(
        R"(\b(?:scene|session|platform|view|material|io|building|Scene|Node|Material)::(\w+))");
    std::vector<std::string> names;
    for (std::sregex_iterator found(page.begin(), page.end(), name), end; found != end; ++found) {
        names.push_back((*found)[1]);
    }
    return names;
}

// The words of a text: letters, digits and '_'.
std::set<std::string> words_of(const std::string& text) {
    std::set<std::string> words;
    std::string word;
    for (const char c : text + " ") {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
            word += c;
        } else if (!word.empty()) {
            words.insert(std::exchange(word, {}));
        }
    }
    return words;
}

TEST(IrrlichtExample, ThePageNamesWhatTheLibraryHas) {
    const auto engine = std::filesystem::path(RELJEF_IRRLICHT_PAGE).parent_path() / ".." / "engine";
    std::set<std::string> words;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(engine)) {
        if (entry.path().extension() == ".h") {
            words.merge(words_of(test::read_bytes(entry.path())));
        }
    }
    const auto names = names_on_page();
    EXPECT_GE(names.size(), 30U);
    for (const std::string& name : names) {
        EXPECT_TRUE(words.contains(name)) << name;
    }
}

TEST(IrrlichtExample, DrawsReliefAndParallaxInAWindow) {
    RELJEF_RELEASE_ONLY("it is built with all tests only");
    if (!test::has_display()) {
        GTEST_SKIP() << "no display";
    }
    for (const std::string answer : {"y\n", "n\n"}) {
        const auto result = run_example(answer, {});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
    }
}

TEST(IrrlichtExample, WhatMovesIsDrawnWithoutAWindow) {
    RELJEF_RELEASE_ONLY("it is built with all tests only");
    const test::TemporaryFolder folder;
    std::string heights = "P5\n201 201\n255\n";
    for (int i = 0; i < 201 * 201; ++i) {
        heights += static_cast<char>(20 + i % 201 / 10);
    }
    const auto ground = folder.write("heights.pgm", heights);
    test::ProgramOptions options;
    options.folder = folder.path();
    const auto result = test::run_program(RELJEF_MOTION_EXAMPLE, {ground.string()}, options);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string first = test::read_bytes(folder.path() / "walk-1.png");
    const std::string second = test::read_bytes(folder.path() / "walk-2.png");
    EXPECT_GT(first.size(), 1000U);
    EXPECT_NE(first, second);
}

TEST(IrrlichtExample, WithoutADisplayOrPicturesFailsInOneSentence) {
    RELJEF_RELEASE_ONLY("it is built with all tests only");
    test::ProgramOptions options;
    options.environment = {{"DISPLAY", std::nullopt}, {"WAYLAND_DISPLAY", std::nullopt}};
    const auto no_display = run_example("y\n", options);
    EXPECT_EQ(no_display.exit_code, 1);
    EXPECT_THAT(no_display.err, HasSubstr("no display"));
    EXPECT_EQ(std::count(no_display.err.begin(), no_display.err.end(), '\n'), 1) << no_display.err;
    const auto no_pictures = test::run_program(RELJEF_IRRLICHT_EXAMPLE, {});
    EXPECT_EQ(no_pictures.exit_code, 1);
    EXPECT_THAT(no_pictures.err, HasSubstr("two pictures were expected"));
}

} // namespace
} // namespace reljef
