#pragma once

#include <cstddef>
#include <string_view>

#include "engine/gl/texture.h"

namespace reljef::gl {

/// GL's words for a format.
struct FormatTraits {
    std::string_view name;
    unsigned int internal = 0; ///< sized internal format
    unsigned int layout = 0;   ///< of client texels: GL_RGBA, …
    unsigned int type = 0;     ///< of client components: GL_UNSIGNED_BYTE, …
    std::size_t bytes = 0;     ///< of a client texel
};

FormatTraits traits(Format format);

} // namespace reljef::gl
