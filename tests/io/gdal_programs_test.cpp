// Places and heights against the programs of GDAL, which share nothing with reljef but PROJ.
#include <charconv>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "engine/io/raster/raster.h"
#include "engine/io/terrain_file.h"
#include "engine/io/tile_set.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"
#include "tests/support/test_program.h"

namespace reljef::io {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr int asked_points = 500;
#else
constexpr int asked_points = 10000;
#endif

struct AskedFile {
    const char* file;
    int cols;
    int rows;
    double metres = 1.0; ///< in a unit of the stored values
};

/// One of every format and type of sample that has a place.
constexpr std::array asked_files{
    AskedFile{"natural/srtm3/N45E006.hgt", 1201, 1201},
    AskedFile{"natural/derived/mt_rainier_90m_cog.tif", 1201, 1201},
    AskedFile{"natural/SainteHelens.dem", 327, 468},
    AskedFile{"natural/derived/sthelens.hf2", 200, 340},
    AskedFile{"natural/derived/sthelens_ftUS_compound_crs.tif", 200, 340, 1200.0 / 3937.0},
    AskedFile{"natural/n00_e006_3arc_v2.dt1", 1201, 1201},
    AskedFile{"urban/delft/tud-dsm-5m.tif", 722, 386},
    AskedFile{"urban/annarbor/test_dsm.tif", 786, 868}};

/// A program of GDAL's that answers a line of numbers with a line of numbers.
class GdalProgram {
public:
    explicit GdalProgram(const std::string& name) : program_("/usr/bin/" + name) {}

    [[nodiscard]] bool is_there() const { return std::filesystem::exists(program_); }

    /// `wanted` numbers of each line; 17 digits of what is asked.
    [[nodiscard]] std::vector<double> ask(std::vector<std::string> arguments,
                                          std::span<const glm::dvec2> points, int requested) const {
        std::string text;
        for (const glm::dvec2 point : points) {
            text += fmt::format("{:.17g} {:.17g}\n", point.x, point.y);
        }
        const test::TemporaryFolder folder;
        const test::ProgramOptions options{
            .environment = {}, .folder = {}, .input = folder.write("points", text)};
        const auto result = test::run_program(program_, arguments, options);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return numbers_of(result.out, requested);
    }

private:
    static std::vector<double> numbers_of(std::string_view text, int requested) {
        std::vector<double> numbers;
        while (!text.empty()) {
            std::string_view line = text.substr(0, text.find('\n'));
            text.remove_prefix(std::min(text.size(), line.size() + 1));
            for (int i = 0; i < requested; ++i) {
                double number = std::nan("");
                const auto parsed = std::from_chars(line.data(), line.data() + line.size(), number);
                line.remove_prefix(static_cast<std::size_t>(parsed.ptr - line.data()));
                line.remove_prefix(std::min(line.size(), line.find_first_not_of(' ')));
                numbers.push_back(number);
            }
        }
        return numbers;
    }

    std::filesystem::path program_;
};

class GdalPrograms : public ::testing::TestWithParam<AskedFile> {
public:
    [[nodiscard]] static std::string path() { return test::data_path(GetParam().file).string(); }
    /// The files' samples are integers or floats; gdallocationinfo writes 15 digits of them.
    [[nodiscard]] static double metres(double value) {
        return static_cast<double>(static_cast<float>(value)) * GetParam().metres;
    }
    [[nodiscard]] static bool is_void(double value) {
        return std::isnan(value) || value == -9999.0 || value == -32767.0 || value == -32768.0;
    }

protected:
    void SetUp() override {
        RELJEF_NEED_DATA(GetParam().file);
        if (!transform_.is_there() || !location_info_.is_there()) {
            GTEST_SKIP() << "gdaltransform and gdallocationinfo of gdal-bin are not here";
        }
    }

    /// Latitudes and longitudes of pixel coordinates: (0.5, 0.5) is the first sample.
    [[nodiscard]] std::vector<glm::dvec2> places_of(std::span<const glm::dvec2> pixels) const {
        const auto numbers = transform_.ask({"-t_srs", "EPSG:4326", path()}, pixels, 2);
        std::vector<glm::dvec2> places;
        for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
            places.emplace_back(numbers[i + 1], numbers[i]);
        }
        EXPECT_EQ(places.size(), pixels.size());
        return places;
    }
    /// The stored values at pixel coordinates.
    [[nodiscard]] std::vector<double> values_at(std::span<const glm::dvec2> pixels) const {
        auto values = location_info_.ask({"-valonly", path()}, pixels, 1);
        EXPECT_EQ(values.size(), pixels.size());
        return values;
    }

    const GdalProgram transform_{"gdaltransform"};
    const GdalProgram location_info_{"gdallocationinfo"};
};

/// What is asked of a format: its corners, samples, and places between samples.
struct Questions {
    std::vector<glm::dvec2> corners; // pixel coordinates: (0.5, 0.5) is the first sample
    std::vector<glm::dvec2> samples;
    std::vector<glm::dvec2> between;
    std::vector<glm::dvec2> around; // samples, four for each place between

    explicit Questions(const AskedFile& file) {
        const glm::dvec2 size(file.cols, file.rows);
        corners = {{0.0, 0.0}, {size.x, 0.0}, {0.0, size.y}, size, 0.5 * size};
        std::mt19937 random(31);
        std::uniform_real_distribution<double> col(0.5, size.x - 0.5);
        std::uniform_real_distribution<double> row(0.5, size.y - 0.5);
        for (int i = 0; i < asked_points; ++i) {
            samples.push_back(glm::floor(glm::dvec2(col(random), row(random))) + 0.5);
        }
        for (int i = 0; i < asked_points / 4; ++i) {
            between.emplace_back(col(random), row(random));
            const glm::dvec2 first = glm::floor(between.back() - 0.5) + 0.5;
            for (const glm::dvec2 step : {glm::dvec2(0.0), {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}}) {
                around.push_back(first + step);
            }
        }
    }
};

template <class Value>
std::vector<Value> joined_vectors(std::vector<Value> first, const std::vector<Value>& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

void expect_corners(std::span<const glm::dvec2> pixels, std::span<const glm::dvec2> places) {
    const auto terrain = read_terrain(GdalPrograms::path());
    ASSERT_TRUE(terrain) << terrain.error().message;
    const geo::GeodeticMap& map = terrain->heightfield.georeference->geodetic;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const glm::dvec2 found = map.latitude_longitude(pixels[i] - 0.5);
        EXPECT_LE(geo::geodesic_distance({found.x, found.y, 0.0}, {places[i].x, places[i].y, 0.0}),
                  1e-3)
            << "corner " << i;
    }
}

void expect_the_very_values(std::span<const HeightSample> found, std::span<const double> values) {
    for (std::size_t i = 0; i < found.size(); ++i) {
        const bool no_height = found[i].kind == HeightSample::Kind::in_void;
        ASSERT_EQ(no_height, GdalPrograms::is_void(values[i])) << "sample " << i;
        ASSERT_TRUE(no_height || found[i].height == GdalPrograms::metres(values[i]))
            << "sample " << i << ": " << found[i].height << ", " << values[i];
    }
}

/// To a micrometre; `around`: four values for each, all of them no voids where it is compared.
void expect_bilinear(std::span<const HeightSample> found, const Questions& asked,
                     std::span<const double> around) {
    std::size_t compared = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto cell = around.subspan(4 * i, 4);
        if (std::any_of(cell.begin(), cell.end(), GdalPrograms::is_void)) {
            continue;
        }
        const glm::dvec2 part = asked.between[i] - asked.around[4 * i];
        const auto metres = &GdalPrograms::metres;
        const double north = std::lerp(metres(cell[0]), metres(cell[1]), part.x);
        const double south = std::lerp(metres(cell[2]), metres(cell[3]), part.x);
        ASSERT_NEAR(found[i].height, std::lerp(north, south, part.y), 1e-6) << "place " << i;
        ++compared;
    }
    EXPECT_GT(compared, found.size() / 2);
}

TEST_P(GdalPrograms, PutCornersWithinAMillimetreAndTellTheVeryHeights) {
    const Questions asked(GetParam());
    const std::size_t corners = asked.corners.size();
    const std::size_t samples = asked.samples.size();
    const auto places =
        places_of(joined_vectors(joined_vectors(asked.corners, asked.samples), asked.between));
    const auto values = values_at(joined_vectors(asked.samples, asked.around));
    ASSERT_FALSE(HasFailure());
    const auto tiles = TileSet::open(path());
    ASSERT_TRUE(tiles) << tiles.error().message;
    const auto found = tiles->heights(std::span(places).subspan(corners)).answers;
    expect_corners(asked.corners, std::span(places).first(corners));
    expect_the_very_values(std::span(found).first(samples), std::span(values).first(samples));
    expect_bilinear(std::span(found).subspan(samples), asked, std::span(values).subspan(samples));
}

std::string name_of_asked(const ::testing::TestParamInfo<AskedFile>& parameter) {
    std::string name = std::filesystem::path(parameter.param.file).filename().string();
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Files, GdalPrograms, ::testing::ValuesIn(asked_files), name_of_asked);

} // namespace
} // namespace reljef::io
