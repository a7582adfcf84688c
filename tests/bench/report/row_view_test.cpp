#include "bench/report/row_view.h"

#include <limits>

#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/support/temporary_folder.h"

namespace reljef::bench {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float no_bound = std::numeric_limits<float>::infinity();

Image decoded(const RowView::File& file, const char* name) {
    const test::TemporaryFolder folder;
    const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
    return io::read_image(folder.write(name, text)).value();
}

ShownView view_of(int cols, int rows, float error) {
    return {Image(cols, rows, {255, 255, 255, 255}),
            std::make_shared<const Image>(cols, rows, Rgba8{0, 0, 0, 255}),
            Grid<float>(cols, rows, error)};
}

TEST(RowViewTest, PicturesKeepTheirSizeWhereTheyFit) {
    const auto view = RowViews(64).make(view_of(64, 48, 1.0F)).value();
    EXPECT_EQ(view->size, glm::ivec2(64, 48));
    EXPECT_EQ(decoded(view->heat, "heat.png"), heat_map(Grid<float>(64, 48, 1.0F)));
    EXPECT_EQ(decoded(view->truth ? *view->truth : RowView::File(), "truth.jpg").cols(), 64);
}

TEST(RowViewTest, AReducedColourIsTheLinearMean) {
    ShownView view = view_of(64, 64, 0.0F);
    for (int row = 0; row < 64; ++row) {
        for (int col = row % 2; col < 64; col += 2) {
            view.shown(col, row) = {0, 0, 0, 255};
        }
    }
    const auto made = RowViews(32).make(view).value();
    EXPECT_EQ(made->size, glm::ivec2(32, 32));
    const Rgba8 middle = decoded(made->shown, "shown.jpg")(16, 16);
    EXPECT_NEAR(middle.r, 188, 2); // half the light; the mean of the sRGB values is 128
}

TEST(RowViewTest, AReducedErrorIsTheGreatestAndNoneOnlyWhereAllAreNone) {
    ShownView view = view_of(6, 4, nan);
    view.reprojection(0, 0) = 0.5F;
    view.reprojection(1, 1) = 20.0F;
    view.reprojection(3, 0) = no_bound;
    view.reprojection(2, 0) = 3.0F;
    Grid<float> expected(3, 2, nan);
    expected(0, 0) = 20.0F;
    expected(1, 0) = no_bound;
    const auto made = RowViews(3).make(view).value();
    EXPECT_EQ(decoded(made->heat, "heat.png"), heat_map(expected));
}

TEST(RowViewTest, RowsOfOneTruthShareItsFile) {
    RowViews views(16);
    ShownView first = view_of(32, 32, 1.0F);
    ShownView second = view_of(32, 32, 2.0F);
    const ShownView other = view_of(32, 32, 2.0F);
    second.truth = first.truth;
    const auto file = views.make(first).value()->truth;
    EXPECT_EQ(views.make(second).value()->truth, file);
    EXPECT_NE(views.make(other).value()->truth, file);
}

TEST(RowViewTest, NoPictureIsReducedToNothing) {
    EXPECT_EQ(RowViews(1).make(view_of(40, 3, 1.0F)).value()->size, glm::ivec2(13, 1));
    EXPECT_EQ(RowViews(1).make(view_of(1, 1, 1.0F)).value()->size, glm::ivec2(1, 1));
}

TEST(RowViewDeathTest, PicturesOfTwoSizesAreRefused) {
    ShownView view = view_of(8, 8, 1.0F);
    view.truth = std::make_shared<const Image>(8, 7);
    EXPECT_DEATH(static_cast<void>(RowViews().make(view)), "differ in size");
}

} // namespace
} // namespace reljef::bench
