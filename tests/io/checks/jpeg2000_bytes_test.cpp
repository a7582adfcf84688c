// JPEG 2000 files whose parts claim to end behind what holds them.
#include "engine/io/checks/jpeg2000_bytes.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

std::string big_endian(std::size_t number, int bytes) {
    std::string text;
    for (int i = bytes - 1; i >= 0; --i) {
        text += static_cast<char>(number >> (8U * static_cast<unsigned>(i)) & 0xFFU);
    }
    return text;
}

std::string box(const std::string& type, const std::string& content, std::ptrdiff_t more = 0) {
    const std::size_t length = 8 + content.size() + static_cast<std::size_t>(more);
    return big_endian(length, 4) + type + content;
}

std::string segment(std::size_t marker, std::size_t length, std::size_t claimed) {
    return big_endian(marker, 2) + big_endian(claimed, 2) + std::string(length - 2, 'x');
}

// `claimed`: the length of the part; it has 20 bytes, 6 of them behind its header.
std::string tile_part(std::size_t claimed) {
    return big_endian(0xFF90, 2) + big_endian(10, 2) + big_endian(0, 2) + big_endian(claimed, 4) +
           std::string("\0\1", 2) + big_endian(0xFF93, 2) + "pixels";
}

const std::string header = big_endian(0xFF4F, 2) + segment(0xFF51, 9, 9);
const std::string ending = big_endian(0xFFD9, 2);
const std::string signature = box("jP  ", "\r\n\x87\n");

class Jpeg2000Bytes : public ::testing::Test {
protected:
    [[nodiscard]] std::string error_of(const std::string& bytes) const {
        const auto good = check_jpeg2000(folder_.write("a.jp2", bytes).string());
        return good ? "" : good.error().message;
    }
    void expect_refused(const std::string& bytes) const {
        EXPECT_THAT(error_of(bytes), HasSubstr("a.jp2: cannot be read"));
    }
    test::TemporaryFolder folder_;
};

TEST_F(Jpeg2000Bytes, WholeFilesAreGood) {
    const std::string codestream = header + tile_part(20) + tile_part(20) + ending;
    for (const std::string& bytes :
         {codestream, header + tile_part(20), header + tile_part(0) + "more pixels" + ending,
          signature + box("jp2h", "a box") + box("jp2c", codestream) + box("uuid", "behind"),
          signature + big_endian(0, 4) + "jp2c" + codestream,
          signature + big_endian(1, 4) + "JP2C" + big_endian(16 + codestream.size(), 8) +
              codestream}) {
        EXPECT_EQ(error_of(bytes), "");
    }
}

TEST_F(Jpeg2000Bytes, OtherFilesAreNone) {
    for (const char* bytes : {"", "P6", "no picture at all"}) {
        EXPECT_EQ(error_of(bytes), "");
    }
    EXPECT_TRUE(check_jpeg2000((folder_.path() / "absent").string()));
}

TEST_F(Jpeg2000Bytes, PartsThatEndBehindTheFileAreRefused) {
    expect_refused(header + tile_part(21));
    expect_refused(header + tile_part(20) + tile_part(0xFFFFFFFF) + ending);
    expect_refused(big_endian(0xFF4F, 2) + segment(0xFF51, 9, 200) + tile_part(20));
    expect_refused(signature + box("jp2h", "a box", 100));
    expect_refused(signature + box("jp2c", header + tile_part(20) + ending, 1));
}

// OpenJPEG 2.5.0 asserts that it stays within the box.
TEST_F(Jpeg2000Bytes, PartsThatEndBehindTheirBoxAreRefused) {
    const std::string codestream = header + tile_part(20) + ending;
    for (std::ptrdiff_t less = 1; less <= static_cast<std::ptrdiff_t>(codestream.size()); ++less) {
        const std::string bytes = signature + box("jp2c", codestream, -less);
        EXPECT_EQ(error_of(bytes).empty(), less == 2) << less << ": the last marker may be missing";
    }
}

TEST_F(Jpeg2000Bytes, PartsWithoutASenseAreRefused) {
    for (const std::size_t length : {1U, 11U, 13U}) {
        expect_refused(header + tile_part(length) + ending);
    }
    for (std::size_t length = 2; length < 8; ++length) {
        expect_refused(signature + big_endian(length, 4) + "jp2h");
    }
    expect_refused(header + tile_part(20) + segment(0xFF52, 9, 9));
    expect_refused(header + "\1\2\3\4" + tile_part(20));
    expect_refused(header);
    expect_refused(header + ending);
    expect_refused(signature + box("jp2c", "no codestream"));
    expect_refused(signature + box("jp2c", ""));
    expect_refused(signature);
}

} // namespace
} // namespace reljef::io
