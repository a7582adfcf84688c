#include "engine/scene/graph/terrain_node.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::scene {
namespace {

using testing::HasSubstr;

TEST(TerrainDetail, WhatMovesVerticesWarpsOrLooksForLayersShowsNoTileOnATerrain) {
    for (const TechniqueInfo& info : technique_catalogue()) {
        const bool shows = !draws_triangles(info.id) && info.id != TechniqueId::displacement &&
                           info.id != TechniqueId::prewarp && !searches_layers(info.id);
        const auto checked = check_terrain_detail_technique(make_technique(info.id));
        EXPECT_EQ(static_cast<bool>(checked), shows) << info.name;
        if (!checked) {
            EXPECT_THAT(checked.error().message, HasSubstr("normal, relief and exact"));
        }
    }
}

TEST(TerrainDetail, StepsAndShadowAreItsOnlyOptions) {
    const auto check = [](const std::string& text) {
        return check_terrain_detail_technique(parse_technique(text).value());
    };
    EXPECT_TRUE(check("relief:n=11,k=8,steps=8..32,shadow=soft,0.3"));
    EXPECT_TRUE(check("exact:shadow=hard"));
    for (const std::string option :
         {"fade=0.2..1", "edges=smooth", "sides=two", "border=clamp", "depth=write"}) {
        EXPECT_FALSE(check("relief:" + option)) << option;
    }
}

} // namespace
} // namespace reljef::scene
