// XML whose elements are nested so deep that GDAL's readers take over a hundred times its length.
#include "engine/io/checks/xml_nesting.h"

#include <string>

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
    EXPECT_FALSE(is_flat(repeated("<a b='/>'>", 4))) << "a value that looks like an end";
    EXPECT_FALSE(is_flat("<a><!-- </a></a></a> --><a><a><a>")) << "an end in a comment";
    EXPECT_FALSE(is_flat("<a><![CDATA[</a></a>]]]><a><a><a>")) << "an end in a text";
    EXPECT_FALSE(is_flat("</a></a></a>" + repeated("<a>", 4))) << "ends without a beginning";
    std::string wide;
    for (const char c : repeated("<a>", 4)) {
        wide += {c, '\0'};
    }
    EXPECT_FALSE(is_flat("\xFF\xFE" + wide)) << "UTF-16";
}

TEST_F(XmlNesting, WhatIsNoElementDoesNotCount) {
    EXPECT_TRUE(is_flat("<a><!-- <a><a><a> ---><![CDATA[<a><a>]]]><b>1 > 0</b></a>"));
    EXPECT_TRUE(is_flat("<!DOCTYPE a><?p <?><a></a>"));
    EXPECT_TRUE(is_flat("{\"a\": \"" + repeated("<a>", 9) + "\"}")) << "no XML";
    EXPECT_TRUE(is_flat(""));
}

TEST_F(XmlNesting, DeepTracksAndOutlinesAreRefused) {
    const auto track = read_track(folder_.write("a.gpx", "<gpx>" + repeated("<trk>", 100)), 10.0);
    ASSERT_FALSE(track);
    EXPECT_THAT(track.error().message, HasSubstr("nested more than 64 deep"));
    const auto outlines =
        read_footprints(folder_.write("a.kml", "<kml>" + repeated("<Folder>", 100)), {}, {});
    ASSERT_FALSE(outlines);
    EXPECT_THAT(outlines.error().message, HasSubstr("nested more than 64 deep"));
}

} // namespace
} // namespace reljef::io
