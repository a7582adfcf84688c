// --context cpu: exact rays without OpenGL.
#include <string>

#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "engine/truth/image_error.h"
#include "tests/app/command_line.h"
#include "tests/support/release_only.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

class CpuContext : public testing::Test {
protected:
    test::ProgramResult render(std::vector<std::string> options) {
        std::vector<std::string> arguments{"render", "--size",          "320x240", "--quiet",
                                           "-o",     file("shown.png"), "--stats"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return test::reljef(arguments);
    }
    Image shown() { return io::read_image(file("shown.png")).value(); }
    std::string file(const std::string& name) { return (folder_.path() / name).string(); }

    const test::TemporaryFolder folder_;
    const std::string urban_ = test::small_terrain(folder_, "urban");
};

void expect_alike(const Image& a, const Image& b) {
    const auto errors = truth::image_errors(a, b);
    ASSERT_TRUE(errors);
    EXPECT_LE(errors->rmse, 0.02);
    EXPECT_LE(errors->flip.mean, 0.03);
}

TEST_F(CpuContext, DrawsWhatOpenGlDrawsAndCountsRays) {
    RELJEF_RELEASE_ONLY("the room cast has tests of its own");
    // The limits are for hazy air; clear air shows each difference of filtering with more contrast.
    const std::vector<std::string> hazy{"urban", "--technique",  "exact", "--samples",
                                        "1",     "--visibility", "7000",  "--context"};
    const auto with = [&](const char* context) {
        std::vector<std::string> arguments = hazy;
        arguments.emplace_back(context);
        return render(arguments);
    };
    const auto rays = with("cpu");
    ASSERT_EQ(rays.exit_code, 0) << rays.err;
    EXPECT_NE(rays.out.find("renderer: exact rays on the CPU"), std::string::npos) << rays.out;
    EXPECT_NE(rays.out.find("rays: 76800"), std::string::npos) << rays.out;
    const Image on_cpu = shown();
    ASSERT_EQ(with("osmesa").exit_code, 0);
    expect_alike(on_cpu, shown());
}

TEST_F(CpuContext, NeedsNoTechnique) {
    RELJEF_RELEASE_ONLY("the room cast has tests of its own");
    ASSERT_EQ(render({urban_, "--context", "cpu", "--technique", "exact"}).exit_code, 0);
    const Image exact = shown();
    for (const std::vector<std::string>& bound :
         {std::vector<std::string>(), {"--max-error", "4"}}) {
        std::vector<std::string> options{urban_, "--context", "cpu"};
        options.insert(options.end(), bound.begin(), bound.end());
        const auto result = render(options);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(shown(), exact);
    }
}

TEST_F(CpuContext, ShowsADetailTextureWithoutATechnique) {
    const auto with = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {urban_, "--pose", "low", "--context", "cpu"});
        const auto result = render(options);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return shown();
    };
    const Image detailed = with({"--detail", "cobble:width=3"});
    EXPECT_EQ(detailed, with({"--detail", "cobble:width=3", "--max-error", "1"}));
    EXPECT_NE(detailed, with({}));
}

TEST_F(CpuContext, RefusesInOneSentenceWhatItCannotDraw) {
    const std::vector<std::string> cpu{"--context", "cpu"};
    const auto with = [&](std::vector<std::string> options) {
        options.insert(options.end(), cpu.begin(), cpu.end());
        return render(options);
    };
    test::expect_refusal(with({urban_, "--technique", "texture"}), 1,
                         {"do not draw technique texture", "--context osmesa"});
    test::expect_refusal(with({test::small_terrain(folder_, "gallery"), "--textures", "cobble"}), 1,
                         {"a mesh with technique", "--context osmesa"});
    test::expect_refusal(with({urban_, "--samples", "3"}), 2, {"--samples", "3", "16"});
    test::expect_refusal(with({urban_, "--simd", "mmx"}), 2, {"--simd mmx", "scalar"});
}

TEST_F(CpuContext, DrawsTheGallerysTexturesAsOpenGlDoes) {
    RELJEF_RELEASE_ONLY("the room cast has tests of its own");
    const auto with = [&](const char* context) {
        return render({test::small_terrain(folder_, "gallery"), "--technique", "texture",
                       "--context", context});
    };
    const auto rays = with("cpu");
    ASSERT_EQ(rays.exit_code, 0) << rays.err;
    const Image on_cpu = shown();
    ASSERT_EQ(with("osmesa").exit_code, 0);
    expect_alike(on_cpu, shown());
}

TEST_F(CpuContext, DrawsObjects) {
    RELJEF_RELEASE_ONLY("the room cast has tests of its own");
    const test::TemporaryFolder folder;
    const auto roof = folder
                          .write("roof.obj", "v -40 90 -40\nv 40 90 -40\nv 40 90 40\nv -40 90 40\n"
                                             "v 0 0 0\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\n"
                                             "f 4 1 5\n")
                          .string();
    const auto with = [&](const std::string& technique, bool has_object) {
        std::vector<std::string> options{urban_, "--context", "cpu", "--technique", technique};
        if (has_object) {
            options.insert(options.end(), {"--object", roof + ":at=0,0,height=15,scale=0.1"});
        }
        const auto result = render(options);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return shown();
    };
    const Image hard = with("exact:shadow=hard", true);
    EXPECT_NE(with("exact:shadow=hard", false), hard);
    EXPECT_NE(with("exact", true), with("exact", false));
}

// Where the machine has no GPU, as here.
TEST_F(CpuContext, IsTheDefaultForWhatItDraws) {
    RELJEF_RELEASE_ONLY("the room session has tests of its own");
    const std::string rays = "renderer: exact rays on the CPU";
    const auto unnamed = render({urban_});
    ASSERT_EQ(unnamed.exit_code, 0) << unnamed.err;
    if (unnamed.out.find(rays) == std::string::npos) {
        GTEST_SKIP() << "a GPU draws";
    }
    const auto texture = render({urban_, "--technique", "texture"});
    EXPECT_EQ(texture.exit_code, 0) << texture.err;
    EXPECT_EQ(texture.out.find(rays), std::string::npos) << texture.out;
    const auto wireframe = render({urban_, "--wireframe"});
    EXPECT_EQ(wireframe.exit_code, 0) << wireframe.err;
    EXPECT_EQ(wireframe.out.find(rays), std::string::npos) << wireframe.out;
}

TEST_F(CpuContext, PlacesGeoreferencedTerrainOnTheEllipsoid) {
    const test::TemporaryFolder folder;
    folder.write("hill.prj", "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\","
                             "6378137.0,298.257223563]],PRIMEM[\"Greenwich\",0.0],"
                             "UNIT[\"Degree\",0.0174532925199433]]");
    const auto hill = folder
                          .write("hill.asc", "ncols 3\nnrows 3\nxllcenter 7\nyllcenter 46\n"
                                             "cellsize 0.1\n0 0 0 0 5000 0 0 0 0\n")
                          .string();
    const auto drawn = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"render", hill, "--context", "cpu", "--size", "64x48",
                                         "-o", file("a.png")});
        const auto result = test::reljef(options);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return io::read_image(file("a.png")).value();
    };
    const Image usual = drawn({});
    EXPECT_EQ(usual, drawn({"--placement", "ellipsoid"}));
    EXPECT_NE(drawn({"--technique", "exact:shadow=hard", "--placement", "ellipsoid"}),
              drawn({"--technique", "exact", "--placement", "ellipsoid"}));
    EXPECT_NE(usual, drawn({"--placement", "plane"}));
    EXPECT_EQ(drawn({"--technique", "exact"}),
              drawn({"--technique", "exact", "--placement", "plane"}));
}

} // namespace
} // namespace reljef
