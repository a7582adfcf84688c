#include "engine/scene/technique/technique_catalogue.h"

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/scene/technique/technique.h"
#include "tests/scene/technique/random_technique.h"

namespace reljef::scene {
namespace {

TEST(TechniqueCatalogue, HasOneRowForEachTechnique) {
    std::set<TechniqueId> ids;
    for (const TechniqueInfo& info : technique_catalogue()) {
        EXPECT_TRUE(ids.insert(info.id).second) << info.name;
        EXPECT_EQ(Technique{info.defaults}.id(), info.id);
        EXPECT_FALSE(info.meaning.empty());
        EXPECT_FALSE(info.source.empty());
    }
    EXPECT_EQ(ids.size(), std::variant_size_v<TechniqueParameters>);
}

// Names that were exchanged would come back from their own text all the same.
TEST(TechniqueCatalogue, EachNameIsTheMemberThatItMeans) {
    const std::vector<std::pair<const char*, TechniqueParameters>> meant{
        {"texture", Texture{}},
        {"polygons:lods=3,morph=1", Polygons{.max_levels = 3, .morph = true}},
        {"polygons:error=2", Polygons{.error = 2.0}},
        {"displacement:texels=5", Displacement{.max_texels = 5.0}},
        {"bump", Bump{}},
        {"emboss:delta=2", Emboss{.delta = 2.0}},
        {"normal", Normal{}},
        {"parallax:offset=-0.25", Parallax{.offset = -0.25}},
        {"parallax-limited:offset=-0.25", ParallaxLimited{.offset = -0.25}},
        {"parallax-iterated:offset=-0.25,k=2", ParallaxIterated{.offset = -0.25, .iterations = 2}},
        {"steep:n=2", Steep{.linear_steps = 2}},
        {"relief:n=2,k=3", Relief{.linear_steps = 2, .bisection_steps = 3}},
        {"interval:n=2,k=3", Interval{.linear_steps = 2, .secant_steps = 3}},
        {"pom:min=2,max=3", Pom{.min_steps = 2, .max_steps = 3}},
        {"cone:relaxed=0,n=3,k=4,step=5",
         Cone{.relaxed = false, .max_steps = 3, .bisection_steps = 4, .min_step = 5.0}},
        {"exact", Exact{}},
        {"lattice:n=2,k=3", Lattice{.linear_steps = 2, .bisection_steps = 3}},
        {"dual-layer:n=2,k=3", DualLayer{.linear_steps = 2, .bisection_steps = 3}},
        {"multi-layer:n=2,k=3", MultiLayer{.linear_steps = 2, .bisection_steps = 3}},
        {"prewarp", Prewarp{}}};
    for (const auto& [text, parameters] : meant) {
        EXPECT_EQ(parse_technique(text).value(), Technique{parameters}) << text;
        EXPECT_EQ(to_string(Technique{parameters}), text);
    }
}

TEST(TechniqueCatalogue, EveryParameterReadsAndWritesItsOwnMemberOnly) {
    test::Chance chance(5);
    for (const TechniqueInfo& info : technique_catalogue()) {
        Technique technique = make_technique(info.id);
        const Technique usual = technique;
        for (const ParameterInfo& parameter : info.parameters) {
            for (int i = 0; i < 100; ++i) {
                const double value = random_value(parameter, chance);
                parameter.set(technique, value);
                for (const ParameterInfo& other : info.parameters) {
                    EXPECT_EQ(other.get(technique),
                              other.name == parameter.name ? value : other.default_value)
                        << info.name << ' ' << parameter.name << ' ' << other.name;
                }
            }
            parameter.set(technique, parameter.default_value);
            EXPECT_EQ(technique, usual) << info.name << ' ' << parameter.name;
        }
    }
}

TEST(TechniqueCatalogue, DefaultsAreThoseOfTheStructs) {
    for (const TechniqueInfo& info : technique_catalogue()) {
        EXPECT_EQ(make_technique(info.id), Technique{info.defaults});
        for (const ParameterInfo& parameter : info.parameters) {
            EXPECT_EQ(parameter.get(Technique{info.defaults}), parameter.default_value)
                << info.name << ' ' << parameter.name;
            EXPECT_TRUE(parameter.allows(parameter.default_value));
        }
    }
    EXPECT_EQ(Technique{}, make_technique(TechniqueId::polygons));
}

std::vector<NumberInfo> all_numbers() {
    std::vector<NumberInfo> numbers;
    for (const TechniqueInfo& info : technique_catalogue()) {
        numbers.insert(numbers.end(), info.parameters.begin(), info.parameters.end());
    }
    for (const OptionInfo& info : option_catalogue()) {
        numbers.insert(numbers.end(), info.numbers.begin(), info.numbers.end());
    }
    return numbers;
}

TEST(NumberInfo, AllowsItsRangeAndNothingElse) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const NumberInfo& number : all_numbers()) {
        EXPECT_FALSE(number.meaning.empty()) << number.name;
        for (const double value : {number.low, number.high, number.default_value}) {
            EXPECT_TRUE(number.allows(value)) << number.name << ' ' << value;
        }
        for (const double value :
             {number.low - 1.0, number.high + 1.0, std::nextafter(number.low, -infinity),
              std::nextafter(number.high, infinity), -infinity, infinity, std::nan("")}) {
            EXPECT_FALSE(number.allows(value)) << number.name << ' ' << value;
        }
        EXPECT_EQ(number.allows(number.high - 0.5), !number.whole) << number.name;
        EXPECT_EQ(number.allows(std::nextafter(number.low, infinity)),
                  !number.whole && number.min_above_low <= number.low)
            << number.name;
    }
}

TEST(TechniqueCatalogue, AValueOutOfRangeAndAnotherTechniqueAreNoParameters) {
    const ParameterInfo& steps = technique_info(TechniqueId::steep).parameters.front();
    Technique steep{Steep{}};
    Technique relief{Relief{}};
    EXPECT_DEATH(steps.set(steep, 4097.0), "out of its range");
    EXPECT_DEATH(steps.set(relief, 4.0), "another technique");
    EXPECT_DEATH(static_cast<void>(steps.get(relief)), "another technique");
}

TEST(TechniqueParameters, AreOrderedByTechniqueAndThenByMember) {
    using Parameters = TechniqueParameters;
    EXPECT_LT(Parameters(Texture{}), Parameters(Polygons{}));
    EXPECT_LT(Parameters(Polygons{}), Parameters(Polygons{.max_levels = 2}));
    EXPECT_LT(Parameters(Polygons{.error = 1.0}), Parameters(Polygons{.error = 2.0}));
    EXPECT_EQ(Parameters(Relief{}), Parameters(Relief{}));
    EXPECT_NE(Parameters(Lattice{}), Parameters(DualLayer{}));
}

TEST(ParallaxOffset, IsThatOfParallaxAlone) {
    for (const TechniqueInfo& info : technique_catalogue()) {
        Technique technique = make_technique(info.id);
        double* const offset = parallax_offset(technique.parameters);
        EXPECT_EQ(offset != nullptr, info.name.starts_with("parallax"));
        if (offset != nullptr) {
            *offset = -0.125;
            EXPECT_EQ(info.parameters.front().get(technique), -0.125);
        }
    }
}

} // namespace
} // namespace reljef::scene
