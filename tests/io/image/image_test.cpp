#include "engine/io/image/image.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/channels.h"
#include "tests/io/made_raster.h"
#include "tests/support/process_state.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

Image random_image(int cols, int rows) {
    std::mt19937 random(1);
    Image image(cols, rows);
    for (Rgba8& pixel : image.samples()) {
        const auto byte = [&] { return static_cast<std::uint8_t>(random() % 256); };
        pixel = {byte(), byte(), byte(), byte()};
    }
    return image;
}

TEST(ImageFile, APngComesBackOpaque) {
    const test::TemporaryFolder folder;
    const Image image = random_image(37, 23);
    const auto path = folder.path() / "a.png";
    const auto written = write_image(path, image);
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.png"});
    const auto again = read_image(path);
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(again->cols(), 37);
    ASSERT_EQ(again->rows(), 23);
    for (std::size_t i = 0; i < image.size(); ++i) {
        Rgba8 opaque = image.samples()[i];
        opaque.a = 255;
        ASSERT_EQ(again->samples()[i], opaque);
    }
}

TEST(ImageFile, EncodedInMemoryItIsTheFileByteForByte) {
    const test::TemporaryFolder folder;
    const Image image = random_image(37, 23);
    for (const std::string extension : {".png", ".jpg"}) {
        const auto path = folder.path() / ("a" + extension);
        ASSERT_TRUE(write_image(path, image));
        const auto bytes = encode_image(extension, image);
        ASSERT_TRUE(bytes) << bytes.error().message;
        const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
        EXPECT_EQ(text, test::read_bytes(path));
    }
}

// PNG's checksums cover what decides the pixels.
TEST(ImageFile, DamageAnywhereIsFound) {
    const test::TemporaryFolder folder;
    for (const std::string extension : {".png", ".jpg", ".tif"}) {
        const auto path = folder.path() / ("a" + extension);
        ASSERT_TRUE(shows_damage(path));
        ASSERT_TRUE(write_image(path, random_image(9, 7)));
        const auto whole = read_undamaged_image(path);
        ASSERT_TRUE(whole) << whole.error().message;
        EXPECT_EQ(*whole, *read_image(path));
        const std::string bytes = test::read_bytes(path);
        testing::internal::CaptureStderr(); // libpng's words
        for (std::size_t place = 0; place < bytes.size(); place += 3) {
            std::string damaged = bytes;
            damaged[place] = static_cast<char>(damaged[place] ^ 8);
            folder.write(path.filename().string(), damaged);
            const auto found = read_undamaged_image(path);
            EXPECT_TRUE(!found || (extension == ".png" && *found == *whole)) << path << place;
            folder.write(path.filename().string(), bytes.substr(0, place));
            const auto cut = read_undamaged_image(path);
            EXPECT_TRUE(!cut || (extension == ".png" && *cut == *whole)) << path << place;
        }
        testing::internal::GetCapturedStderr();
    }
    EXPECT_FALSE(shows_damage("a.bmp"));
    EXPECT_FALSE(shows_damage("a"));
}

TEST(ImageFile, EqualPicturesAreEqualFiles) {
    const test::TemporaryFolder folder;
    for (const std::string extension : {".png", ".jpg", ".tif"}) {
        const auto bytes = encode_image(extension, random_image(9, 7));
        ASSERT_TRUE(bytes) << bytes.error().message;
        EXPECT_EQ(*bytes, *encode_image(extension, random_image(9, 7)));
        const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
        const bool holds_no_time = text.find("    :  :     :  :  ") != std::string::npos;
        EXPECT_TRUE(extension != ".tif" || holds_no_time);
    }
}

TEST(ImageFile, WhatCannotBeEncodedIsNamed) {
    const auto unknown = encode_image(".nothing", random_image(2, 2));
    ASSERT_FALSE(unknown);
    EXPECT_THAT(unknown.error().message, HasSubstr(".nothing"));
    const auto empty = encode_image(".png", Image());
    ASSERT_FALSE(empty);
    EXPECT_THAT(empty.error().message, HasSubstr("0×0"));
}

TEST(ImageFile, AnExistingFileIsReplaced) {
    const test::TemporaryFolder folder;
    const auto path = folder.write("a.png", "old");
    ASSERT_TRUE(write_image(path, random_image(4, 4)));
    const auto again = read_image(path);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->cols(), 4);
}

TEST(ImageFile, JpegsAreNearTheirOriginal) {
    const test::TemporaryFolder folder;
    const Image grey(64, 64, Rgba8{120, 130, 140, 255});
    ASSERT_TRUE(write_image(folder.path() / "a.jpg", grey));
    const auto again = read_image(folder.path() / "a.jpg");
    ASSERT_TRUE(again);
    EXPECT_NEAR((*again)(30, 30).r, 120, 3);
    EXPECT_NEAR((*again)(30, 30).b, 140, 3);
}

TEST(ImageFile, UnwritablePathsAreNamedAndLeaveNothing) {
    const test::TemporaryFolder folder;
    const Image image = random_image(4, 4);
    for (const auto& path : {folder.path() / "none" / "a.png", folder.path() / "a.nonsense",
                             folder.path() / "a", folder.path()}) {
        const auto written = write_image(path, image);
        ASSERT_FALSE(written) << path;
        EXPECT_THAT(written.error().message, HasSubstr(path.string()));
        EXPECT_THAT(written.error().message, HasSubstr("cannot be written"));
    }
    EXPECT_TRUE(folder.names().empty());
}

// Encoders overlook that they could not write.
TEST(ImageFile, AFullDiskIsAnErrorAndLeavesNothing) {
    const test::TemporaryFolder folder;
    const Image image = random_image(100, 100);
    ::testing::internal::CaptureStderr();
    const test::FileSizeLimit limit(1024);
    for (const char* const name : {"a.png", "a.jpg", "a.tif", "a.webp", "a.exr", "a.bmp"}) {
        const auto written = write_image(folder.path() / name, image);
        ASSERT_FALSE(written) << name;
        EXPECT_THAT(written.error().message, HasSubstr(std::string(name) + ": cannot be written"));
        EXPECT_TRUE(folder.names().empty()) << name;
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

// TIFF was once JPEG in a file that nothing could read.
TEST(ImageFile, WhatIsWrittenWithoutLossIsReadAgain) {
    const test::TemporaryFolder folder;
    Image image = random_image(30, 20);
    for (Rgba8& pixel : image.samples()) {
        pixel.a = 255;
    }
    for (const char* const name : {"a.png", "a.tif", "a.bmp", "a.tga", "a.ppm"}) {
        const auto path = folder.path() / name;
        ASSERT_TRUE(write_image(path, image)) << name;
        const auto read = read_image(path);
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_TRUE(std::ranges::equal(read->samples(), image.samples())) << name;
    }
}

TEST(ImageFile, AnEmptyPictureIsNotWritten) {
    const test::TemporaryFolder folder;
    EXPECT_FALSE(write_image(folder.path() / "a.png", Image{}));
    EXPECT_TRUE(folder.names().empty());
}

TEST(ImageFile, WhatIsNoPictureIsNamed) {
    const test::TemporaryFolder folder;
    const std::vector<std::pair<std::filesystem::path, std::string>> cases{
        {folder.path() / "none.png", "does not exist"},
        {folder.path(), "is no file"},
        {folder.write("empty.png", ""), "is empty"},
        {folder.write("text.png", "not a picture"), "cannot be read"},
        {folder.write("text.xyz", "not a picture"), "cannot be read"}};
    for (const auto& [path, words] : cases) {
        const auto image = read_image(path);
        ASSERT_FALSE(image) << path;
        EXPECT_THAT(image.error().message, HasSubstr(path.string()));
        EXPECT_THAT(image.error().message, HasSubstr(words));
    }
}

TEST(ImageFile, ACutPictureIsAnError) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(write_image(folder.path() / "a.png", random_image(100, 100)));
    const std::string whole = test::read_bytes(folder.path() / "a.png");
    for (const std::size_t length : {std::size_t{10}, std::size_t{40}, whole.size() / 2}) {
        ::testing::internal::CaptureStderr();
        EXPECT_FALSE(read_image(folder.write("cut.png", whole.substr(0, length)))) << length;
        EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    }
}

TEST(ImageFile, AHeaderThatClaimsMoreThanItCanHoldIsRefused) {
    const test::TemporaryFolder folder;
    const auto path = folder.write("a.ppm", "P6\n100000 100000\n255\nabcdef");
    const auto image = read_image(path);
    ASSERT_FALSE(image);
    EXPECT_THAT(image.error().message, HasSubstr("100000×100000"));
    EXPECT_FALSE(read_image(folder.write("b.ppm", "P6\n0 0\n255\nabcdef")));
}

TEST(ImageFile, ManyChannelsAskForNoMemory) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(test::write(test::SparseTiff{1200, 1200, 1000, {"INTERLEAVE=PIXEL"}},
                            folder.path() / "a.tif"));
    const auto image = read_image(folder.path() / "a.tif");
    ASSERT_FALSE(image);
    EXPECT_THAT(image.error().message, HasSubstr("1000 channels, which take 1.4 GB"));
    const auto channels = read_channels(folder.path() / "a.tif");
    ASSERT_FALSE(channels);
    EXPECT_THAT(channels.error().message, HasSubstr("1000 channels"));
}

TEST(ImageFile, ChannelsOfALargePictureAskForNoMemory) {
    const test::TemporaryFolder folder;
    // 12,000² pixels of RGB may be a picture, but take 1.7 GB as floats.
    std::string bytes = "P6\n12000 12000\n255\n";
    bytes.resize(80'000);
    const auto channels = read_channels(folder.write("a.ppm", bytes));
    ASSERT_FALSE(channels);
    EXPECT_THAT(channels.error().message, HasSubstr("at most 268435456 values were expected"));
}

TEST(ImageFile, GreyAndDeepPicturesBecomeEightBits) {
    const test::TemporaryFolder folder;
    const auto grey = read_image(folder.write("a.pgm", "P2\n2 1\n255\n7 200\n"));
    ASSERT_TRUE(grey) << grey.error().message;
    EXPECT_EQ((*grey)(0, 0), (Rgba8{7, 7, 7, 255}));
    EXPECT_EQ((*grey)(1, 0), (Rgba8{200, 200, 200, 255}));
    RELJEF_NEED_DATA("natural/png16_height_1024.png");
    const auto deep = read_image(test::data_path("natural/png16_height_1024.png"));
    ASSERT_TRUE(deep) << deep.error().message;
    EXPECT_EQ(deep->cols(), 1024);
}

TEST(ContactSheet, PlacesSmallCopiesRowByRow) {
    std::vector<Image> pictures;
    for (const std::uint8_t level : std::array<std::uint8_t, 3>{0, 100, 200}) {
        pictures.emplace_back(64, 32, Rgba8{level, 10, 20, 255});
    }
    const Image sheet = contact_sheet(pictures, 2, 16).value();
    ASSERT_EQ(sheet.cols(), 4 + 2 * 20);
    ASSERT_EQ(sheet.rows(), 4 + 2 * 12);
    EXPECT_EQ(sheet(4 + 8, 4 + 4), (Rgba8{0, 10, 20, 255}));
    EXPECT_EQ(sheet(24 + 8, 4 + 4), (Rgba8{100, 10, 20, 255}));
    EXPECT_EQ(sheet(4 + 8, 16 + 4), (Rgba8{200, 10, 20, 255}));
    EXPECT_EQ(sheet(24 + 8, 16 + 4), sheet(0, 0)); // nothing there
}

TEST(ContactSheet, OfNothingIsNothing) {
    EXPECT_TRUE(contact_sheet({}, 3, 100).value().empty());
}

} // namespace
} // namespace reljef::io
