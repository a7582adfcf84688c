#include "engine/gl/limits.h"

#include <array>

#include <glad/gl.h>

namespace reljef::gl {

namespace {

std::string text(GLenum name) {
    const GLubyte* found = glGetString(name);
    return found == nullptr ? std::string() : reinterpret_cast<const char*>(found);
}

int integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

std::size_t bytes(GLenum name) {
    GLint64 value = 0;
    glGetInteger64v(name, &value);
    return static_cast<std::size_t>(value);
}

glm::ivec2 pair(GLenum name) {
    std::array<GLint, 2> values{};
    glGetIntegerv(name, values.data());
    return {values[0], values[1]};
}

} // namespace

Limits query_limits() {
    return {.vendor = text(GL_VENDOR),
            .renderer = text(GL_RENDERER),
            .version = text(GL_VERSION),
            .glsl_version = text(GL_SHADING_LANGUAGE_VERSION),
            .max_texture_size = integer(GL_MAX_TEXTURE_SIZE),
            .max_texture_layers = integer(GL_MAX_ARRAY_TEXTURE_LAYERS),
            .max_texture_units = integer(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS),
            .max_fragment_texture_units = integer(GL_MAX_TEXTURE_IMAGE_UNITS),
            .max_color_attachments = integer(GL_MAX_COLOR_ATTACHMENTS),
            .max_samples = integer(GL_MAX_SAMPLES),
            .max_viewport = pair(GL_MAX_VIEWPORT_DIMS),
            .max_uniform_block_bytes = bytes(GL_MAX_UNIFORM_BLOCK_SIZE),
            .max_storage_block_bytes = bytes(GL_MAX_SHADER_STORAGE_BLOCK_SIZE),
            .uniform_block_alignment = bytes(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT),
            .max_tessellation_level = integer(GL_MAX_TESS_GEN_LEVEL)};
}

} // namespace reljef::gl
