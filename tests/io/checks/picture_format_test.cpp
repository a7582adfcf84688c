#include "engine/io/checks/picture_format.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/channels.h"
#include "engine/io/image/image.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

class PictureFormat : public ::testing::Test {
protected:
    [[nodiscard]] std::string format_of(const std::string& name, const std::string& bytes) const {
        const auto format = picture_format(folder_.write(name, bytes).string());
        return format ? *format : format.error().message;
    }
    test::TemporaryFolder folder_;
};

TEST_F(PictureFormat, IsToldByTheBytesAndNotByTheName) {
    for (const char* extension : {"png", "jpg", "tif", "bmp", "webp", "ppm"}) {
        const auto file = folder_.path() / ("a." + std::string(extension));
        Image picture(3, 2);
        ASSERT_TRUE(write_image(file, picture)) << extension;
        const auto other = folder_.path() / "other.dat";
        std::filesystem::copy_file(file, other, std::filesystem::copy_options::overwrite_existing);
        const auto read = read_image(other);
        ASSERT_TRUE(read) << extension << ": " << read.error().message;
        EXPECT_EQ(read->cols(), 3) << extension;
    }
    ASSERT_TRUE(write_image(folder_.path() / "a.tga", Image(3, 2)));
    EXPECT_TRUE(read_image(folder_.path() / "a.tga"));
    EXPECT_EQ(format_of("a.exr", std::string("v/1\x01", 4) + "rest"), "openexr");
    EXPECT_EQ(format_of("a.hdr", "#?RADIANCE\n"), "hdr");
}

// A playlist or a list of files is opened by FFmpeg, which OpenImageIO tries last for any name.
TEST_F(PictureFormat, VideosPlaylistsAndMadePicturesAreRefused) {
    const std::string lists[] = {"#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nhttp://host/a.ts\n",
                                 "ffconcat version 1.0\nfile b.png\n",
                                 std::string("\0\0\0\x18"
                                             "ftypmp42",
                                             12),
                                 "\x1A\x45\xDF\xA3webm",
                                 "8BPS",
                                 ""};
    for (const std::string& bytes : lists) {
        for (const char* name : {"a.png", "a.mp4", "a.null", "a.CR2", "a.vdb"}) {
            EXPECT_THAT(format_of(name, bytes), HasSubstr("PNG, JPEG")) << name;
            EXPECT_FALSE(read_image(folder_.path() / name)) << name;
            EXPECT_FALSE(read_channels(folder_.path() / name)) << name;
        }
    }
}

TEST_F(PictureFormat, ShortFilesAreNoneOfThem) {
    for (const char* bytes : {"P", "P6", "P7 ", "R", "RIFF", "RIFF1234WEB", "B"}) {
        EXPECT_THAT(format_of("a.png", bytes), HasSubstr("unknown")) << bytes;
    }
    EXPECT_EQ(format_of("a.png", "P6\n"), "pnm");
}

} // namespace
} // namespace reljef::io
