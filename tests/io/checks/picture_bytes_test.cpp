// Pictures of few bytes that take much memory.
#include "engine/io/checks/picture_bytes.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/image/channels.h"
#include "engine/io/image/image.h"
#include "engine/io/terrain_file.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

std::string chunk_head(const std::string& type, std::size_t length) {
    std::string bytes;
    for (unsigned shift : {24U, 16U, 8U, 0U}) {
        bytes += static_cast<char>((length >> shift) & 0xFFU);
    }
    return bytes + type;
}

std::string chunk(const std::string& type, std::size_t length) {
    return chunk_head(type, length) + std::string(length + 4, 'x'); // the checksum comes last
}

class PictureBytes : public ::testing::Test {
protected:
    /// A picture with chunks before its pixels, or else behind them.
    [[nodiscard]] fs::path png_with(const std::string& chunks, bool before = true) const {
        EXPECT_TRUE(write_image(folder_.path() / "whole.png", Image(64, 64)));
        std::string bytes = test::read_bytes(folder_.path() / "whole.png");
        constexpr std::size_t end_of_header = 8 + 25;
        bytes.insert(before ? end_of_header : bytes.size() - 12, chunks);
        return folder_.write("a.png", bytes);
    }
    [[nodiscard]] static std::string repeated(const std::string& text, int times) {
        std::string all;
        for (int i = 0; i < times; ++i) {
            all += text;
        }
        return all;
    }
    [[nodiscard]] static std::string error_of(const fs::path& path) {
        const auto terrain = read_terrain(path);
        return terrain ? "" : terrain.error().message;
    }
    /// `type`: 2 for colours, 10 for colours in packets.
    [[nodiscard]] fs::path tga(int type, unsigned side, std::size_t bytes) const {
        std::string head(18, '\0');
        head[2] = static_cast<char>(type);
        head[12] = head[14] = static_cast<char>(side & 0xFFU);
        head[13] = head[15] = static_cast<char>(side >> 8U);
        head[16] = 32;
        return folder_.write("a.tga", head + std::string(bytes, '\0'));
    }

    test::TemporaryFolder folder_;
};

TEST_F(PictureBytes, ManyCompressedTextsOfAPngAskForNoMemory) {
    constexpr const char* reason = "texts and colour profiles that may take over 64 MB";
    for (const char* const type : {"zTXt", "iTXt", "iCCP"}) {
        const fs::path path = png_with(repeated(chunk(type, 7752), 9)); // 8 MB inflated, each
        EXPECT_THAT(error_of(path), HasSubstr(reason)) << type;
        const auto picture = read_image(path);
        ASSERT_FALSE(picture);
        EXPECT_THAT(picture.error().message, HasSubstr(reason)) << type;
        EXPECT_FALSE(read_channels(path));
    }
    EXPECT_FALSE(read_image(png_with(repeated(chunk("zTXt", 7752), 9), false)));
}

TEST_F(PictureBytes, ManyTextsOfAPngInAnArchiveAskForNoMemory) {
    const fs::path archive = folder_.path() / "a.zip";
    ASSERT_TRUE(test::add_to_zip(archive, "a.png",
                                 test::read_bytes(png_with(repeated(chunk("zTXt", 7752), 9)))));
    EXPECT_THAT(error_of(archive), HasSubstr("texts and colour profiles"));
}

TEST_F(PictureBytes, ATextOfAPngThatIsLongerThanTheFileAsksForNoMemory) {
    for (const char* const type :
         {"tEXt", "zTXt", "iTXt", "iCCP", "sPLT", "eXIf", "pCAL", "sCAL"}) {
        const fs::path huge = png_with(chunk_head(type, 0x65000055));
        EXPECT_THAT(error_of(huge), HasSubstr("texts and colour profiles")) << type;
        EXPECT_FALSE(read_image(huge)) << type;
        const fs::path large = png_with(chunk_head(type, 40'000'000));
        EXPECT_THAT(error_of(large), HasSubstr("a PNG without its end")) << type;
        EXPECT_FALSE(read_image(large)) << type;
    }
}

TEST_F(PictureBytes, SomeTextsAndAProfileAreNoError) {
    const fs::path path =
        png_with(chunk("iCCP", 3000) + repeated(chunk("zTXt", 2000), 4) + chunk("tEXt", 100'000));
    EXPECT_TRUE(check_png(path.string(), PngPart::whole));
    EXPECT_TRUE(check_png(png_with(repeated(chunk("pRvt", 7752), 100)).string(), PngPart::whole));
}

TEST_F(PictureBytes, ATgaThatEndsEarlyIsNotTakenForBlack) {
    EXPECT_THAT(error_of(tga(2, 65535, 1000)), HasSubstr("ends early: 1018 bytes were found"));
    EXPECT_THAT(error_of(tga(2, 100, 39000)), HasSubstr("ends early"));
    EXPECT_THAT(error_of(tga(10, 65535, 1000)), HasSubstr("ends early"));
    EXPECT_EQ(error_of(tga(2, 100, 40000)), "");
}

} // namespace
} // namespace reljef::io
