#include "app/viewer/panels/appearance_panel.h"

#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::app {
namespace {

using testing::HasSubstr;

AppearanceContent at_greenwich() {
    AppearanceContent appearance;
    appearance.on_earth = geo::Geodetic{51.48, 0.0, 0.0};
    return appearance;
}

TEST(SunAt, TakesEveryYearOfTheFormulaAndNamesTheOthers) {
    for (const int year : {geo::first_sun_year, 1900, 2000, geo::last_sun_year}) {
        const auto sun = sun_at({year, 6, 21, 12.0}, at_greenwich());
        ASSERT_TRUE(sun) << year << sun.error().message;
        EXPECT_NEAR(sun->altitude, 61.95, 0.3) << year;
        EXPECT_NEAR(sun->azimuth, 180.0, 2.0) << year;
    }
    for (const int year : {-30'000, geo::first_sun_year - 1, geo::last_sun_year + 1, 2'000'000}) {
        const auto sun = sun_at({.year = year}, at_greenwich());
        ASSERT_FALSE(sun);
        EXPECT_THAT(sun.error().message, HasSubstr("1800 to 2200 was expected"));
    }
}

TEST(SunAt, HasTwilightAndNamesTheNight) {
    const auto twilight = sun_at({2026, 3, 20, 18.5}, at_greenwich());
    ASSERT_TRUE(twilight);
    EXPECT_LT(twilight->altitude, 0.0);
    EXPECT_GE(twilight->altitude, lowest_sun);
    const auto night = sun_at({2026, 12, 21, 0.0}, at_greenwich());
    ASSERT_FALSE(night);
    EXPECT_THAT(night.error().message, HasSubstr("below the horizon"));
    EXPECT_THAT(night.error().message, HasSubstr("at most 18 was expected"));
}

TEST(SunAt, TurnsWithTheGridOfThePlane) {
    AppearanceContent turned = at_greenwich();
    turned.true_north = -10.0;
    const geo::UniversalTime noon{2026, 6, 21, 12.0};
    const double azimuth = sun_at(noon, at_greenwich())->azimuth;
    EXPECT_NEAR(sun_at(noon, turned)->azimuth, azimuth - 10.0, 1e-9);
}

void shine(AppearanceContent& appearance, const SetSun& sun) {
    appearance.light.azimuth = sun.azimuth;
    appearance.light.altitude = sun.altitude;
}

TEST(SunDate, IsShownOnlyWhileTheSunIsThatOfIt) {
    AppearancePanel panel;
    AppearanceContent appearance = at_greenwich();
    shine(appearance, {300.0, 40.0});
    EXPECT_EQ(panel.date(appearance), "");
    const PanelActions actions = panel.type_date("2026-03-20 12:30", appearance);
    ASSERT_EQ(actions.size(), 1U);
    EXPECT_EQ(panel.date(appearance), "2026-03-20T12:30") << "before the sun has moved";
    shine(appearance, std::get<SetSun>(actions.front()));
    EXPECT_EQ(panel.date(appearance), "2026-03-20T12:30");
    appearance.light.azimuth -= 360.0; // the same
    EXPECT_EQ(panel.date(appearance), "2026-03-20T12:30");
    appearance.light.azimuth += 15.0;
    EXPECT_EQ(panel.date(appearance), "");
    shine(appearance, std::get<SetSun>(actions.front()));
    EXPECT_EQ(panel.date(appearance), "") << "it is forgotten";
    EXPECT_EQ(panel.type_date("2026-03-20", appearance).size(), 1U);
    EXPECT_EQ(panel.date(appearance), "2026-03-20T12:00");
    EXPECT_EQ(panel.type_date("2026-03-20T12:00:07", appearance).size(), 1U);
    EXPECT_EQ(panel.date(appearance), "2026-03-20T12:00:07");
}

TEST(SunDate, ThatOfTheStartIsShownUntilTheSunMoves) {
    AppearanceContent appearance = at_greenwich();
    appearance.sun_time = geo::UniversalTime{2026, 6, 21, 8.25};
    const SetSun sun = sun_at(*appearance.sun_time, appearance).value();
    shine(appearance, sun);
    AppearancePanel panel;
    EXPECT_EQ(panel.date(appearance), "2026-06-21T08:15");
    EXPECT_EQ(panel.date(appearance), "2026-06-21T08:15");
    shine(appearance, {sun.azimuth + 10.0, sun.altitude});
    EXPECT_EQ(panel.date(appearance), "");
    EXPECT_EQ(AppearancePanel().date(appearance), "") << "it had moved before";
    shine(appearance, sun);
    EXPECT_EQ(panel.date(appearance), "") << "it is forgotten";
}

TEST(SunDate, NotesGoWithTheDateThatTheyAreOn) {
    AppearancePanel panel;
    AppearanceContent appearance = at_greenwich();
    shine(appearance, {300.0, 40.0});
    EXPECT_TRUE(panel.type_date("2026-12-21T00:00", appearance).empty());
    EXPECT_EQ(panel.date(appearance), "2026-12-21T00:00");
    EXPECT_THAT(panel.note(), HasSubstr("below the horizon"));
    appearance.light.altitude = 41.0;
    EXPECT_EQ(panel.date(appearance), "");
    EXPECT_EQ(panel.note(), "");
    for (const char* const text : {"yesterday", "2026-02-30", "1700-01-01T12:00"}) {
        EXPECT_TRUE(panel.type_date(text, appearance).empty());
        EXPECT_EQ(panel.date(appearance), "") << text;
        EXPECT_THAT(panel.note(), HasSubstr("was expected")) << text;
    }
    appearance.light.azimuth = 10.0;
    panel.date(appearance);
    EXPECT_EQ(panel.note(), "");
    EXPECT_TRUE(panel.type_date("", appearance).empty());
    EXPECT_EQ(panel.note(), "");
}

} // namespace
} // namespace reljef::app
