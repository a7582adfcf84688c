#include "engine/geo/sun_position.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::geo {
namespace {

// Of the formula: its longitude of the sun is within 0.01 degrees.
constexpr double tolerance = 0.02;

// Meeus 1998, example 25.a: the declination is the altitude at the north pole.
TEST(SunPosition, HasTheDeclinationOfAPublishedExample) {
    const auto sun = sun_position({1992, 10, 13, 0.0}, 90.0, 0.0);
    ASSERT_TRUE(sun);
    EXPECT_NEAR(sun->altitude, -7.78507, tolerance);
}

// Reda and Andreas 2004, "Solar Position Algorithm for Solar Radiation Applications", table A5.1;
// the altitude there without refraction.
TEST(SunPosition, IsThatOfAPublishedPlaceAndTime) {
    const auto sun = sun_position({2003, 10, 17, 19.0 + 30.5 / 60.0}, 39.742476, -105.1786);
    ASSERT_TRUE(sun);
    EXPECT_NEAR(sun->azimuth, 194.34024, tolerance);
    EXPECT_NEAR(sun->altitude, 39.872046, tolerance);
}

TEST(SunPosition, RisesInTheEastAndStandsInTheSouthOrNorthAtNoon) {
    const auto morning = sun_position({2026, 3, 20, 6.5}, 0.0, 0.0);
    EXPECT_NEAR(morning->azimuth, 90.0, 1.0);
    for (const double latitude : {60.0, -60.0}) {
        const auto noon = sun_position({2026, 6, 21, 12.0}, latitude, 0.0);
        const double south_or_north = latitude > 0.0 ? 180.0 : 0.0;
        EXPECT_LT(std::abs(std::remainder(noon->azimuth - south_or_north, 360.0)), 1.5);
        EXPECT_NEAR(noon->altitude, 90.0 - std::abs(latitude - 23.44), 0.05);
    }
}

TEST(SunPosition, RefusesDaysThatTheFormulaOrTheCalendarLacks) {
    for (const UniversalTime& time :
         {UniversalTime{1799, 1, 1, 0.0}, UniversalTime{2201, 1, 1, 0.0},
          UniversalTime{2025, 2, 29, 0.0}, UniversalTime{2025, 13, 1, 0.0},
          UniversalTime{2025, -1, 1, 0.0}, UniversalTime{2025, 1, 1, 24.0},
          UniversalTime{2025, 1, 1, std::nan("")}}) {
        const auto refused = sun_position(time, 0.0, 0.0);
        ASSERT_FALSE(refused) << time.year << ' ' << time.month << ' ' << time.hours;
        EXPECT_THAT(refused.error().message, testing::HasSubstr("was expected"));
    }
    EXPECT_TRUE(sun_position({2024, 2, 29, 0.0}, 0.0, 0.0));
}

TEST(SunPosition, ByDayIsThatAboveTheHorizon) {
    const auto noon = sun_by_day({2026, 6, 21, 12.0}, 45.0, 0.0);
    ASSERT_TRUE(noon);
    EXPECT_EQ(noon->altitude, sun_position({2026, 6, 21, 12.0}, 45.0, 0.0)->altitude);
    const auto midnight = sun_by_day({2026, 6, 21, 0.0}, 45.0, 0.0);
    ASSERT_FALSE(midnight);
    EXPECT_THAT(midnight.error().message, testing::HasSubstr("below the horizon"));
    EXPECT_FALSE(sun_by_day({2500, 6, 21, 12.0}, 45.0, 0.0));
}

TEST(UniversalTime, IsReadWithAndWithoutSecondsAndZ) {
    for (const char* const text :
         {"2026-06-21T12:30", "2026-06-21T12:30Z", "2026-06-21T12:30:00", "2026-06-21T12:30:00Z"}) {
        const auto time = universal_time(text);
        ASSERT_TRUE(time) << time.error().message;
        EXPECT_EQ(time->year, 2026);
        EXPECT_EQ(time->month, 6);
        EXPECT_EQ(time->day, 21);
        EXPECT_EQ(time->hours, 12.5);
    }
    EXPECT_EQ(universal_time("2026-06-21T12:30:36")->hours, 12.51);
}

TEST(UniversalTime, RefusesWhatIsNoTime) {
    for (const std::string& text :
         {std::string(), std::string("noon"), std::string("2026-06-21"),
          std::string("2026-6-21T12:00"), std::string("2026-06-21T12:00+02:00"),
          std::string("2026-06-21T24:00"), std::string("2026-06-21T12:60"),
          std::string("2026-06-21T12:00:60"), std::string("2026-02-29T12:00"),
          std::string("1799-01-01T12:00"), std::string("2026-06-21T12:00 "),
          std::string(100'000, '1')}) {
        const auto refused = universal_time(text);
        ASSERT_FALSE(refused) << text;
        EXPECT_THAT(refused.error().message, testing::HasSubstr("expected")) << text;
    }
}

TEST(SunPosition, DaysOfTheYearAreThoseOfTheCalendar) {
    EXPECT_EQ(day_of_year(2025, 172).month, 6);
    EXPECT_EQ(day_of_year(2025, 172).day, 21);
    EXPECT_EQ(day_of_year(2024, 366).day, 31);
}

} // namespace
} // namespace reljef::geo
