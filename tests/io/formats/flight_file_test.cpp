#include "engine/io/formats/flight_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/geo/georeference.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

class FlightFile : public ::testing::Test {
protected:
    Result<Flight> read(const std::string& name, const std::string& text) {
        const test::QuietGdal quiet;
        return read_flight(folder_.write(name, text), 50.0);
    }
    std::vector<GeodeticKey> keys(const std::string& name, const std::string& text) {
        const auto flight = read(name, text);
        EXPECT_TRUE(flight) << (flight ? "" : flight.error().message);
        const auto* found = flight ? std::get_if<std::vector<GeodeticKey>>(&flight->keys) : nullptr;
        EXPECT_NE(found, nullptr);
        return found != nullptr ? *found : std::vector<GeodeticKey>{};
    }
    std::string error(const std::string& name, const std::string& text) {
        const auto flight = read(name, text);
        return flight ? "no error" : flight.error().message;
    }
    test::TemporaryFolder folder_;
};

constexpr const char* gpx =
    "<gpx version=\"1.1\" creator=\"t\" xmlns=\"http://www.topografix.com/GPX/1/1\"><trk><trkseg>"
    "<trkpt lat=\"45.8\" lon=\"6.8\"><ele>3000</ele></trkpt>"
    "<trkpt lat=\"45.8\" lon=\"6.8\"><ele>3001</ele></trkpt>"
    "<trkpt lat=\"45.9\" lon=\"6.9\"><ele>3500</ele></trkpt></trkseg></trk></gpx>";
constexpr const char* kml =
    "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document><Placemark><LineString><coordinates>"
    "6.8,45.8,3000 6.9,45.9,3500</coordinates></LineString></Placemark></Document></kml>";
constexpr const char* geojson =
    "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":{},"
    "\"geometry\":{\"type\":\"Point\",\"coordinates\":[0,0]}},{\"type\":\"Feature\",\"properties\":"
    "{},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[6.8,45.8,3000],[6.9,45.9,3500]]}}]"
    "}";

TEST_F(FlightFile, LinesOfGpxKmlAndGeoJsonAreTheSameFlight) {
    for (const auto& [name, text] :
         {std::pair("a.gpx", gpx), std::pair("a.kml", kml), std::pair("a.geojson", geojson)}) {
        const auto found = keys(name, text);
        ASSERT_EQ(found.size(), 2U) << name;
        EXPECT_EQ(found[0].time, 0.0);
        EXPECT_NEAR(found[0].latitude, 45.8, 1e-12);
        EXPECT_NEAR(found[0].longitude, 6.8, 1e-12);
        EXPECT_EQ(found[0].height, 3000.0) << name;
        EXPECT_EQ(found[1].height, 3500.0) << name;
        EXPECT_FALSE(found[1].heading);
        EXPECT_NEAR(found[1].time,
                    geo::geodesic_distance({45.8, 6.8, 0.0}, {45.9, 6.9, 0.0}) / 50.0, 1e-6);
    }
}

TEST_F(FlightFile, TheSegmentsOfATrackAreFlownOneAfterTheOther) {
    constexpr const char* segments =
        "<gpx version=\"1.1\" creator=\"t\" xmlns=\"http://www.topografix.com/GPX/1/1\"><trk>"
        "<trkseg><trkpt lat=\"45.8\" lon=\"6.8\"/><trkpt lat=\"45.9\" lon=\"6.8\"/></trkseg>"
        "<trkseg><trkpt lat=\"46\" lon=\"6.8\"/></trkseg><trkseg/>"
        "<trkseg><trkpt lat=\"46\" lon=\"6.9\"/><trkpt lat=\"46.1\" lon=\"6.9\"/></trkseg></trk>"
        "</gpx>";
    const auto found = keys("a.gpx", segments);
    ASSERT_EQ(found.size(), 5U);
    EXPECT_NEAR(found[1].latitude, 45.9, 1e-12);
    EXPECT_NEAR(found[2].latitude, 46.0, 1e-12);
    EXPECT_NEAR(found[3].longitude, 6.9, 1e-12);
    EXPECT_NEAR(found[4].time - found[3].time,
                geo::geodesic_distance({46.0, 6.9, 0.0}, {46.1, 6.9, 0.0}) / 50.0, 1e-6);
    for (std::size_t i = 1; i < found.size(); ++i) {
        EXPECT_GT(found[i].time, found[i - 1].time);
    }
    EXPECT_TRUE(read("a.gpx", segments)->notes.empty());
}

TEST_F(FlightFile, OfSeveralTracksTheFirstIsFlownAndThatIsTold) {
    const auto flight = read(
        "a.gpx",
        "<gpx version=\"1.1\" creator=\"t\" "
        "xmlns=\"http://www.topografix.com/GPX/1/1\"><trk><trkseg>"
        "<trkpt lat=\"45.8\" lon=\"6.8\"/></trkseg></trk><trk><trkseg><trkpt lat=\"45.9\" "
        "lon=\"6.9\"/>"
        "<trkpt lat=\"46\" lon=\"6.9\"/></trkseg></trk><trk><trkseg><trkpt lat=\"45\" lon=\"6\"/>"
        "<trkpt lat=\"46\" lon=\"6\"/></trkseg></trk></gpx>");
    ASSERT_TRUE(flight) << flight.error().message;
    const auto& found = std::get<std::vector<GeodeticKey>>(flight->keys);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(found[0].longitude, 6.9, 1e-12);
    ASSERT_EQ(flight->notes.size(), 1U);
    EXPECT_THAT(flight->notes[0], HasSubstr("a.gpx: holds 2 lines, the first is flown"));
}

TEST_F(FlightFile, ALineWithoutHeightsHasNone) {
    const auto found = keys(
        "flat.json", "{\"type\":\"LineString\",\"coordinates\":[[6.8,45.8],[6.9,45.9],[7,46]]}");
    ASSERT_EQ(found.size(), 3U);
    EXPECT_FALSE(found[1].height);
}

TEST_F(FlightFile, KeysOnEarthAreReadFromToml) {
    const auto found =
        keys("path.toml", "[[key]]\ntime = 0\nlatitude = 45.8\nlongitude = 6.8\nheight = 4000\n"
                          "[[key]]\ntime = 9.5\nlatitude = 45.9\nlongitude = 6.9\nheight = 3000\n"
                          "heading = 90\npitch = -10\n");
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].latitude, 45.8);
    EXPECT_EQ(found[0].height, 4000.0);
    EXPECT_FALSE(found[0].heading);
    EXPECT_EQ(found[1].time, 9.5);
    EXPECT_EQ(found[1].heading, 90.0);
    EXPECT_EQ(found[1].pitch, -10.0);
}

TEST_F(FlightFile, KeysInSceneMetresStayThat) {
    const auto flight = read("path.toml", "[[key]]\ntime = 0\neye = [1, 2, 3]\nlook = [0, 0, 0]\n");
    ASSERT_TRUE(flight);
    ASSERT_TRUE(std::holds_alternative<std::vector<PathKey>>(flight->keys));
}

TEST_F(FlightFile, WhatIsWrongIsOneSentenceThatNamesTheFile) {
    const std::string key = "[[key]]\ntime = 0\nlatitude = 45\nlongitude = 6\nheight = 100\n";
    EXPECT_THAT(error("a.toml", "[[key]]\ntime = 0\nlatitude = 91\nlongitude = 6\nheight = 1\n"),
                HasSubstr("a.toml:3: [[key]] latitude is 91"));
    EXPECT_THAT(error("a.toml", "[[key]]\ntime = 0\nlatitude = 45\nheight = 1\n"),
                HasSubstr("longitude is missing"));
    EXPECT_THAT(error("a.toml", key + "pitch = 3\n"), HasSubstr("pitch stands without heading"));
    EXPECT_THAT(error("a.toml", key + key), HasSubstr("a time after the last one's 0"));
    EXPECT_THAT(error("a.gpx", "<gpx><trk>"), HasSubstr("a.gpx: "));
    EXPECT_THAT(error("a.gpx", ""), HasSubstr("a.gpx: cannot be opened as a path"));
    EXPECT_THAT(error("a.json", "{\"type\":\"Point\",\"coordinates\":[6.8,45.8]}"),
                HasSubstr("holds no line"));
    EXPECT_THAT(error("a.json", "{\"type\":\"LineString\",\"coordinates\":[[6.8,145],[6.9,45]]}"),
                HasSubstr("has a point at 145,6.8"));
    EXPECT_THAT(
        error("a.json", "{\"type\":\"LineString\",\"coordinates\":[[6,45,-1e30],[6.9,45,1]]}"),
        HasSubstr("has a height of -1e+30 m"));
    EXPECT_THAT(error("a.txt", "nothing"), HasSubstr("a.txt: cannot be opened as a path"));
}

TEST_F(FlightFile, WrittenFlightOnEarthIsReadAgain) {
    const test::QuietGdal quiet;
    const std::vector<GeodeticKey> written{{-1.5, 45.8, 6.8, 3000.25, 350.0, -12.5},
                                           {2.0, 45.9, 179.999, 3500.0, 20.0, 5.0},
                                           {9.25, -45.9, -179.999, 0.0, 0.0, 0.0}};
    for (const std::string name : {"flight.toml", "flight.gpx"}) {
        const auto file = folder_.path() / name;
        ASSERT_TRUE(write_flight(file, {written, {}}));
        const auto flight = read_flight(file, 50.0);
        ASSERT_TRUE(flight) << flight.error().message;
        const auto& read = std::get<std::vector<GeodeticKey>>(flight->keys);
        ASSERT_EQ(read.size(), written.size());
        for (std::size_t i = 0; i < read.size(); ++i) {
            EXPECT_NEAR(read[i].latitude, written[i].latitude, 1e-9);
            EXPECT_NEAR(read[i].longitude, written[i].longitude, 1e-9);
            ASSERT_TRUE(read[i].height);
            EXPECT_NEAR(*read[i].height, *written[i].height, 1e-4);
            const bool is_track = name == "flight.gpx"; // has no angles, and times by the way
            EXPECT_EQ(read[i].heading.has_value(), !is_track);
            EXPECT_TRUE(is_track || read[i].time == written[i].time);
        }
    }
}

TEST_F(FlightFile, WrittenPathInTheSceneIsReadAgain) {
    const std::vector<PathKey> written{{0.0, {1.5, -2.25, 3.0}, {4.0, 5.0, -6.0}},
                                       {4.0, {1e6, 2.0, 3.0}, {4.0, 5.0, 6.0}}};
    const auto file = folder_.path() / "path.toml";
    ASSERT_TRUE(write_flight(file, {written, {}}));
    const auto flight = read_flight(file);
    ASSERT_TRUE(flight) << flight.error().message;
    const auto& read = std::get<std::vector<PathKey>>(flight->keys);
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[0].eye, written[0].eye);
    EXPECT_EQ(read[1].target, written[1].target);
    EXPECT_EQ(read[1].time, 4.0);
}

TEST_F(FlightFile, FlightThatCannotBeWrittenLeavesNothing) {
    const Flight in_scene{std::vector<PathKey>{{0.0, {1, 2, 3}, {4, 5, 6}}}, {}};
    for (const char* name : {"path.gpx", "path.kml", "path"}) {
        EXPECT_FALSE(write_flight(folder_.path() / name, in_scene)) << name;
        EXPECT_FALSE(std::filesystem::exists(folder_.path() / name));
    }
}

} // namespace
} // namespace reljef::io
