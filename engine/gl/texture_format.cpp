#include "engine/gl/texture_format.h"

#include <glad/gl.h>

namespace reljef::gl {

FormatTraits traits(Format format) {
    switch (format) {
    case Format::rgba8_srgb:
        return {"rgba8_srgb", GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case Format::rgba8:
        return {"rgba8", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case Format::r8:
        return {"r8", GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1};
    case Format::r32f:
        return {"r32f", GL_R32F, GL_RED, GL_FLOAT, 4};
    case Format::rg16f:
        return {"rg16f", GL_RG16F, GL_RG, GL_HALF_FLOAT, 4};
    case Format::rg32f:
        return {"rg32f", GL_RG32F, GL_RG, GL_FLOAT, 8};
    case Format::rg16_snorm:
        return {"rg16_snorm", GL_RG16_SNORM, GL_RG, GL_SHORT, 4};
    case Format::rgba16_snorm:
        return {"rgba16_snorm", GL_RGBA16_SNORM, GL_RGBA, GL_SHORT, 8};
    case Format::rgba32f:
        return {"rgba32f", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
    case Format::depth32f:
        return {"depth32f", GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4};
    }
    abort_with("unknown texture format");
}

} // namespace reljef::gl
