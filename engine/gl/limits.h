#pragma once

#include <cstddef>
#include <string>

#include <glm/vec2.hpp>

namespace reljef::gl {

/// What the current context can do and who made it.
struct Limits {
    std::string vendor;       ///< GL_VENDOR
    std::string renderer;     ///< GL_RENDERER
    std::string version;      ///< GL_VERSION
    std::string glsl_version; ///< GL_SHADING_LANGUAGE_VERSION
    int max_texture_size = 0; ///< of each side
    int max_texture_layers = 0;
    int max_texture_units = 0;          ///< of all stages together
    int max_fragment_texture_units = 0; ///< of the fragment stage
    int max_color_attachments = 0;
    int max_samples = 0; ///< of a pixel; not every smaller number need be there (sample_counts)
    glm::ivec2 max_viewport{0, 0};
    std::size_t max_uniform_block_bytes = 0;
    std::size_t max_storage_block_bytes = 0;
    std::size_t uniform_block_alignment = 0; ///< of a bound range's offset, bytes
    int max_tessellation_level = 0;
};

/// Of the context that is current, its functions loaded.
Limits query_limits();

} // namespace reljef::gl
