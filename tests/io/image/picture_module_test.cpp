#include "engine/io/image/picture_module.h"

#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/image.h"
#include "engine/io/raster/gdal_dataset.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(PictureModule, ThatIsNoneIsOneSentence) {
    const test::TemporaryFolder folder;
    const std::vector<std::pair<fs::path, std::string_view>> cases{
        {folder.path() / "missing.so", "does not exist"},
        {folder.path(), "does not exist"},
        {folder.write("text.so", "no library"), "cannot be loaded ("},
        {"/proc/self/exe", "cannot be loaded ("},
        {RELJEF_OTHER_PICTURES, "belongs to another reljef"}};
    for (const auto& [file, words] : cases) {
        const auto codec = load_picture_codec(file);
        ASSERT_FALSE(codec) << file;
        const std::string& message = codec.error().message;
        EXPECT_THAT(message, StartsWith(file.string() + ": " + std::string(words)));
        EXPECT_THAT(message, HasSubstr(", the library with which this reljef reads and writes "
                                       "pictures was expected"));
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
}

TEST(PictureModule, LiesBesideTheProgram) {
    EXPECT_TRUE(find_picture_module());
    EXPECT_TRUE(load_picture_codec(RELJEF_PICTURES));
    const auto codec = picture_codec();
    ASSERT_TRUE(codec) << codec.error().message;
    EXPECT_EQ(*picture_codec(), *codec);
}

// What the program says of names without the module.
TEST(PictureModule, KnowsTheFormatsOfTheirNames) {
    const auto codec = picture_codec();
    ASSERT_TRUE(codec) << codec.error().message;
    const std::vector<std::pair<std::string, std::vector<std::string>>> formats{
        {"png", {".png", ".PNG"}},
        {"jpeg", {".jpg", ".jpeg", ".jpe", ".jif", ".jfif", ".jfi", ".JPG"}},
        {"tiff", {".tif", ".tiff", ".tx", ".env", ".sm", ".vsm", ".TIF"}}};
    for (const auto& [format, extensions] : formats) {
        for (const std::string& extension : extensions) {
            const auto output = (*codec)->create_output("a" + extension);
            ASSERT_NE(output, nullptr) << extension;
            EXPECT_EQ(output->format(), format);
            EXPECT_TRUE(shows_damage("a" + extension));
            EXPECT_TRUE(check_image_name("a" + extension));
        }
    }
    for (const char* const extension : {".exr", ".bmp", ".tga"}) {
        EXPECT_TRUE(check_image_name(std::string("a") + extension));
        EXPECT_FALSE(shows_damage(std::string("a") + extension));
    }
    EXPECT_FALSE(check_image_name("a.jp2"));
    EXPECT_FALSE(check_image_name("a.txt"));
}

TEST(PngStream, WritesTheBytesOfOpenImageIo) {
    const auto codec = picture_codec();
    ASSERT_TRUE(codec) << codec.error().message;
    std::mt19937 random(5);
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(7, 3), glm::ivec2(300, 200)}) {
        Image image(size.x, size.y);
        for (Rgba8& pixel : image.samples()) {
            const auto level = static_cast<std::uint8_t>(random() % 64);
            pixel = {level, static_cast<std::uint8_t>(level * 2), 7, level};
        }
        auto output = (*codec)->create_output("png");
        ASSERT_NE(output, nullptr);
        PictureSpec spec{size.x, size.y, 3};
        spec.texts = {{"oiio:ColorSpace", "sRGB"}, {"Compression", "zip"}};
        const auto theirs = output->encode(spec, {image.samples().data(), sizeof(Rgba8)});
        ASSERT_TRUE(theirs);
        EXPECT_EQ(encode_image(".png", image).value(), theirs);
    }
}

// OpenImageIO and GDAL each replace libtiff's handlers of messages once: GDAL's must stay.
TEST(PictureModule, LeavesTiffMessagesToGdal) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(write_image(folder.path() / "picture.tif", Image(64, 64, {1, 2, 3, 255})));
    ASSERT_TRUE(read_image(folder.path() / "picture.tif"));
    test::MadeRaster raster = test::made_raster(64, 64, [](int col, int row) { return col * row; });
    raster.options = {"COMPRESS=DEFLATE"};
    ASSERT_TRUE(test::write(raster, folder.path() / "dem.tif"));
    const std::string whole = test::read_bytes(folder.path() / "dem.tif");
    std::string damaged = whole;
    for (std::size_t i = whole.size() / 2; i < whole.size(); ++i) {
        damaged[i] = 'x';
    }
    folder.write("dem.tif", damaged);
    ::testing::internal::CaptureStderr();
    const GdalMessages messages;
    const auto dem = open_raster(folder.path() / "dem.tif", messages);
    ASSERT_TRUE(dem) << dem.error().message;
    std::vector<double> samples(64 * 64);
    EXPECT_FALSE(
        read_window(*(*dem)->GetRasterBand(1), {{0, 0}, {64, 64}, samples.data(), {64, 64}}));
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    EXPECT_THAT(messages.all(), Contains(HasSubstr("ZIPDecode")));
}

// libtiff has one handler for all that read TIFFs.
TEST(PictureModule, PrintsNothingOfADamagedTiff) {
    const test::TemporaryFolder folder;
    const fs::path path = folder.path() / "picture.tif";
    ASSERT_TRUE(write_image(path, Image(64, 64, {1, 2, 3, 255})));
    const std::string whole = test::read_bytes(path);
    for (std::size_t place = 8; place < whole.size(); place += 3) {
        std::string damaged = whole;
        damaged[place] = static_cast<char>(damaged[place] ^ 0x55);
        folder.write("picture.tif", damaged);
        ::testing::internal::CaptureStderr();
        const auto picture = read_image(path);
        EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << place;
        if (!picture) {
            EXPECT_EQ(picture.error().message.find("()"), std::string::npos)
                << picture.error().message;
        }
    }
}

} // namespace
} // namespace reljef::io
