#include <memory>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/render/residency/relief_maps.h"
#include "tests/render/made_scene.h"
#include "tests/terrain/chance.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::render {
namespace {

// Of a globe, rows that close it and its overview at the poles lie between the others.
TEST(StreamedSpace, HasTheSamplesOfAReducedGlobeAtTheirPlaces) {
    constexpr int reduction = 4;
    constexpr double to_pole = 0.5; // rows
    scene::Scene scene;
    scene::Node& node = test::add_terrain(scene, test::closed_globe(99, to_pole, to_pole, 11), {},
                                          {.placement = terrain::PlacementKind::ellipsoid});
    const auto& overview = node.get<scene::TerrainNode>()->surface;
    const glm::ivec2 samples(reduction * 200 + 1, reduction * 100 + 2);
    const geo::GlobalWrap wrap{.around = true, .east = true, .north = to_pole, .south = to_pole};
    const scene::TileBuilder builder(overview, terrain::TileTree(samples.x, samples.y, wrap),
                                     reduction, {}, wrap);
    scene::TerrainTile root;
    root.id = builder.tree().root();
    const std::vector<std::shared_ptr<const scene::TerrainTile>> tiles{
        std::make_shared<const scene::TerrainTile>(root)};
    view::RayCourse course;
    course.eye = {50.0, 60.0, 1000.0};
    const StreamedSpace made = streamed_space(builder, tiles, glm::dvec3(0.0), course);
    test::Chance chance(3);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec2 sample(chance.between(0.0, samples.x - 1.0),
                                chance.between(2.0 * reduction, samples.y - 2.0 * reduction));
        const glm::dvec2 unit = (sample - made.origin_sample) / made.samples_a_cell;
        const glm::dvec2 found = glm::dvec2(made.space.sample_of_origin) +
                                 unit * glm::dvec2(made.space.samples_per_unit);
        ASSERT_LT(glm::distance(found, builder.on_overview(sample)), 1e-9) << sample.y;
    }
}

} // namespace
} // namespace reljef::render
