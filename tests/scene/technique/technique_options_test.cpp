#include "engine/scene/technique/technique_options.h"

#include <algorithm>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/scene/graph/scene.h"
#include "engine/scene/technique/technique.h"
#include "tests/scene/technique/random_technique.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(TechniqueOptions, AnyTechniqueComesBackFromItsText) {
    test::Chance chance(4);
    for (int i = 0; i < 500; ++i) {
        for (const TechniqueInfo& info : technique_catalogue()) {
            const Technique technique = random_technique(info, chance);
            const std::string text = to_string(technique);
            const auto again = parse_technique(text);
            ASSERT_TRUE(again) << again.error().message;
            EXPECT_EQ(*again, technique) << text;
            EXPECT_EQ(to_string(*again), text);
        }
    }
}

// One of another option, or of none, would do what was not asked for.
TEST(TechniqueOptions, EveryChoiceIsItsOwnAndIsTakenBack) {
    for (const OptionInfo& info : option_catalogue()) {
        EXPECT_EQ(info.chosen(TechniqueOptions{}), std::nullopt) << info.name;
        for (std::size_t word = 0; word < std::max<std::size_t>(info.words.size(), 1); ++word) {
            TechniqueOptions options;
            info.choose(options, word);
            const bool is_usual = options == TechniqueOptions{};
            EXPECT_EQ(is_usual, !info.words.empty() && info.words[word] == info.default_value);
            EXPECT_EQ(info.chosen(options), is_usual ? std::nullopt : std::optional(word));
            for (const OptionInfo& other : option_catalogue()) {
                EXPECT_EQ(other.chosen(options).has_value(), !is_usual && other.name == info.name);
            }
            info.choose(options, std::nullopt);
            EXPECT_EQ(options, TechniqueOptions{}) << info.name;
        }
    }
}

TEST(TechniqueOptions, EveryNumberReadsAndWritesItsOwnMemberOnly) {
    test::Chance chance(6);
    for (const OptionInfo& info : option_catalogue()) {
        TechniqueOptions options;
        for (const OptionNumberInfo& number : info.numbers) {
            EXPECT_EQ(number.get(options), std::nullopt);
        }
        info.choose(options, info.words.empty() ? 0 : info.words.size() - 1);
        const TechniqueOptions usual = options;
        for (const OptionNumberInfo& number : info.numbers) {
            EXPECT_EQ(number.get(options), number.default_value) << info.name << number.name;
            for (int i = 0; i < 100; ++i) {
                const double value = random_value(number, chance);
                number.set(options, value);
                for (const OptionNumberInfo& other : info.numbers) {
                    EXPECT_EQ(other.get(options),
                              other.name == number.name ? value : other.default_value);
                }
            }
            number.set(options, number.default_value);
            EXPECT_EQ(options, usual);
        }
    }
}

TEST(TechniqueOptions, AnOptionThatIsRefusedChangesNothing) {
    TechniqueOptions options;
    options.fade = Fade{0.5, 1.0, 2.0};
    options.shadow = Shadow{0.5};
    const TechniqueOptions before = options;
    for (const char* text : {"fade=0..1,0", "fade=1..0", "shadow=soft,7", "shadow=hard,1"}) {
        EXPECT_FALSE(set_option(options, TechniqueId::relief, text)) << text;
        EXPECT_EQ(options, before) << text;
    }
}

TEST(TechniqueOptions, ErrorsAreWholeSentences) {
    const auto error_of = [](const char* text) { return parse_technique(text).error().message; };
    EXPECT_EQ(error_of("relief:fade=0..1,0.5"),
              "option fade: k=0.5 found, a number from 1 to 64 was expected");
    EXPECT_EQ(error_of("relief:fade=0"), "option fade: fade=0 found, fade=min..max[,k] was "
                                         "expected");
    EXPECT_EQ(error_of("relief:steps=8..32,2"),
              "option steps: steps=8..32,2 found, steps=min..max was expected");
    EXPECT_EQ(error_of("relief:edges=smooth,0"),
              "option edges: E=0 found, a number from 1e-06 to 1 was expected");
    EXPECT_EQ(error_of("relief:shadow=hard,0.3"),
              "option shadow: shadow=hard,0.3 found, shadow=none|hard|soft[,M] was expected");
    EXPECT_EQ(error_of("lattice:sides=two"),
              "technique lattice: option 'sides' found, it shows both sides already");
}

TechniqueOptions parsed(const std::string& text) {
    const auto technique = parse_technique(text);
    EXPECT_TRUE(technique) << (technique ? "" : technique.error().message);
    return technique ? technique->options : TechniqueOptions{};
}

TEST(TechniqueOptions, AllOfThemAreReadInAnyOrderAmongTheParameters) {
    const auto technique = parse_technique(
        "relief:depth=write,n=12,steps=8..32,fade=0.2..1,3,k=7,shadow=soft,0.3,edges=smooth,0.05,"
        "sides=two,border=wrap");
    ASSERT_TRUE(technique) << technique.error().message;
    const TechniqueOptions expected{
        StepRange{8, 32},         Fade{0.2, 1.0, 3.0}, Shadow{0.3}, SmoothEdges{0.05}, true,
        material::WrapMode::wrap, HitDepth::write};
    const Technique relief{Relief{.linear_steps = 12, .bisection_steps = 7}, expected};
    EXPECT_EQ(*technique, relief);
    EXPECT_EQ(to_string(*technique),
              "relief:n=12,k=7,steps=8..32,fade=0.2..1,3,shadow=soft,0.3,edges=smooth,0.05,"
              "sides=two,border=wrap,depth=write");
}

TEST(TechniqueOptions, NumbersThatAreLeftOutAreTheDefault) {
    EXPECT_EQ(parsed("exact:shadow=soft").shadow, Shadow{});
    EXPECT_EQ(parsed("exact:edges=smooth").smooth_edges, SmoothEdges{});
    EXPECT_EQ(parsed("exact:fade=0.2..0.9").fade, (Fade{0.2, 0.9, 1.0}));
    EXPECT_EQ(parsed("exact:shadow=none,edges=none,sides=one,depth=objects"), TechniqueOptions{});
}

TEST(TechniqueOptions, EachWordOfTheBorderIsItsRule) {
    for (const auto& [word, rule] : {std::pair{"wrap", material::WrapMode::wrap},
                                     std::pair{"clamp", material::WrapMode::clamp},
                                     std::pair{"discard", material::WrapMode::discard}}) {
        const TechniqueOptions options = parsed(std::string("relief:border=") + word);
        EXPECT_EQ(options.border, rule) << word;
        EXPECT_EQ(to_string(options), std::string(",border=") + word);
    }
}

std::string refusal_of(const std::string& text) {
    const auto technique = parse_technique(text);
    EXPECT_FALSE(technique) << text;
    return technique ? "" : technique.error().message;
}

TEST(TechniqueOptions, OneThatMakesNoSenseIsRefusedWithTheReason) {
    EXPECT_THAT(refusal_of("exact:steps=8..32"),
                AllOf(HasSubstr("technique exact: option 'steps' found"),
                      HasSubstr("no equal steps; steep")));
    EXPECT_THAT(refusal_of("pom:steps=8..32"), HasSubstr("its parameters min and max"));
    EXPECT_THAT(refusal_of("parallax:steps=8..32"), HasSubstr("no equal steps"));
    EXPECT_THAT(refusal_of("parallax:edges=smooth"), HasSubstr("follows no ray; relief and exact"));
    EXPECT_THAT(refusal_of("parallax-limited:shadow=hard"), HasSubstr("follows no ray"));
    EXPECT_THAT(refusal_of("polygons:depth=write"), HasSubstr("does not search for the surface"));
    EXPECT_THAT(refusal_of("texture:fade=0..1"), HasSubstr("does not search for the surface"));
    EXPECT_THAT(refusal_of("relief:steps=8..32,n=3,steps=8..32"),
                HasSubstr("technique relief: 'steps' found twice, once was expected"));
    EXPECT_THAT(refusal_of("relief:n=1,n=2"), HasSubstr("'n' found twice, once was expected"));
}

TEST(TechniqueOptions, AValueThatIsNoneIsToldWithWhatWasExpected) {
    EXPECT_THAT(refusal_of("relief:steps=32..8"),
                AllOf(HasSubstr("32..8 found"), HasSubstr("smaller number first")));
    EXPECT_THAT(refusal_of("relief:fade=1..0.5"), HasSubstr("smaller number first"));
    for (const char* value : {"", "8", "8..32,3", "8,32"}) {
        EXPECT_THAT(refusal_of(std::string("relief:steps=") + value),
                    AllOf(HasSubstr(std::string("steps=") + value + " found"),
                          HasSubstr("steps=min..max was expected")))
            << value;
    }
    for (const char* value : {"0..8", "8..1.5", "8..nan", "..", "8..", "1..2..3", "-1..2"}) {
        EXPECT_THAT(refusal_of(std::string("relief:steps=") + value),
                    HasSubstr("whole number from 1 to 4096 was expected"))
            << value;
    }
    for (const char* value : {"soft,0", "soft,2", "soft,x", "soft,", "soft,nan"}) {
        EXPECT_THAT(refusal_of(std::string("relief:shadow=") + value + ",n=3"),
                    HasSubstr("number from 0.001 to 1 was expected"))
            << value;
    }
    for (const char* value : {"hard,0.3", "none,1", "", "Hard", "true"}) {
        EXPECT_THAT(refusal_of(std::string("relief:shadow=") + value + ",n=3"),
                    HasSubstr("shadow=none|hard|soft[,M] was expected"))
            << value;
    }
    EXPECT_THAT(refusal_of("relief:sides=two,2"), HasSubstr("sides=one|two was expected"));
    EXPECT_THAT(refusal_of("relief:border=mirror"), HasSubstr("border=wrap|clamp|discard"));
    EXPECT_THAT(refusal_of("relief:depth"), HasSubstr("depth= found"));
    EXPECT_THAT(refusal_of("relief:fade=0..1,0.5"), HasSubstr("k=0.5 found"));
}

// A terrain is one surface with an end; a tile goes on and has a back.
TEST(TechniqueOptions, WhatOnlyTilesHaveIsRefusedOnATerrain) {
    auto terrain = std::make_shared<const terrain::Terrain>(
        terrain::Terrain{"made", test::plane_heightfield(Grid<float>(4, 4, 1.0F)), {}, {}});
    const TerrainSurface surface = TerrainSurface::create(terrain).value();
    const auto checked = [&](const char* text) {
        return check_technique(parse_technique(text).value(), surface);
    };
    EXPECT_TRUE(checked("relief:depth=write,shadow=hard"));
    EXPECT_THAT(checked("relief:sides=two").error().message,
                AllOf(HasSubstr("technique relief: sides=two found"), HasSubstr("beneath")));
    for (const char* text : {"exact:border=wrap", "relief:border=clamp", "pom:border=discard"}) {
        EXPECT_THAT(checked(text).error().message, HasSubstr("ends at its border"));
    }
}

TEST(TechniqueOptions, NumbersSayWhatIsNotAsMade) {
    EXPECT_TRUE(option_numbers(TechniqueOptions{}).empty());
    std::string text;
    for (const OptionNumber& number : option_numbers(
             parsed("steep:steps=4..9,fade=0..1,shadow=hard,border=discard,depth=write"))) {
        text += number.name + ' ' + std::to_string(static_cast<int>(number.value)) + ';';
    }
    EXPECT_EQ(text, "steps.min 4;steps.max 9;fade.min 0;fade.max 1;fade.k 1;shadow.M 0;border 2;"
                    "depth 2;");
}

TEST(TechniqueOptions, BorderOfWhatFollowsNoRayIsItsMaterials) {
    for (const char* text : {"texture:border=clamp", "normal:border=wrap", "bump:border=discard"}) {
        const auto technique = parse_technique(text);
        ASSERT_FALSE(technique) << text;
        EXPECT_THAT(technique.error().message, testing::HasSubstr("the border of the material"));
    }
}

} // namespace
} // namespace reljef::scene
