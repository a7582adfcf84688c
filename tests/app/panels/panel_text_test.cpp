#include "app/viewer/panels/panel_text.h"

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/viewer/panels/compass_panel.h"
#include "engine/geo/place.h"

namespace reljef::app {
namespace {

TEST(PanelText, CountsAndLengthsAreShort) {
    EXPECT_EQ(count_text(9999), "9999");
    EXPECT_EQ(count_text(12'345), "12.3 k");
    EXPECT_EQ(count_text(2'073'600), "2.07 M");
    EXPECT_EQ(length_text(0.012), "12 mm");
    EXPECT_EQ(length_text(4.561), "4.56 m");
    EXPECT_EQ(length_text(12'340.0), "12.3 km");
}

TEST(PanelText, TechniquesHaveShortNumbers) {
    EXPECT_EQ(short_text(scene::Technique{scene::Polygons{.error = 4.148437512}}),
              "polygons:error=4.148");
    const scene::Technique relief{scene::Relief{}};
    EXPECT_EQ(short_text(relief), scene::to_string(relief));
    EXPECT_EQ(short_number(16384.0), "16384");
    EXPECT_EQ(short_number(12345.678), "12346");
    EXPECT_EQ(short_number(0.5), "0.5");
    TechniqueContent content;
    content.requested = relief;
    EXPECT_EQ(technique_summary(content), scene::to_string(relief));
    content.models = {{"bowl", {scene::Texture{}}}, {"torus", relief}};
    content.model = 1;
    EXPECT_EQ(technique_summary(content), "torus: " + scene::to_string(relief));
}

TEST(PanelText, AxesHaveRoundNumbersAtEqualDistances) {
    const auto texts = [](double low, double high, double count) {
        std::vector<std::string> found;
        for (const AxisTick& tick : axis_ticks(low, high, count)) {
            EXPECT_GE(tick.value, low - 1e-9 * (high - low));
            EXPECT_LE(tick.value, high + 1e-9 * (high - low));
            found.push_back(tick.text);
        }
        return found;
    };
    EXPECT_THAT(texts(0.0, 12.3, 4.0), testing::ElementsAre("0", "5", "10"));
    EXPECT_THAT(texts(412.0, 1287.0, 4.0), testing::ElementsAre("500", "1000"));
    EXPECT_THAT(texts(-0.7, 0.4, 4.0), testing::ElementsAre("-0.5", "0.0"));
    EXPECT_THAT(texts(0.0, 1.0, 5.0),
                testing::ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
    for (const double range : {1e-3, 0.9, 37.0, 8848.0, 3e6}) {
        EXPECT_LE(texts(0.1 * range, 1.1 * range, 4.0).size(), 5U) << range;
        EXPECT_GE(texts(0.1 * range, 1.1 * range, 4.0).size(), 1U) << range;
    }
}

TEST(PanelText, PlacesHaveEachFormatThatTheyCanHave) {
    PlaceContent place;
    place.world = {1.0, -2.0, 3.0};
    EXPECT_EQ(place_text(place, PlaceFormat::mgrs), "x 1.0 m  y -2.0 m");
    EXPECT_EQ(next_format(PlaceFormat::scene, place), PlaceFormat::scene);
    place.on_earth = geo::Geodetic{-45.5, 7.25, 100.0};
    EXPECT_EQ(place_text(place, PlaceFormat::geographic), "45.50000° S  7.25000° E");
    EXPECT_EQ(place_text(place, PlaceFormat::mgrs), geo::mgrs_text(*place.on_earth));
    place.in_crs = CrsPlace{{500'000.04, 10.0}, "UTM", true};
    EXPECT_EQ(place_text(place, PlaceFormat::crs), "500000.0, 10.0");
    std::set<PlaceFormat> seen;
    PlaceFormat format = PlaceFormat::geographic;
    for (int i = 0; i < 4; ++i) {
        seen.insert(format);
        format = next_format(format, place);
    }
    EXPECT_EQ(seen.size(), 4U);
    EXPECT_EQ(format, PlaceFormat::geographic);
}

TEST(PanelText, ErrorsAreWhatTheFrameKept) {
    const scene::Technique bounded{scene::Polygons{.error = 1.0}};
    view::FrameStats stats;
    stats.kept_error = 1.0;
    EXPECT_EQ(error_summary(stats, bounded), "at most 1 px");
    stats.kept_error = 2.5;
    EXPECT_EQ(error_summary(stats, bounded), "up to 2.5 px");
    stats.tiles_unproven = 1;
    EXPECT_EQ(error_summary(stats, bounded), "unproven");
    EXPECT_EQ(error_summary({}, scene::Technique{scene::Texture{}}), "no bound");
    const scene::Technique exact{scene::Exact{}};
    EXPECT_EQ(error_summary({}, exact), "rounding only");
    EXPECT_EQ(error_summary(stats, exact), "unproven");
    stats.tiles_unproven = 0;
    EXPECT_EQ(error_summary(stats, exact), "up to 2.5 px");
    stats.kept_error = 0.02;
    EXPECT_EQ(error_summary(stats, exact), "at most 0.02 px");
    stats.kept_error = 1e-5;
    EXPECT_EQ(error_summary(stats, exact), "rounding, below 0.01 px");
}

TEST(ScaleBar, HasARoundLengthNextToTheLongest) {
    for (double scale = 1e-4; scale < 1e5; scale *= 1.37) {
        const ScaleBar bar = scale_bar(scale, 128.0);
        EXPECT_NEAR(bar.pixels * scale, bar.metres, 1e-9 * bar.metres);
        EXPECT_LE(bar.pixels, 128.0 * (1.0 + 1e-12)); // rounding of one division
        EXPECT_GT(bar.pixels, 128.0 / 2.5 * (1.0 - 1e-12));
        const double digit =
            bar.metres / std::pow(10.0, std::floor(std::log10(bar.metres * 1.0001)));
        EXPECT_TRUE(std::abs(digit - 1.0) < 1e-9 || std::abs(digit - 2.0) < 1e-9 ||
                    std::abs(digit - 5.0) < 1e-9)
            << bar.metres;
    }
}

TEST(PanelText, ChoicesOfAutoNameWhatDrawsAndWhatIsUnproven) {
    view::Choice choice{.tiles_as_triangles = 4};
    EXPECT_EQ(choice_summary(choice), "triangles");
    choice = {.tiles_as_triangles = 4, .tiles_by_rays = 5, .ray_pixels = 0.25};
    EXPECT_EQ(choice_summary(choice), "4 tiles, rays for 25 %");
    choice = {.tiles_by_rays = 9, .ray_pixels = 0.9};
    EXPECT_EQ(choice_summary(choice), "rays");
    choice.typical = view::TypicalChoice{"interval:n=4,k=2", 0.93};
    EXPECT_EQ(choice_summary(choice), "unproven interval:n=4,k=2, right for 93 % of the probes");
}

} // namespace
} // namespace reljef::app
