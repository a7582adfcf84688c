#include "engine/scene/technique/technique_options.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/scene/graph/scene.h"
#include "engine/scene/technique/technique.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

bool takes(TechniqueId id, std::string_view name) {
    const auto taken = options_of(id);
    return std::any_of(taken.begin(), taken.end(),
                       [&](const OptionInfo& info) { return info.name == name; });
}

const OptionInfo& info_of(std::string_view name) {
    const auto list = option_catalogue();
    return *std::find_if(list.begin(), list.end(),
                         [&](const OptionInfo& info) { return info.name == name; });
}

// Any allowed value, now and then an end of the range.
double any_value(const ParameterInfo& parameter, test::Chance& chance) {
    if (chance.one_in(4)) {
        return chance.one_in(2) ? parameter.low : parameter.high;
    }
    const double value = chance.between(parameter.low, parameter.high);
    return parameter.whole ? std::round(value) : value;
}

std::pair<double, double> any_range(const OptionInfo& info, test::Chance& chance) {
    return std::minmax(any_value(info.numbers[0], chance), any_value(info.numbers[1], chance),
                       std::less<>());
}

TechniqueOptions any_options(TechniqueId id, test::Chance& chance) {
    const auto has = [&](std::string_view name) { return takes(id, name) && chance.one_in(2); };
    TechniqueOptions options;
    if (has("steps")) {
        const auto [low, high] = any_range(info_of("steps"), chance);
        options.steps = StepRange{low, high};
    }
    if (has("fade")) {
        const auto [low, high] = any_range(info_of("fade"), chance);
        options.fade = Fade{low, high, any_value(info_of("fade").numbers[2], chance)};
    }
    if (has("shadow")) {
        options.shadow =
            Shadow{chance.one_in(2) ? 0.0 : any_value(info_of("shadow").numbers[0], chance)};
    }
    if (has("edges")) {
        options.smooth_edges = any_value(info_of("edges").numbers[0], chance);
    }
    options.two_sided = has("sides");
    if (has("border")) {
        options.border = static_cast<BorderRule>(chance.whole(0, 2));
    }
    options.writes_depth = has("depth");
    options.true_silhouettes = has("silhouettes");
    return options;
}

TEST(TechniqueOptions, AnyTechniqueComesBackFromItsText) {
    test::Chance chance(4);
    const auto catalogue = technique_catalogue();
    for (int i = 0; i < 5000; ++i) {
        const TechniqueInfo& info = catalogue[static_cast<std::size_t>(
            chance.whole(0, static_cast<int>(catalogue.size()) - 1))];
        Technique technique{info.id, {}, any_options(info.id, chance)};
        for (const ParameterInfo& parameter : info.parameters) {
            technique.values.push_back(any_value(parameter, chance));
        }
        if (info.id == TechniqueId::polygons && parameter(technique, "error") > 0.0) {
            technique.values.front() = 1.0; // levels by distance, or an error
        }
        const std::string text = to_string(technique);
        const auto again = parse_technique(text);
        ASSERT_TRUE(again) << again.error().message;
        EXPECT_EQ(*again, technique) << text;
        EXPECT_EQ(to_string(*again), text);
    }
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
    EXPECT_THAT(technique->values, testing::ElementsAre(12.0, 7.0));
    const TechniqueOptions expected{
        StepRange{8.0, 32.0}, Fade{0.2, 1.0, 3.0}, Shadow{0.3}, 0.05, true, BorderRule::wrap, true};
    EXPECT_EQ(technique->options, expected);
    EXPECT_EQ(to_string(*technique),
              "relief:n=12,k=7,steps=8..32,fade=0.2..1,3,shadow=soft,0.3,edges=smooth,0.05,"
              "sides=two,border=wrap,depth=write");
}

TEST(TechniqueOptions, NumbersThatAreLeftOutAreTheDefault) {
    EXPECT_EQ(parsed("exact:shadow=soft").shadow,
              Shadow{info_of("shadow").numbers[0].default_value});
    EXPECT_EQ(parsed("exact:edges=smooth").smooth_edges, info_of("edges").numbers[0].default_value);
    EXPECT_EQ(parsed("exact:fade=0..1").fade, (Fade{0.0, 1.0, 1.0}));
    EXPECT_EQ(parsed("exact:shadow=none,edges=none,sides=one,depth=none"), TechniqueOptions{});
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
    EXPECT_THAT(refusal_of("pom:steps=8..32"), HasSubstr("its own min and max"));
    EXPECT_THAT(refusal_of("parallax:steps=8..32"), HasSubstr("no equal steps"));
    EXPECT_THAT(refusal_of("parallax:edges=smooth"), HasSubstr("follows no ray; relief and exact"));
    EXPECT_THAT(refusal_of("parallax-limited:shadow=hard"), HasSubstr("follows no ray"));
    EXPECT_THAT(refusal_of("polygons:depth=write"), HasSubstr("looks for no surface"));
    EXPECT_THAT(refusal_of("texture:fade=0..1"), HasSubstr("looks for no surface"));
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
                    "depth 1;");
}

TEST(TechniqueOptions, BorderOfWhatFollowsNoRayIsItsMaterials) {
    for (const char* text : {"texture:border=clamp", "normal:border=wrap", "bump:border=discard"}) {
        const auto technique = parse_technique(text);
        ASSERT_FALSE(technique) << text;
        EXPECT_THAT(technique.error().message, testing::HasSubstr("as its material says"));
    }
}

} // namespace
} // namespace reljef::scene
