#include "engine/io/checks/xml_nesting.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <type_traits>

#include <expat.h>
#include <fmt/format.h>

namespace reljef::io {
namespace {

constexpr XML_Index max_tag_bytes = XML_Index{1} << 20U;

struct FreeParser {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
};
using Parser = std::unique_ptr<std::remove_pointer_t<XML_Parser>, FreeParser>;

struct OpenElements {
    XML_Parser parser = nullptr;
    int count = 0;
    int max_count = 0;
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
Parser make_parser(OpenElements& open) {
    Parser parser(XML_ParserCreate(nullptr));
    if (parser == nullptr) {
        return parser;
    }
    open.parser = parser.get();
    XML_SetUserData(parser.get(), &open);
    XML_SetUnknownEncodingHandler(parser.get(), read_as_bytes, nullptr);
    XML_SetElementHandler(
        parser.get(),
        [](void* data, const XML_Char* /*name*/, const XML_Char** /*attributes*/) {
            auto& elements = *static_cast<OpenElements*>(data);
            if (++elements.count > elements.max_count) {
                XML_StopParser(elements.parser, XML_FALSE);
            }
        },
        [](void* data, const XML_Char* /*name*/) { --static_cast<OpenElements*>(data)->count; });
    return parser;
}

} // namespace

Result<void> check_xml_nesting(const std::filesystem::path& path, int max_depth) {
    OpenElements open{.max_count = max_depth};
    const Parser parser = make_parser(open);
    if (parser == nullptr) {
        return Error{fmt::format("{}: cannot be read: there is not enough memory", path.string())};
    }
    std::ifstream file(path, std::ios::binary);
    std::array<char, 1 << 16> piece;
    XML_Index bytes = 0;
    XML_Status status = XML_STATUS_OK;
    while (status == XML_STATUS_OK &&
           (file.read(piece.data(), piece.size()) || file.gcount() > 0)) {
        status = XML_Parse(parser.get(), piece.data(), static_cast<int>(file.gcount()), XML_FALSE);
        bytes += file.gcount();
        // A tag that has not ended is read again with each piece.
        const XML_Index begin = std::max(XML_GetCurrentByteIndex(parser.get()), XML_Index{0});
        if (status == XML_STATUS_OK && bytes - begin > max_tag_bytes) {
            return Error{fmt::format("{}: a tag of over {} bytes found, a shorter one was expected",
                                     path.string(), max_tag_bytes)};
        }
    }
    if (open.count <= max_depth) {
        return {};
    }
    return Error{fmt::format("{}: elements nested more than {} deep found, at most that many were "
                             "expected",
                             path.string(), max_depth)};
}

} // namespace reljef::io
