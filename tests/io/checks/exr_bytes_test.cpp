// OpenEXR files of few bytes whose headers make OpenEXR take much memory.
#include "engine/io/checks/exr_bytes.h"

#include <cstdint>
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

std::string word(std::uint32_t value) {
    std::string bytes;
    for (unsigned shift : {0U, 8U, 16U, 24U}) {
        bytes += static_cast<char>((value >> shift) & 0xFFU);
    }
    return bytes;
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + word(static_cast<std::uint32_t>(value.size())) + value;
}

std::string exr(const std::string& attributes, std::uint32_t flags = 2) {
    return word(20000630) + word(flags) + attributes + '\0';
}

class ExrBytes : public ::testing::Test {
protected:
    [[nodiscard]] std::string error_of(const std::string& bytes) const {
        const auto good = check_exr(folder_.write("a.exr", bytes).string());
        return good ? "" : good.error().message;
    }
    test::TemporaryFolder folder_;
};

TEST_F(ExrBytes, WrittenHitsAndMapsAreGood) {
    const auto path = folder_.path() / "hits.exr";
    ASSERT_TRUE(write_hits(path, HitBuffer(17, 5)));
    EXPECT_TRUE(check_exr(path.string()));
    EXPECT_TRUE(read_hits(path));
}

TEST_F(ExrBytes, OtherFilesAreNoErrors) {
    EXPECT_EQ(error_of(""), "");
    EXPECT_EQ(error_of("v/1"), "");
    EXPECT_EQ(error_of("P5 2 2 255 abcd"), "");
    EXPECT_TRUE(check_exr((folder_.path() / "none.exr").string()));
}

// Found by fuzzing: OpenEXR takes two gigabytes for a text of that claimed length.
TEST_F(ExrBytes, ATextLongerThanTheFileIsRefusedBeforeItIsOpened) {
    const std::string claim = std::string("owner\0string\0", 13) + word(0x7FFFFFFF) + "x";
    EXPECT_THAT(error_of(exr(claim)), HasSubstr("claims other lengths than it has"));
    const auto path = folder_.write("b.exr", exr(claim));
    const auto hits = read_hits(path);
    ASSERT_FALSE(hits);
    EXPECT_THAT(hits.error().message, HasSubstr("claims other lengths than it has"));
    EXPECT_FALSE(read_channels(path));
    EXPECT_FALSE(read_image(path));
}

TEST_F(ExrBytes, ATextInAListLongerThanTheListIsRefused) {
    const std::string good = word(3) + "abc" + word(0);
    EXPECT_EQ(error_of(exr(attribute("views", "stringvector", good))), "");
    EXPECT_THAT(error_of(exr(attribute("views", "stringvector", good + word(0x7FFFFFF0) + "x"))),
                HasSubstr("claims other lengths"));
    EXPECT_THAT(error_of(exr(attribute("views", "stringvector", "ab"))),
                HasSubstr("claims other lengths"));
}

std::string channel(const std::string& name) {
    return name + '\0' + word(2) + word(0) + word(1) + word(1);
}

// Found by fuzzing: OpenEXR reads channels up to an empty name, and what follows as attributes.
TEST_F(ExrBytes, AListOfChannelsThatEndsElsewhereIsRefused) {
    const std::string two = channel("col") + channel("row");
    EXPECT_EQ(error_of(exr(attribute("channels", "chlist", two + '\0'))), "");
    const std::string claim = std::string("owner\0string\0", 13) + word(0x7FFFFFFF) + "x";
    for (const auto& list :
         {two, two + "rest", two + std::string(1, '\0').append(claim), std::string("a"),
          std::string("a\0b", 3), two + std::string("a\0", 2), std::string()}) {
        EXPECT_THAT(error_of(exr(attribute("channels", "chlist", list))),
                    HasSubstr("claims other lengths"));
        EXPECT_THAT(error_of(exr(attribute("others", "chlist", list))),
                    HasSubstr("claims other lengths"));
    }
}

TEST_F(ExrBytes, ChannelsOfSeveralListsCountTogether) {
    const std::string box = word(0) + word(0) + word(9999) + word(9);
    const std::string window = attribute("dataWindow", "box2i", box);
    std::string list;
    for (int i = 0; i < 4000; ++i) {
        list += channel(std::to_string(i));
    }
    const std::string channels = attribute("channels", "chlist", list + '\0');
    EXPECT_EQ(error_of(exr(window + channels)), "");
    EXPECT_THAT(error_of(exr(window + channels + channels)), HasSubstr("claims"));
}

TEST_F(ExrBytes, AnAttributeOfAnotherLengthThanItsTypeIsRefused) {
    EXPECT_EQ(error_of(exr(attribute("count", "int", word(1)))), "");
    EXPECT_EQ(error_of(exr(attribute("own", "unknown", "12345"))), "");
    for (const std::string type : {"int", "box2i", "compression", "v2f", "floatvector"}) {
        EXPECT_THAT(error_of(exr(attribute("own", type, "12345"))),
                    HasSubstr("claims other lengths"));
    }
}

TEST_F(ExrBytes, APreviewOfMorePixelsThanItHoldsIsRefused) {
    EXPECT_EQ(error_of(exr(attribute("preview", "preview", word(1) + word(1) + "rgba"))), "");
    EXPECT_THAT(error_of(exr(attribute("preview", "preview", word(40000) + word(40000) + "rgba"))),
                HasSubstr("claims other lengths"));
}

TEST_F(ExrBytes, AWindowOfTooManyPixelsIsRefused) {
    const auto window = [](std::uint32_t right, std::uint32_t bottom) {
        return attribute("dataWindow", "box2i", word(0) + word(0) + word(right) + word(bottom));
    };
    EXPECT_EQ(error_of(exr(window(65535, 65535))), "");
    EXPECT_THAT(error_of(exr(window(65536, 10))), HasSubstr("claims 65537×11 pixels"));
    EXPECT_THAT(error_of(exr(window(10, 0x7FFFFFFF))), HasSubstr("claims 11×2147483648 pixels"));
}

TEST_F(ExrBytes, BlocksThatTakeMuchMemoryAreRefused) {
    const std::string window =
        attribute("dataWindow", "box2i", word(0) + word(0) + word(65535) + word(99));
    std::string channels;
    for (int i = 0; i < 300; ++i) {
        channels += "c" + std::to_string(i) + '\0' + std::string(16, '\0');
    }
    const std::string list = attribute("channels", "chlist", channels + '\0');
    const std::string by_16_lines = attribute("compression", "compression", "\x03");
    EXPECT_THAT(error_of(exr(window + list + by_16_lines)),
                HasSubstr("blocks of 1048576 pixels of 300 channels"));
    EXPECT_EQ(error_of(exr(window + list)), "") << "blocks of a line";
    const std::string tiles = attribute("tiles", "tiledesc", word(60000) + word(60000) + '\0');
    EXPECT_THAT(error_of(exr(window + list + tiles)), HasSubstr("blocks of 3600000000 pixels"));
}

TEST_F(ExrBytes, MoreTilesThanTheFileHoldsAreRefused) {
    const std::string window =
        attribute("dataWindow", "box2i", word(0) + word(0) + word(65535) + word(65535));
    const std::string tiles = attribute("tiles", "tiledesc", word(1) + word(1) + '\0');
    EXPECT_THAT(error_of(exr(window + tiles)), HasSubstr("claims 4294967296 tiles"));
}

TEST_F(ExrBytes, EachPartOfAFileIsChecked) {
    constexpr std::uint32_t several_parts = 0x1002;
    const std::string good = attribute("name", "string", "a") + '\0';
    EXPECT_EQ(error_of(exr(good + good, several_parts)), "");
    const std::string wrong =
        attribute("dataWindow", "box2i", word(0) + word(0) + word(99999) + word(0)) + '\0';
    EXPECT_THAT(error_of(exr(good + wrong, several_parts)), HasSubstr("claims 100000×1"));
    EXPECT_THAT(error_of(word(20000630) + word(several_parts) + good),
                HasSubstr("claims other lengths"));
}

} // namespace
} // namespace reljef::io
