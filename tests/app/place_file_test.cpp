#include "app/place_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

using ::testing::HasSubstr;

class PlaceFileTest : public testing::Test {
protected:
    struct Places {
        std::vector<glm::dvec2> places;
        std::string texts; // of all, a line each
        int pieces = 0;
    };
    [[nodiscard]] Result<Places> read(const std::string& text,
                                      std::size_t piece_bytes = 1000) const {
        return read_file(folder_.write("places.csv", text).string(), piece_bytes);
    }
    static Result<Places> read_file(const std::string& name, std::size_t piece_bytes) {
        auto file = PlaceFile::open(name, piece_bytes);
        if (!file) {
            return file.error();
        }
        Places all;
        for (; !file->at_end(); ++all.pieces) {
            const auto piece = file->next();
            if (!piece) {
                return piece.error();
            }
            all.places.insert(all.places.end(), piece->places.begin(), piece->places.end());
            for (const std::string_view one : piece->texts) {
                all.texts += std::string(one) + "\n";
            }
        }
        return all;
    }
    test::TemporaryFolder folder_;
};

TEST_F(PlaceFileTest, OnlyAFirstLineWithoutANumberIsAHeading) {
    for (const char* bad :
         {"95.5,6.5\n", "40.08;10.01\n", "+95.5,6.5", "-95,1", "\"40.08\",\"10.01\"\n", "nan,10\n",
          "\xEF\xBB\xBF"
          "95.5,6.5\n",
          "40.08\n", " 40.08\n", ".5\n"}) {
        const auto places = read(bad);
        ASSERT_FALSE(places) << bad;
        EXPECT_THAT(places.error().message, HasSubstr("--points: line 1: ")) << bad;
    }
    for (const char* good : {"lat,lon\n40.08,10.01\n", "\"lat\",\"lon\"\r\n40.08,10.01\r\n",
                             "\xEF\xBB\xBF"
                             "40.08,10.01",
                             "# 2 columns\n40.08,10.01", "40.08,10.01,name\n\n"}) {
        const auto places = read(good);
        ASSERT_TRUE(places) << good << ": " << places.error().message;
        EXPECT_EQ(places->texts, "40.08,10.01\n") << good;
    }
    EXPECT_THAT(read("lat,lon\nlat,lon\n").error().message, HasSubstr("line 2: 'lat,lon' found"));
    EXPECT_TRUE(read("")->places.empty());
}

TEST_F(PlaceFileTest, BlankLinesAndCommentsStandAnywhere) {
    for (const char* good :
         {"\nlat,lon\n40.08,10.01\n", "# by hand\n \r\nlat,lon\n# in degrees\n40.08,10.01\n",
          "\n\n40.08,10.01\n  # the end", "lat,lon\n#\n40.08,10.01\n#1,2"}) {
        for (const std::size_t piece : {20U, 1000U}) {
            const auto places = read(good, piece);
            ASSERT_TRUE(places) << good << ": " << places.error().message;
            EXPECT_EQ(places->texts, "40.08,10.01\n") << good;
        }
    }
    EXPECT_THAT(read("\n# by hand\nlat,lon\nlat,lon\n").error().message,
                HasSubstr("line 4: 'lat,lon' found"));
    EXPECT_THAT(read("1,2\n# by hand\nlat,lon\n").error().message,
                HasSubstr("line 3: 'lat,lon' found"));
}

TEST_F(PlaceFileTest, PiecesCutNoLine) {
    std::string text = "latitude,longitude\n";
    std::string requested;
    for (int i = 0; i < 500; ++i) {
        const std::string place = fmt::format("{},{}", i % 90, i);
        text += place + (i % 3 == 0 ? ",name\n" : "\n");
        requested += place + "\n";
    }
    for (const std::size_t piece : {20U, 21U, 64U, 1000U, 100'000U}) {
        for (const std::string& whole : {text, text.substr(0, text.size() - 1)}) {
            const auto places = read(whole, piece);
            ASSERT_TRUE(places) << places.error().message;
            EXPECT_EQ(places->texts, requested) << piece;
            EXPECT_EQ(places->places.back(), glm::dvec2(499 % 90, 499));
            EXPECT_EQ(places->pieces > 1, piece < text.size());
        }
    }
    EXPECT_THAT(read(text + "here\n", 64).error().message, HasSubstr("line 502: 'here'"));
}

TEST_F(PlaceFileTest, WhatCannotBeReadIsToldAndNoLineIsTakenInParts) {
    EXPECT_THAT(read_file(folder_.path().string(), 1000).error().message,
                HasSubstr("cannot be read"));
    EXPECT_THAT(read_file((folder_.path() / "none.csv").string(), 1000).error().message,
                HasSubstr("none.csv"));
    EXPECT_THAT(read("1,2\n" + std::string(2000, '1') + ",2\n").error().message,
                HasSubstr("line 2: over 1000 bytes found"));
}

} // namespace
} // namespace reljef::app
