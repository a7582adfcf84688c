#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

using Words = std::vector<std::string>;

constexpr int width = 320;
constexpr int height = 240;

class Marks : public testing::Test {
protected:
    Image render(const Words& options, const std::string& terrain = {}) {
        const auto file = (folder_.path() / "marks.png").string();
        Words arguments{"render",  terrain.empty() ? natural_ : terrain,
                        "--size",  "320x240",
                        "--grain", "0",
                        "-o",      file};
        arguments.insert(arguments.end(), options.begin(), options.end());
        result_ = test::reljef(arguments);
        EXPECT_EQ(result_.exit_code, 0) << result_.err;
        return io::read_image(file).value();
    }

    test::TemporaryFolder folder_;
    std::string natural_ = test::small_terrain(folder_, "natural");
    test::ProgramResult result_;
};

int changed_pixels(const Image& a, const Image& b, glm::ivec2 low, glm::ivec2 high) {
    int count = 0;
    for (int row = low.y; row < high.y; ++row) {
        for (int col = low.x; col < high.x; ++col) {
            count += a(col, row) != b(col, row) ? 1 : 0;
        }
    }
    return count;
}

TEST_F(Marks, AreDrawnAlikeByAllContexts) {
    std::vector<Image> drawn;
    for (const char* context : {"cpu", "osmesa"}) {
        const Words map{"--projection", "orthographic",    "--context",
                        context,        "--imagery-share", "0.5"};
        Words marked = map;
        marked.insert(marked.end(), {"--marks", "legend,scale,north"});
        const Image plain = render(map);
        const Image picture = render(marked);
        EXPECT_GT(changed_pixels(plain, picture, {0, height / 2}, {width / 2, height}), 150);
        EXPECT_GT(changed_pixels(plain, picture, {width / 2, height / 2}, {width, height}), 900);
        EXPECT_GT(changed_pixels(plain, picture, {width / 2, 0}, {width, height / 2}), 200);
        EXPECT_EQ(changed_pixels(plain, picture, {0, 0}, {width / 2, height / 2}), 0);
        // Ink and ramp are the same wherever the plain pictures are.
        drawn.push_back(picture);
    }
    int ink = 0;
    int shared_ink = 0;
    for (std::size_t i = 0; i < drawn[0].size(); ++i) {
        constexpr Rgba8 full_ink{38, 31, 25, 255};
        ink += drawn[0].samples()[i] == full_ink ? 1 : 0;
        shared_ink += drawn[0].samples()[i] == full_ink && drawn[1].samples()[i] == full_ink;
    }
    EXPECT_GT(ink, 20);
    EXPECT_EQ(shared_ink, ink);
}

TEST_F(Marks, HitsAndFiguresAreWithoutThem) {
    const auto hits = [&](const Words& options) {
        const auto file = folder_.path() / "hit.exr";
        Words all{"--hit", file.string()};
        all.insert(all.end(), options.begin(), options.end());
        render(all);
        std::ifstream stream(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    const std::string plain = hits({});
    EXPECT_FALSE(plain.empty());
    EXPECT_TRUE(hits({"--marks", "legend,scale,north"}) == plain);
    render({"--compare", "truth"});
    const std::string figures = result_.out;
    EXPECT_FALSE(figures.empty());
    render({"--compare", "truth", "--marks", "legend,scale"});
    EXPECT_EQ(result_.out, figures);
}

TEST_F(Marks, ASceneFileNamesThemAndSamplesAndOptionsComeFirst) {
    const auto scene = [&](const std::string& name, const std::string& keys) {
        return folder_
            .write(name, "[terrain]\ngenerator = \"natural\"\nsize = 129\n[picture]\n" + keys)
            .string();
    };
    const std::string marked = scene("marked.toml", "marks = \"north\"\n");
    const std::string smooth = scene("smooth.toml", "samples = 1\n");
    const std::string usual = scene("usual.toml", "");
    const Words gl{"--context", "osmesa"};
    const Image plain = render(gl, usual);
    const Image north = render(gl, marked);
    EXPECT_NE(north, plain);
    EXPECT_EQ(render({"--context", "osmesa", "--marks", "north"}, usual), north);
    EXPECT_EQ(render({"--context", "osmesa", "--marks", "none"}, marked), plain);
    const Image single = render(gl, smooth);
    EXPECT_NE(single, plain); // 4 samples
    EXPECT_EQ(render({"--context", "osmesa", "--samples", "1"}, usual), single);
    EXPECT_EQ(render({"--context", "osmesa", "--samples", "4"}, smooth), plain);
}

TEST_F(Marks, WrongWordsAreRefused) {
    for (const char* words : {"compass", "legend,", "legend,none", "legend scale"}) {
        test::expect_refusal(
            test::reljef({"render", natural_, "-o", "never.png", "--marks", words}), 2,
            {"--marks", "some of legend, scale, north"});
    }
    const auto refused = [&](const std::string& keys, const char* sentence) {
        const auto file =
            folder_.write("bad.toml", "[terrain]\ngenerator = \"natural\"\n[picture]\n" + keys);
        test::expect_refusal(test::reljef({"render", file.string(), "-o", "never.png"}), 1,
                             {sentence});
    };
    refused("marks = \"compass\"", "[picture] marks is \"compass\", some of legend");
    refused("marks = 3", "[picture] marks is 3");
    refused("samples = 3", "[picture] samples is 3, one of 1, 2, 4, 8, 16 was expected");
    refused("samples = 32", "[picture] samples is 32, a whole number from 1 to 16");
    refused("samples = \"many\"", "[picture] samples is 'many'");
}

TEST_F(Marks, ContoursThatAreTooCloseAreNotedOnce) {
    render({"--contours", "0.1"});
    EXPECT_THAT(result_.err, testing::HasSubstr("contours every 0.1 m are too close"));
    EXPECT_THAT(result_.err, testing::HasSubstr("would show here, every 0.1 m from within"));
    render({"--contours", "50"});
    EXPECT_THAT(result_.err, testing::Not(testing::HasSubstr("contours")));
    render({"--contours", "0.1", "--truth"});
    EXPECT_THAT(result_.err, testing::Not(testing::HasSubstr("too close")));
}

TEST_F(Marks, WhatCannotBeDrawnIsNoted) {
    render({"--marks", "legend,north"}, test::small_terrain(folder_, "urban"));
    EXPECT_THAT(result_.err, testing::HasSubstr("no legend is drawn"));
    render({"--marks", "legend", "--imagery-share", "0.5"}, test::small_terrain(folder_, "urban"));
    EXPECT_THAT(result_.err, testing::Not(testing::HasSubstr("no legend is drawn")));
}

} // namespace
} // namespace reljef
