#include "engine/scene/technique/technique.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Technique, EveryOneInTheCatalogueComesBackFromItsText) {
    std::set<std::string_view> names;
    for (const TechniqueInfo& info : technique_catalogue()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name << " is there twice";
        EXPECT_EQ(&technique_info(info.id), &info);
        const Technique technique = make_technique(info.id);
        EXPECT_EQ(technique.id(), info.id);
        const auto again = parse_technique(to_string(technique));
        ASSERT_TRUE(again) << to_string(technique);
        EXPECT_EQ(*again, technique);
        const auto bare = parse_technique(info.name);
        ASSERT_TRUE(bare);
        EXPECT_EQ(*bare, technique);
    }
}

TEST(Technique, ReadsAParameter) {
    const auto technique = parse_technique("polygons:lods=1");
    ASSERT_TRUE(technique);
    EXPECT_EQ(*technique, Technique{Polygons{}});
    EXPECT_EQ(to_string(*technique), "polygons:lods=1");
    EXPECT_EQ(to_string(Technique{Texture{}}), "texture");
}

TEST(Technique, NamesAnOptionOnlyWhereItIsNotTheDefault) {
    EXPECT_EQ(to_string(Technique{Polygons{}}), "polygons:lods=1");
    const Technique bounded{Polygons{.error = 0.5}};
    EXPECT_EQ(to_string(bounded), "polygons:error=0.5");
    EXPECT_EQ(parse_technique("polygons:error=0.5").value(), bounded);
}

std::string error_of(std::string_view text) {
    const auto technique = parse_technique(text);
    EXPECT_FALSE(technique) << text;
    return technique ? "" : technique.error().message;
}

TEST(Technique, AnUnknownNameIsToldWithTheOnesThereAre) {
    for (const char* text : {"", "poligons", "Texture", " texture", ":lods=1"}) {
        EXPECT_THAT(error_of(text), AllOf(HasSubstr("technique '"), HasSubstr("' found"),
                                          HasSubstr("texture, polygons"), HasSubstr("expected")));
    }
}

TEST(Technique, AnUnknownParameterIsToldWithTheOnesThereAre) {
    EXPECT_THAT(error_of("polygons:lod=1"),
                AllOf(HasSubstr("polygons"), HasSubstr("'lod'"), HasSubstr("one of lods, error")));
    EXPECT_THAT(error_of("texture:n=1"), AllOf(HasSubstr("'n'"), HasSubstr("it has none")));
}

TEST(Technique, AValueOutOfRangeIsToldWithTheRange) {
    for (const char* value : {"0", "6", "-1", "1.5", "1e9", "nan", "inf", "-inf", "", "one", "1x",
                              " 1", "0x1", "1=1"}) {
        EXPECT_THAT(error_of(std::string("polygons:lods=") + value),
                    AllOf(HasSubstr(std::string("lods=") + value + " found"),
                          HasSubstr("a whole number from 1 to 5 was expected")))
            << value;
    }
    for (const char* value : {"-1", "17", "nan", "-inf", ""}) {
        EXPECT_THAT(error_of(std::string("polygons:error=") + value),
                    AllOf(HasSubstr(std::string("error=") + value + " found"),
                          HasSubstr("a number from 0.02 to 16 was expected")))
            << value;
    }
    EXPECT_THAT(error_of("polygons:lods"), HasSubstr("lods= found"));
}

TEST(Technique, ErrorsAreWholeSentences) {
    EXPECT_EQ(error_of("polygon"),
              "technique 'polygon' found, one of texture, polygons, displacement, bump, emboss, "
              "normal, parallax, parallax-limited, parallax-iterated, steep, relief, interval, "
              "pom, cone, exact, lattice, dual-layer, multi-layer, prewarp, auto was expected");
    EXPECT_EQ(error_of("cone:m=1"), "technique cone: parameter 'm' found, one of relaxed, n, k, "
                                    "step was expected");
    EXPECT_EQ(error_of("exact:n=1"), "technique exact: parameter 'n' found, it has none");
    EXPECT_EQ(error_of("relief:n=1,k=2,n=3"),
              "technique relief: 'n' found twice, once was expected");
    EXPECT_EQ(error_of("cone:relaxed=2"),
              "technique cone: relaxed=2 found, a whole number from 0 to 1 was expected");
    EXPECT_EQ(error_of("polygons:error=0.01"),
              "technique polygons: error=0.01 found, 0 or a number from 0.02 to 16 was expected");
    EXPECT_EQ(error_of("polygons:lods=2,error=1"),
              "technique polygons: lods and error found, one of them was expected");
    EXPECT_EQ(error_of("relief:n"),
              "technique relief: n= found, a whole number from 1 to 4096 was expected");
    EXPECT_EQ(error_of("relief:"), "technique 'relief:' found, key=value was expected at its end");
}

// As --max-error has it: less than a rasterizer can keep is no promise.
TEST(Technique, ErrorOfPolygonsIsNoneOrOneThatCanBeKept) {
    for (const char* text : {"polygons:error=0.001", "polygons:error=17", "polygons:error=-1"}) {
        EXPECT_THAT(error_of(text), HasSubstr("0 or a number from 0.02 to 16 was expected"));
    }
    for (const char* text : {"polygons:error=0", "polygons:error=0.02", "polygons:error=16"}) {
        EXPECT_TRUE(parse_technique(text)) << text;
    }
}

TEST(Technique, LevelsAndAnErrorContradictEachOther) {
    EXPECT_THAT(error_of("polygons:lods=3,error=1"), HasSubstr("lods and error found"));
    EXPECT_THAT(error_of("polygons:error=1,lods=3"), HasSubstr("one of them was expected"));
    EXPECT_EQ(to_string(parse_technique("polygons:lods=1,error=1").value()), "polygons:error=1");
}

TEST(Technique, AnEmptyAssignmentIsAnError) {
    EXPECT_THAT(error_of("polygons:"), HasSubstr("key=value was expected"));
    EXPECT_THAT(error_of("texture:"), HasSubstr("key=value was expected"));
    EXPECT_FALSE(error_of("polygons:,lods=1").empty());
    EXPECT_FALSE(error_of("polygons:lods=1,").empty());
    EXPECT_FALSE(error_of("polygons:lods=1,,lods=1").empty());
}

} // namespace
} // namespace reljef::scene
