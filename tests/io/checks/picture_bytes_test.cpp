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

std::string little_endian_bytes(unsigned value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) {
        text += static_cast<char>(value >> (8 * i) & 0xFFU);
    }
    return text;
}

std::string gif(unsigned side) {
    return "GIF89a" + little_endian_bytes(side, 2) + little_endian_bytes(side, 2) +
           std::string(100, '\0');
}

// Extended, lossless and lossy.
std::string webp(const std::string& chunk, unsigned side) {
    const std::string head =
        "RIFF" + little_endian_bytes(150, 4) + "WEBP" + chunk + little_endian_bytes(10, 4);
    const std::string size =
        chunk == "VP8X" ? std::string(4, '\2') + little_endian_bytes(side - 1, 3) +
                              little_endian_bytes(side - 1, 3)
        : chunk == "VP8L"
            ? '\x2F' + little_endian_bytes((side - 1) | ((side - 1) << 14U), 4)
            : std::string(6, '\0') + little_endian_bytes(side, 2) + little_endian_bytes(side, 2);
    return head + size + std::string(100, '\0');
}

// Found by fuzzing: their readers allocate gigabytes for a picture of 139 bytes when they open it.
TEST_F(PictureBytes, AGifOrWebpOfFewBytesThatClaimsManyPixelsIsNotOpened) {
    const auto size_of = [&](const std::string& bytes) {
        return claimed_size(folder_.write("a", bytes).string());
    };
    EXPECT_EQ(size_of(gif(12345)), glm::ivec2(12345));
    EXPECT_EQ(size_of(webp("VP8X", 60'000)), glm::ivec2(60'000));
    EXPECT_EQ(size_of(webp("VP8L", 12345)), glm::ivec2(12345));
    EXPECT_EQ(size_of(webp("VP8 ", 12345)), glm::ivec2(12345));
    EXPECT_EQ(size_of(gif(23'000).substr(0, 26)), glm::ivec2(23'000)) << "a short file";
    EXPECT_EQ(size_of(webp("VP8L", 12345).substr(0, 26)), glm::ivec2(12345));
    EXPECT_EQ(size_of(""), std::nullopt);
    EXPECT_EQ(size_of(std::string(100, 'x')), std::nullopt);
    for (const std::string& bytes : {gif(60'000), gif(23'000).substr(0, 26), webp("VP8X", 60'000),
                                     webp("VP8L", 16'000), webp("VP8 ", 16'000)}) {
        const auto read = read_image(folder_.write("a", bytes));
        ASSERT_FALSE(read);
        EXPECT_THAT(read.error().message, HasSubstr("claims"));
    }
}

} // namespace
} // namespace reljef::io
