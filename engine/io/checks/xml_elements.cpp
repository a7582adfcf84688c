#include "engine/io/checks/xml_elements.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include <cpl_vsi.h>
#include <expat.h>
#include <fmt/format.h>

namespace reljef::io {
namespace {

constexpr XML_Index max_tag_bytes = XML_Index{1} << 20U;

struct FreeParser {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};
using Parser = std::unique_ptr<std::remove_pointer_t<XML_Parser>, FreeParser>;

/// Without its prefix.
std::string_view local_name(std::string_view name) {
    return name.substr(name.rfind(':') + 1); // npos + 1 is 0
}

/// A gx:Track of KML.
struct KmlTrack {
    std::size_t depth = 0;
    int times = 0;
    int places = 0;
};

/// What is known of a file's elements.
struct Elements {
    XML_Parser parser = nullptr;
    std::size_t depth = 0;
    std::size_t max_depth = 0;
    std::vector<KmlTrack> open_tracks = {};
    std::optional<KmlTrack> bad_track = {};

    void begin(std::string_view name) {
        if (++depth > max_depth) {
            XML_StopParser(parser, XML_FALSE);
            return;
        }
        if (!open_tracks.empty() && open_tracks.back().depth + 1 == depth) {
            // GDAL knows times under no other name.
            open_tracks.back().times += name == "when" ? 1 : 0;
            open_tracks.back().places += local_name(name) == "coord" ? 1 : 0;
        }
        if (local_name(name) == "Track") {
            open_tracks.push_back({depth});
        }
    }
    void end() {
        if (!open_tracks.empty() && open_tracks.back().depth == depth) {
            if (open_tracks.back().places > open_tracks.back().times) {
                bad_track = open_tracks.back();
                XML_StopParser(parser, XML_FALSE);
            }
            open_tracks.pop_back();
        }
        --depth;
    }
};

// As GDAL's readers, it takes encodings that expat does not know for ones of single bytes.
int read_as_bytes(void* /*data*/, const XML_Char* /*name*/, XML_Encoding* encoding) {
    constexpr int any_letter = 0xE9;
    for (int byte = 0; byte < 256; ++byte) {
        encoding->map[byte] = byte < 128 ? byte : any_letter;
    }
    encoding->data = nullptr;
    encoding->convert = nullptr;
    encoding->release = nullptr;
    return XML_STATUS_OK;
}

// Counts elements in entities, too. Null without memory.
Parser make_parser(Elements& elements) {
    Parser parser(XML_ParserCreate(nullptr));
    if (parser == nullptr) {
        return parser;
    }
    elements.parser = parser.get();
    XML_SetUserData(parser.get(), &elements);
    XML_SetUnknownEncodingHandler(parser.get(), read_as_bytes, nullptr);
    XML_SetElementHandler(
        parser.get(),
        [](void* data, const XML_Char* name, const XML_Char** /*attributes*/) {
            static_cast<Elements*>(data)->begin(name);
        },
        [](void* data, const XML_Char* /*name*/) { static_cast<Elements*>(data)->end(); });
    return parser;
}

Result<void> result_of(const Elements& elements, const std::filesystem::path& path) {
    if (elements.depth > elements.max_depth) {
        return Error{fmt::format("{}: elements nested more than {} deep found, at most that many "
                                 "were expected",
                                 path.string(), elements.max_depth)};
    }
    if (elements.bad_track) {
        return Error{fmt::format("{}: a track with more places ({}) than times ({}) found, a time "
                                 "for each place was expected",
                                 path.string(), elements.bad_track->places,
                                 elements.bad_track->times)};
    }
    return {};
}

} // namespace

Result<void> check_xml(const std::string& name, const std::filesystem::path& path, int max_depth) {
    Elements elements{.max_depth = static_cast<std::size_t>(max_depth)};
    const Parser parser = make_parser(elements);
    if (parser == nullptr) {
        return Error{fmt::format("{}: cannot be read: there is not enough memory", path.string())};
    }
    const std::unique_ptr<VSILFILE, decltype(&VSIFCloseL)> file(VSIFOpenL(name.c_str(), "rb"),
                                                                &VSIFCloseL);
    std::array<char, 1 << 16> piece;
    XML_Index bytes = 0;
    XML_Status status = XML_STATUS_OK;
    while (file != nullptr && status == XML_STATUS_OK) {
        const std::size_t read = VSIFReadL(piece.data(), 1, piece.size(), file.get());
        if (read == 0) {
            break;
        }
        status = XML_Parse(parser.get(), piece.data(), static_cast<int>(read), XML_FALSE);
        bytes += static_cast<XML_Index>(read);
        // A tag that has not ended is read again with each piece.
        const XML_Index begin = std::max(XML_GetCurrentByteIndex(parser.get()), XML_Index{0});
        if (status == XML_STATUS_OK && bytes - begin > max_tag_bytes) {
            return Error{fmt::format("{}: a tag of over {} bytes found, a shorter one was expected",
                                     path.string(), max_tag_bytes)};
        }
    }
    return result_of(elements, path);
}

} // namespace reljef::io
