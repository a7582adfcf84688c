#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

// Share of pixels in which a channel differs by more than 1/255.
double differing_share(const Image& a, const Image& b) {
    const auto differs = [](Rgba8 p, Rgba8 q) {
        return std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)}) > 1;
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        count += differs(a.samples()[i], b.samples()[i]) ? 1U : 0U;
    }
    return static_cast<double>(count) / static_cast<double>(a.size());
}

Image render_natural(const test::TemporaryFolder& folder, const std::string& context) {
    const auto file = (folder.path() / (context + ".png")).string();
    const auto result =
        test::reljef({"render", test::small_terrain(folder, "natural"), "--technique",
                      "polygons:lods=1", "--samples", "1", "--context", context, "-o", file});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    auto image = io::read_image(file);
    return image ? std::move(*image) : Image();
}

TEST(Contexts, osmesa_egl_and_glfw_draw_the_same_picture) {
    RELJEF_RELEASE_ONLY("each context has tests of its own");
    const test::TemporaryFolder folder;
    const Image osmesa = render_natural(folder, "osmesa");
    const Image egl = render_natural(folder, "egl");
    ASSERT_FALSE(osmesa.empty());
    ASSERT_EQ(egl.size(), osmesa.size());
    EXPECT_LE(differing_share(osmesa, egl), 0.001);
    if (!test::has_display()) {
        GTEST_SKIP() << "no display: glfw was not compared (osmesa and egl were)";
    }
    const Image glfw = render_natural(folder, "glfw");
    ASSERT_EQ(glfw.size(), osmesa.size());
    EXPECT_LE(differing_share(osmesa, glfw), 0.001);
}

TEST(Contexts, a_picture_of_another_sun_differs) {
    RELJEF_RELEASE_ONLY("each context has tests of its own");
    const test::TemporaryFolder folder;
    const Image one = render_natural(folder, "osmesa");
    const auto file = (folder.path() / "east.png").string();
    ASSERT_EQ(test::reljef({"render", test::small_terrain(folder, "natural"), "--sun", "90,30",
                            "--samples", "1", "--context", "osmesa", "-o", file})
                  .exit_code,
              0);
    EXPECT_GT(differing_share(one, *io::read_image(file)), 0.2);
}

} // namespace
} // namespace reljef
