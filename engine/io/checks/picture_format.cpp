#include "engine/io/checks/picture_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <memory>
#include <string_view>

#include <cpl_vsi.h>
#include <fmt/format.h>

#include "engine/io/checks/lowercase.h"

namespace reljef::io {
namespace {

using namespace std::string_view_literals;

struct PictureSignature {
    std::string_view bytes;
    const char* format;
};

constexpr std::array picture_signatures{
    PictureSignature{"\x89PNG\r\n\x1A\n"sv, "png"},
    PictureSignature{"\xFF\xD8\xFF"sv, "jpeg"},
    PictureSignature{"II*\0"sv, "tiff"},
    PictureSignature{"MM\0*"sv, "tiff"},
    PictureSignature{"II+\0"sv, "tiff"},
    PictureSignature{"MM\0+"sv, "tiff"},
    PictureSignature{"v/1\x01"sv, "openexr"},
    PictureSignature{"BM"sv, "bmp"},
    PictureSignature{"#?"sv, "hdr"},
    PictureSignature{"DDS "sv, "dds"},
    PictureSignature{"GIF8"sv, "gif"},
    PictureSignature{"\0\0\0\x0CjP  "sv, "jpeg2000"},
    PictureSignature{"\xFFO\xFFQ"sv, "jpeg2000"},
};

bool is_webp(std::string_view head) {
    return head.starts_with("RIFF") &&
           head.substr(std::min<std::size_t>(8, head.size())).starts_with("WEBP");
}

bool is_pnm(std::string_view head) {
    return head.size() > 2 && head[0] == 'P' &&
           "123456fF"sv.find(head[1]) != std::string_view::npos &&
           std::isspace(static_cast<unsigned char>(head[2])) != 0;
}

bool is_tga(const std::string& name) {
    return lowercase(std::filesystem::path(name).extension().string()) == ".tga";
}

} // namespace

Result<std::string> picture_format(const std::string& name) {
    std::string head(12, '\0');
    const std::unique_ptr<VSILFILE, decltype(&VSIFCloseL)> file(VSIFOpenL(name.c_str(), "rb"),
                                                                &VSIFCloseL);
    head.resize(file != nullptr ? VSIFReadL(head.data(), 1, head.size(), file.get()) : 0);
    const auto found = std::find_if(
        picture_signatures.begin(), picture_signatures.end(),
        [&](const PictureSignature& signature) { return head.starts_with(signature.bytes); });
    if (found != picture_signatures.end()) {
        return std::string(found->format);
    }
    if (is_webp(head) || is_pnm(head) || is_tga(name)) {
        return std::string(is_webp(head) ? "webp" : is_pnm(head) ? "pnm" : "targa");
    }
    return Error{
        fmt::format("{}: cannot be read (its format is unknown), a picture (PNG, JPEG, TIFF, "
                    "OpenEXR, BMP, TGA, HDR, WebP, PNM, GIF, DDS or JPEG 2000) was expected",
                    name)};
}

} // namespace reljef::io
