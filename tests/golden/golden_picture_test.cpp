#include "tests/golden/golden_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "tests/support/temporary_folder.h"

namespace reljef::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class GoldenPicture : public testing::Test {
protected:
    GoldenPicture() {
        std::filesystem::create_directory(folders_.pictures);
        EXPECT_TRUE(io::write_image(folders_.pictures / "a.png", golden_));
    }
    [[nodiscard]] std::vector<std::string> failures() const {
        std::vector<std::string> names;
        std::error_code code;
        for (const auto& file : std::filesystem::directory_iterator(folders_.failures, code)) {
            names.push_back(file.path().filename().string());
        }
        std::sort(names.begin(), names.end());
        return names;
    }

    TemporaryFolder folder_;
    GoldenFolders folders_{folder_.path() / "pictures", folder_.path() / "failures"};
    Image golden_ = Image(100, 50, Rgba8{100, 150, 200});
};

TEST_F(GoldenPicture, PassesItselfAndWhatIsWithinTheLimits) {
    Image actual = golden_;
    EXPECT_TRUE(check_golden("a", actual, folders_));
    for (Rgba8& pixel : actual.samples()) {
        pixel.g = static_cast<std::uint8_t>(pixel.g + 4);
    }
    for (int i = 0; i < 10; ++i) { // 0.2 % of 5,000 pixels
        actual(i, 7) = Rgba8{};
    }
    EXPECT_TRUE(check_golden("a", actual, folders_));
    EXPECT_THAT(failures(), IsEmpty());
}

TEST_F(GoldenPicture, FailsBeyondThemAndSavesBothPictures) {
    Image actual = golden_;
    for (int i = 0; i < 11; ++i) {
        actual(i, 7).b = 205;
    }
    const auto checked = check_golden("a", actual, folders_);
    ASSERT_FALSE(checked);
    EXPECT_THAT(checked.error().message, HasSubstr("0.220 % of the pixels"));
    EXPECT_THAT(failures(), ElementsAre("a.actual.png", "a.difference.png"));
    const auto difference = io::read_image(folders_.failures / "a.difference.png");
    ASSERT_TRUE(difference);
    EXPECT_EQ((*difference)(3, 7), (Rgba8{0, 0, 40}));
    EXPECT_EQ((*difference)(3, 8), (Rgba8{0, 0, 0}));
}

TEST_F(GoldenPicture, FailsWhereItIsOfAnotherSize) {
    const auto checked = check_golden("a", Image(50, 100), folders_);
    ASSERT_FALSE(checked);
    EXPECT_THAT(checked.error().message, HasSubstr("50x100, 100x50 was expected"));
}

TEST_F(GoldenPicture, FailsWhereThereIsNoneAndMakesNone) {
    const auto checked = check_golden("b", golden_, folders_);
    ASSERT_FALSE(checked);
    EXPECT_THAT(checked.error().message, HasSubstr("b.png"));
    EXPECT_FALSE(std::filesystem::exists(folders_.pictures / "b.png"));
    EXPECT_THAT(failures(), ElementsAre("b.actual.png"));
}

} // namespace
} // namespace reljef::test
