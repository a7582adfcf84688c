// Where techniques that search a surface show a georeferenced terrain.
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/session/made_session.h"
#include "tests/support/temporary_folder.h"

namespace reljef::session {
namespace {

class PlacementChoice : public testing::Test {
protected:
    /// Of 9x9 samples up to `reach` degrees from a place on a meridian.
    [[nodiscard]] terrain::PlacementKind placement_at(double latitude, double reach,
                                                      const scene::Technique& technique) const {
        folder_.write(
            "ground.prj",
            R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,)"
            R"(298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]])");
        std::string text =
            fmt::format("ncols 9\nnrows 9\nxllcenter 10\nyllcenter {}\ncellsize {}\n",
                        latitude - reach, reach / 4.0);
        for (int i = 0; i < 9 * 9; ++i) {
            text += "5 ";
        }
        SourceOptions choice;
        choice.terrain = folder_.write("ground.asc", text).string();
        SceneOptions view;
        view.technique = technique;
        const TerrainScene scene =
            test::make_scene(test::open_terrain(choice).value(), choice, view).value();
        return scene.terrain->get<scene::TerrainNode>()->surface->placement().kind();
    }

    test::TemporaryFolder folder_;
};

TEST_F(PlacementChoice, IsAPlaneForSearchesThatItDistortsByLessThanATenth) {
    const scene::Technique exact{scene::Exact{}};
    EXPECT_EQ(placement_at(45.0, 0.5, exact), terrain::PlacementKind::plane) << "1 %";
    EXPECT_EQ(placement_at(45.0, 10.0, exact), terrain::PlacementKind::ellipsoid) << "19 %";
    EXPECT_EQ(placement_at(0.0, 15.0, exact), terrain::PlacementKind::plane) << "7 %";
    EXPECT_EQ(placement_at(0.0, 30.0, exact), terrain::PlacementKind::ellipsoid) << "25 %";
    EXPECT_EQ(placement_at(89.9, 0.005, exact), terrain::PlacementKind::plane) << "5 %";
    EXPECT_EQ(placement_at(89.9, 0.02, exact), terrain::PlacementKind::ellipsoid) << "20 %";
}

TEST_F(PlacementChoice, IsTheEllipsoidForTriangles) {
    EXPECT_EQ(placement_at(45.0, 0.5, scene::Technique{scene::Polygons{}}),
              terrain::PlacementKind::ellipsoid);
}

} // namespace
} // namespace reljef::session
