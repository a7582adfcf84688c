// Voids of which a file says nothing are drawn, hit and told as those that a file declares.
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/io/image/image.h"
#include "tests/app/command_line.h"
#include "tests/support/temporary_folder.h"

namespace reljef {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class UndeclaredVoids : public testing::Test {
protected:
    UndeclaredVoids() {
        options_.environment["XDG_CACHE_HOME"] = (folder_.path() / "cache").string();
        options_.environment["LIBGL_ALWAYS_SOFTWARE"] = "1";
        write("declared", "NODATA_value -32768\n");
        write("undeclared", "");
    }
    /// Hills with a border and a lake of -32768, as a file and as a folder with it.
    void write(const std::string& name, const std::string& declaration) const {
        std::string text = fmt::format("ncols {0}\nnrows {0}\nxllcenter 10\nyllcenter 40\n"
                                       "cellsize 0.0001\n{1}",
                                       side, declaration);
        for (int row = 0; row < side; ++row) {
            for (int col = 0; col < side; ++col) {
                const double height = 500.0 + 40.0 * std::sin(0.1 * col) * std::cos(0.08 * row);
                text += is_void(col, row) ? "-32768 " : fmt::format("{:.0f} ", height);
            }
            text += "\n";
        }
        folder_.write(name + "/dem.asc", text);
        folder_.write(name + "/dem.prj", R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",)"
                                         R"(6378137,298.257223563]],PRIMEM["Greenwich",0],)"
                                         R"(UNIT["degree",0.0174532925199433]])");
    }
    static bool is_void(int col, int row) {
        return row < 12 || (col - 120) * (col - 120) + (row - 130) * (row - 130) < 25 * 25;
    }
    [[nodiscard]] test::ProgramResult run(std::vector<std::string> arguments) const {
        arguments.emplace_back("--quiet");
        return test::reljef(arguments, options_);
    }
    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_.path() / name).string();
    }
    /// The picture that is drawn of a terrain.
    [[nodiscard]] Image drawn(const std::string& terrain, std::vector<std::string> how) const {
        const std::string out = path("out.png");
        std::vector<std::string> arguments{"render", path(terrain), "-o",     out,
                                           "--size", "96x72",       "--pose", "oblique"};
        arguments.insert(arguments.end(), how.begin(), how.end());
        const auto result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        auto image = io::read_image(out);
        return image ? *image : Image();
    }

    static constexpr int side = 200;
    test::TemporaryFolder folder_;
    test::ProgramOptions options_;
};

TEST_F(UndeclaredVoids, are_drawn_as_declared_ones_by_all_that_draws_terrain) {
    const std::vector<std::vector<std::string>> ways{{"--technique", "polygons"},
                                                     {"--technique", "texture"},
                                                     {"--technique", "relief"},
                                                     {"--max-error", "2"},
                                                     {"--truth"}};
    // Of a folder and of a file, in memory and streamed.
    for (const auto& [of, memory] : {std::pair("", "512"), {"/dem.asc", "1"}}) {
        for (std::vector<std::string> way : ways) {
            way.insert(way.end(), {"--memory", memory});
            const Image declared = drawn(std::string("declared") + of, way);
            ASSERT_EQ(declared.cols(), 96);
            EXPECT_EQ(drawn(std::string("undeclared") + of, way), declared)
                << of << memory << way[0] << way[1];
        }
    }
}

TEST_F(UndeclaredVoids, count_in_no_range_and_have_no_height) {
    for (const char* of : {"undeclared", "undeclared/dem.asc"}) {
        for (const char* memory : {"512", "1"}) {
            const auto result = run({"info", path(of), "--json", "--memory", memory});
            ASSERT_EQ(result.exit_code, 0) << result.err;
            const auto info = nlohmann::json::parse(result.out);
            EXPECT_GT(info["height_range"]["low_m"].get<double>(), 450.0);
            EXPECT_GT(info["voids"].get<int>(), 0);
            EXPECT_THAT(info["notes"].dump(), HasSubstr("-32768"));
        }
        EXPECT_EQ(run({"height", path(of), "--at", "40.007,10.012"}).out, "40.007,10.012,nan\n");
    }
    const auto declared = run({"info", path("declared"), "--json"});
    EXPECT_THAT(declared.out, Not(HasSubstr("-32768")));
}

} // namespace
} // namespace reljef
