#include "engine/view/choice/triangle_counts.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/terrain/mesh/tile_layout.h"
#include "tests/render/made_scene.h"

namespace reljef::view {
namespace {

class CountedTriangles {
public:
    explicit CountedTriangles(Grid<float> heights)
        : heightfield_(test::plane_heightfield(std::move(heights), {10.0, 10.0})),
          placement_(
              terrain::Placement::create(heightfield_, terrain::PlacementKind::plane).value()),
          bisection_(heightfield_, placement_), counts_(bisection_) {}

    [[nodiscard]] double estimated(double error) const {
        double sum = 0.0;
        for (int row = 0; row < counts_.blocks().y; ++row) {
            for (int col = 0; col < counts_.blocks().x; ++col) {
                sum += counts_.triangles({col, row}, error);
            }
        }
        return sum;
    }
    /// Seen from everywhere alike.
    [[nodiscard]] double drawn(double error) const {
        terrain::ErrorView view;
        view.perspective = false;
        view.max_error = error;
        double sum = 0.0;
        const glm::ivec2 cells(heightfield_.heights.cols() - 1, heightfield_.heights.rows() - 1);
        for (const terrain::TileCells& tile : terrain::tile_layout(cells)) {
            for (const auto& part : terrain::triangulate(bisection_, tile, view).parts) {
                sum += static_cast<double>(part.indices.size()) / 3.0;
            }
        }
        return sum;
    }
    [[nodiscard]] const TriangleCounts& counts() const { return counts_; }

private:
    terrain::Heightfield heightfield_;
    terrain::Placement placement_;
    terrain::Bisection bisection_;
    TriangleCounts counts_;
};

TEST(TriangleCountsTest, AreThoseOfABisectionWithTheSameError) {
    const CountedTriangles made(test::hills(300, 257, 60.0));
    for (const double error : {0.05, 0.2, 1.0, 4.0}) {
        const double drawn = made.drawn(error);
        EXPECT_NEAR(made.estimated(error), drawn, 0.2 * drawn + 200.0) << error;
    }
}

// Cells between ground and roofs are bent so much that they are divided many times.
TEST(TriangleCountsTest, CountThoseInsideOfCells) {
    const CountedTriangles made(test::random_heights(49, 33, 0.0F, 8.0F, 5));
    for (const double error : {0.01, 0.05, 0.2, 1.0}) {
        const double drawn = made.drawn(error);
        EXPECT_GT(drawn, 2.0 * 48.0 * 32.0);
        EXPECT_NEAR(made.estimated(error), drawn, 0.25 * drawn) << error;
    }
}

TEST(TriangleCountsTest, NeverFallWithASmallerError) {
    const CountedTriangles made(test::random_heights(100, 70, 0.0F, 8.0F, 3));
    double last = made.estimated(1e9);
    for (double error = 1e6; error > 1e-7; error *= 0.7) {
        const double now = made.estimated(error);
        EXPECT_GE(now, last);
        last = now;
    }
}

TEST(TriangleCountsTest, AreFewOverALevelSurface) {
    const CountedTriangles made(Grid<float>(257, 257, 3.0F));
    EXPECT_EQ(made.estimated(0.0), 2.0 * 8 * 8);
    EXPECT_EQ(made.counts().blocks(), glm::ivec2(8, 8));
    const CountedTriangles small(Grid<float>(2, 2, 1.0F));
    EXPECT_EQ(small.counts().blocks(), glm::ivec2(1, 1));
}

} // namespace
} // namespace reljef::view
