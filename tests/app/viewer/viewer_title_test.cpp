#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/viewer.h"
#include "engine/geo/place.h"
#include "tests/app/made_hill.h"
#include "tests/session/made_session.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(ViewerOnEarth, TitleTellsPlaceHeightAndHeading) {
    session::TerrainSource source;
    source.terrain.name = "alps";
    source.terrain.heightfield =
        test::geographic_heightfield(Grid<float>(33, 33, 1000.0F), 46.0, 7.0, 1e-3);
    session::SceneOptions view;
    view.geodetic = session::GeodeticView{45.99, 7.01, 1500.0, 250.0, -30.0};
    session::TerrainScene over = test::make_scene(std::move(source), {}, view).value();
    const std::string title =
        Viewer(over, scene::orbit_path(over.bounds), {400, 300}).title({}, {});
    for (const std::string& part :
         {std::string("500 m above ground"), std::string("1500 m above sea"),
          std::string("45.99000, 7.01000"), geo::mgrs_text({45.99, 7.01, 0.0}),
          std::string("heading 250\u00b0")}) {
        EXPECT_THAT(title, HasSubstr(part));
    }
}

// Ten degrees of the Earth from the terrain's middle, whose vertical leans by as much.
TEST(ViewerOnEarth, TitleTellsHeightsAlongThePlacesOwnVertical) {
    session::TerrainSource source;
    source.terrain.name = "europe";
    source.terrain.heightfield =
        test::geographic_heightfield(Grid<float>(33, 33, 1000.0F), 46.0, 7.0, 0.5);
    session::SceneOptions view;
    view.geodetic = session::GeodeticView{45.5, 8.0, 1500.0, 250.0, -30.0};
    session::TerrainScene over = test::make_scene(std::move(source), {}, view).value();
    const std::string title =
        Viewer(over, scene::orbit_path(over.bounds), {400, 300}).title({}, {});
    EXPECT_THAT(title, HasSubstr("500 m above ground - 1500 m above sea"));
    EXPECT_THAT(title, HasSubstr("heading 250\u00b0"));
}

// As relief techniques draw a DEM of the whole Earth: the first view is from beside it.
TEST(ViewerOnEarth, TitleSaysThatTheEyeIsBesideAMapOfTheWholeEarth) {
    session::TerrainSource source;
    source.terrain.name = "globe";
    source.terrain.heightfield =
        test::geographic_heightfield(Grid<float>(37, 19, 1000.0F), 90.0, -180.0, 10.0);
    session::SourceOptions choice;
    choice.placement = terrain::PlacementKind::plane;
    session::TerrainScene globe = test::make_scene(std::move(source), choice, {}).value();
    Viewer viewer(globe, scene::orbit_path(globe.bounds), {400, 300});
    EXPECT_THAT(viewer.title({}, {}), HasSubstr("beside the map of the Earth"));
    // Just south of the north pole, with what is ahead beyond it.
    auto& camera = *globe.camera->get<scene::Camera>();
    const auto& placement = globe.terrain->get<scene::TerrainNode>()->surface->placement();
    camera.eye = *placement.world_from_geodetic({89.9999, 0.0, 5000.0});
    camera.target = camera.eye + glm::dvec3(0.0, 1.0, 0.0);
    EXPECT_THAT(viewer.title({}, {}), HasSubstr("89.99990, 0.00000"));
    EXPECT_THAT(viewer.title({}, {}), Not(HasSubstr("heading")));
}

TEST(Viewer, TitleTellsTheScaleAtTheMiddleOfThePicture) {
    session::SceneOptions down;
    down.eye = glm::dvec3(0.0, -80.0, 160.0);
    down.target = glm::dvec3(0.0, -79.999, 10.0);
    down.vertical_fov = 90.0;
    session::TerrainScene over = hill_scene(down);
    // 150 m over the ground a picture of 90 degrees is 300 m high.
    EXPECT_THAT(Viewer(over, scene::orbit_path(over.bounds), {400, 300}).title({}, {}),
                HasSubstr("1.00 m a pixel"));
    EXPECT_THAT(Viewer(over, scene::orbit_path(over.bounds), {400, 600}).title({}, {}),
                HasSubstr("0.50 m a pixel"));
    session::SceneOptions up = down;
    up.target = glm::dvec3(0.0, 0.0, 1000.0);
    session::TerrainScene sky = hill_scene(up);
    EXPECT_THAT(Viewer(sky, scene::orbit_path(sky.bounds), {400, 300}).title({}, {}),
                Not(HasSubstr("a pixel")));
    session::SceneOptions map;
    map.projection = scene::ProjectionKind::orthographic;
    session::TerrainScene flat = hill_scene(map);
    const double high = flat.camera->get<scene::Camera>()->view_height;
    EXPECT_THAT(Viewer(flat, scene::orbit_path(flat.bounds), {400, 300}).title({}, {}),
                HasSubstr(fmt::format("{:.2f} m a pixel", high / 300.0)));
}

} // namespace
} // namespace reljef::app
