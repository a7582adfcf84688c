// XML whose elements are nested so deep that GDAL's readers take over a hundred times its length.
#include "engine/io/checks/xml_nesting.h"

#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/footprints/footprint_file.h"
#include "engine/io/formats/flight_file.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) {
        all += text;
    }
    return all;
}

// With its byte order mark, little-endian.
std::string utf16(std::u16string_view text) {
    std::string bytes = "\xFF\xFE";
    for (const char16_t unit : text) {
        bytes += {static_cast<char>(unit & 0xFFU), static_cast<char>(unit >> 8U)};
    }
    return bytes;
}

class XmlNesting : public testing::Test {
protected:
    /// Whether a file with this text is within a depth of 3.
    [[nodiscard]] bool is_flat(const std::string& text) const {
        return bool(check_xml_nesting(folder_.write("a.xml", text), 3));
    }

    test::TemporaryFolder folder_;
};

TEST_F(XmlNesting, CountsOpenElements) {
    EXPECT_TRUE(is_flat("<?xml version=\"1.0\"?>\n<a><b><c/><c>x</c><c i='/' /></b></a>"));
    EXPECT_TRUE(is_flat("<a><b>" + repeated("<c></c><c/>", 100) + "</b></a>"));
    EXPECT_FALSE(is_flat("<a><b><c><d></d></c></b></a>"));
    EXPECT_FALSE(is_flat(repeated("<a>", 4)));
}

TEST_F(XmlNesting, WhatHidesElementsCountsToo) {
    const std::string deep = repeated("<a>", 4);
    EXPECT_FALSE(is_flat(repeated("<a b='/>'>", 4))) << "a value that looks like an end";
    EXPECT_FALSE(is_flat("<a><!-- </a></a></a> -->" + deep)) << "an end in a comment";
    EXPECT_FALSE(is_flat("<a><![CDATA[</a></a>]]]>" + deep)) << "an end in a text";
    EXPECT_FALSE(is_flat("<?p it's ?>" + deep)) << "a quote in an instruction";
    EXPECT_FALSE(is_flat(repeated("<a><?p > </a> ?>", 4))) << "an end in an instruction";
    EXPECT_FALSE(is_flat("<!DOCTYPE a [<!-- it's -->]>" + deep)) << "a quote in a comment";
    EXPECT_FALSE(is_flat("<!DOCTYPE a [<!ENTITY e '<b><b><b><b></b></b></b></b>'>]><a>&e;</a>"))
        << "elements of an entity";
    EXPECT_FALSE(is_flat("<?xml version='1.0' encoding='windows-1251'?>" + deep));
    EXPECT_FALSE(is_flat(utf16(u"<a>\u2F3C\u3E61<a>\u2F3C\u3E61<a>\u2F3C\u3E61<a>")));
}

TEST_F(XmlNesting, WhatIsNoElementDoesNotCount) {
    EXPECT_TRUE(is_flat("<a><!-- <a><a><a> --><![CDATA[<a><a>]]]><b>1 > 0</b></a>"));
    EXPECT_TRUE(is_flat("<!DOCTYPE a><a><?p <a><a><a> ?></a>"));
    EXPECT_TRUE(is_flat(utf16(u"<a>\u043C\u043E\u043B\u043E\u043A\u043E\u043C</a>")));
    EXPECT_TRUE(is_flat("{\"a\": \"" + repeated("<a>", 9) + "\"}")) << "no XML";
    EXPECT_TRUE(is_flat(""));
}

// Readers would begin it anew with each piece: hours for a file of 500 MB.
TEST_F(XmlNesting, ATagWithoutAnEndIsRefused) {
    const std::string long_text(3U << 20U, 'x');
    EXPECT_FALSE(is_flat("<a b='" + long_text + "'></a>"));
    EXPECT_FALSE(is_flat("<a" + long_text));
    EXPECT_TRUE(is_flat("<a>" + long_text + "</a>"));
    EXPECT_TRUE(is_flat("<a><![CDATA[" + long_text + "]]></a>"));
}

TEST_F(XmlNesting, DeepTracksAndOutlinesAreRefused) {
    const auto track = read_track(folder_.write("a.gpx", "<gpx>" + repeated("<trk>", 100)), 10.0);
    ASSERT_FALSE(track);
    EXPECT_THAT(track.error().message, HasSubstr("nested more than 64 deep"));
    EXPECT_THAT(read_track("/dev/zero", 10.0).error().message, HasSubstr("no regular file"));
    const auto outlines =
        read_footprints(folder_.write("a.kml", "<kml>" + repeated("<Folder>", 100)), {}, {});
    ASSERT_FALSE(outlines);
    EXPECT_THAT(outlines.error().message, HasSubstr("nested more than 64 deep"));
}

} // namespace
} // namespace reljef::io
