// XML whose elements make GDAL's readers crash, or take over a hundred times its length.
#include "engine/io/checks/xml_elements.h"

#include <filesystem>
#include <string>
#include <string_view>

#include <cpl_vsi.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/footprints/footprint_file.h"
#include "engine/io/formats/flight_file.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

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

class XmlElements : public testing::Test {
protected:
    /// Whether a file with this text is within a depth of 3.
    [[nodiscard]] bool is_flat(const std::string& text) const {
        return bool(check_xml(folder_.write("a.xml", text).string(), "a.xml", 3));
    }

    test::TemporaryFolder folder_;
};

TEST_F(XmlElements, CountsOpenElements) {
    EXPECT_TRUE(is_flat("<?xml version=\"1.0\"?>\n<a><b><c/><c>x</c><c i='/' /></b></a>"));
    EXPECT_TRUE(is_flat("<a><b>" + repeated("<c></c><c/>", 100) + "</b></a>"));
    EXPECT_FALSE(is_flat("<a><b><c><d></d></c></b></a>"));
    EXPECT_FALSE(is_flat(repeated("<a>", 4)));
}

TEST_F(XmlElements, WhatHidesElementsCountsToo) {
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

TEST_F(XmlElements, WhatIsNoElementDoesNotCount) {
    EXPECT_TRUE(is_flat("<a><!-- <a><a><a> --><![CDATA[<a><a>]]]><b>1 > 0</b></a>"));
    EXPECT_TRUE(is_flat("<!DOCTYPE a><a><?p <a><a><a> ?></a>"));
    EXPECT_TRUE(is_flat(utf16(u"<a>\u043C\u043E\u043B\u043E\u043A\u043E\u043C</a>")));
    EXPECT_TRUE(is_flat("{\"a\": \"" + repeated("<a>", 9) + "\"}")) << "no XML";
    EXPECT_TRUE(is_flat(""));
}

// Readers would begin it anew with each piece: hours for a file of 500 MB.
TEST_F(XmlElements, ATagWithoutAnEndIsRefused) {
    const std::string long_text(3U << 20U, 'x');
    EXPECT_FALSE(is_flat("<a b='" + long_text + "'></a>"));
    EXPECT_FALSE(is_flat("<a" + long_text));
    EXPECT_TRUE(is_flat("<a>" + long_text + "</a>"));
    EXPECT_TRUE(is_flat("<a><![CDATA[" + long_text + "]]></a>"));
}

TEST_F(XmlElements, DeepTracksAndOutlinesAreRefused) {
    const auto track = read_track(folder_.write("a.gpx", "<gpx>" + repeated("<trk>", 100)), 10.0);
    ASSERT_FALSE(track);
    EXPECT_THAT(track.error().message, HasSubstr("nested more than 64 deep"));
    EXPECT_THAT(read_track("/dev/zero", 10.0).error().message, HasSubstr("no regular file"));
    const auto outlines =
        read_footprints(folder_.write("a.kml", "<kml>" + repeated("<Folder>", 100)), {}, {});
    ASSERT_FALSE(outlines);
    EXPECT_THAT(outlines.error().message, HasSubstr("nested more than 64 deep"));
}

std::string track_of(int times, int places) {
    return "<kml xmlns:gx='http://www.google.com/kml/ext/2.2'><Document><Placemark><gx:Track>" +
           repeated("<when>2020-01-01T00:00:00Z</when>", times) +
           repeated("<gx:coord>6.1 45.1 900</gx:coord><gx:coord>6.2 45.2 900</gx:coord>",
                    places / 2) +
           "</gx:Track></Placemark></Document></kml>";
}

class KmlTracks : public XmlElements {
protected:
    /// A KMZ with this file.
    [[nodiscard]] std::filesystem::path kmz(const std::string& name,
                                            const std::string& text) const {
        std::filesystem::path path = folder_.path() / "a.kmz";
        std::filesystem::remove(path);
        const std::string member = "/vsizip/" + path.string() + "/" + name;
        VSILFILE* const file = VSIFOpenL(member.c_str(), "wb");
        EXPECT_EQ(VSIFWriteL(text.data(), 1, text.size(), file), text.size());
        VSIFCloseL(file);
        return path;
    }
    [[nodiscard]] static std::string error_of(const std::filesystem::path& path) {
        const auto track = read_track(path, 10.0);
        return track ? "" : track.error().message;
    }
};

// Found by fuzzing: GDAL crashed.
TEST_F(KmlTracks, ATrackOfMorePlacesThanTimesIsRefused) {
    EXPECT_EQ(error_of(folder_.write("a.kml", track_of(2, 2))), "");
    EXPECT_EQ(error_of(folder_.write("a.kml", track_of(4, 2))), "");
    EXPECT_THAT(error_of(folder_.write("a.kml", track_of(1, 2))),
                HasSubstr("a track with more places (2) than times (1) found"));
    EXPECT_THAT(error_of(folder_.write("a.kml", track_of(0, 4))),
                HasSubstr("more places (4) than times (0)"));
    const auto outlines = read_footprints(folder_.write("a.kml", track_of(1, 2)), {}, {});
    ASSERT_FALSE(outlines);
    EXPECT_THAT(outlines.error().message, HasSubstr("places (2) than times (1)"));
}

TEST_F(KmlTracks, OnlyTimesAndPlacesOfTheTrackItselfCount) {
    const auto is_good = [](const std::string& text) {
        const test::TemporaryFolder folder;
        return bool(check_xml(folder.write("a.xml", text).string(), "a.xml"));
    };
    EXPECT_TRUE(is_good("<k><coord/><when/><Track><when/><coord/></Track><coord/></k>"));
    EXPECT_FALSE(is_good("<Track><Data><when/></Data><coord/></Track>"));
    EXPECT_FALSE(is_good("<Track><Track><when/><when/></Track><coord/></Track>"));
    EXPECT_FALSE(is_good("<x:Track><y:coord/><z:coord/><when/></x:Track>"));
    EXPECT_FALSE(is_good("<Track><x:when/><coord/></Track>")) << "no time to GDAL";
}

TEST_F(KmlTracks, TheKmlInAKmzIsCheckedToo) {
    EXPECT_EQ(error_of(kmz("doc.kml", track_of(2, 2))), "");
    EXPECT_EQ(error_of(kmz("folder/Other.KML", track_of(2, 2))), "");
    EXPECT_THAT(error_of(kmz("doc.kml", track_of(1, 2))), HasSubstr("places (2) than times (1)"));
    EXPECT_THAT(error_of(kmz("doc.kml", "<kml>" + repeated("<Folder>", 100))),
                HasSubstr("nested more than 64 deep"));
    EXPECT_THAT(error_of(kmz("a.txt", "none")), HasSubstr("holds no KML"));
    EXPECT_THAT(error_of(folder_.write("b.kmz", "no archive")), HasSubstr("is no ZIP archive"));
}

// An archive states how much a member holds, and need not tell the truth.
TEST_F(KmlTracks, AKmzThatHoldsMoreThanItStatesIsRefused) {
    const std::filesystem::path path = kmz("doc.kml", std::string(std::size_t{65} << 20U, ' '));
    EXPECT_THAT(error_of(path), HasSubstr("holds a KML of over 67108864 bytes"));
    std::string bytes = test::read_bytes(path);
    const std::string size{'\0', '\0', '\x10', '\x04'}; // 65 MB, little-endian
    for (auto at = bytes.find(size); at != std::string::npos; at = bytes.find(size)) {
        bytes.replace(at, size.size(), std::string{'\x10', '\0', '\0', '\0'});
    }
    EXPECT_THAT(error_of(folder_.write("lie.kmz", bytes)), HasSubstr("holds a KML of over"));
}

TEST_F(KmlTracks, MessagesNameTheKmzAlsoOneWithBraces) {
    const std::filesystem::path path = folder_.path() / "a{b.kmz";
    std::filesystem::rename(kmz("doc.kml", track_of(2, 2)), path);
    EXPECT_EQ(error_of(path), "");
    EXPECT_THAT(error_of(kmz("doc.kml", track_of(1, 2))),
                StartsWith((folder_.path() / "a.kmz: ").string()));
}

} // namespace
} // namespace reljef::io
