#pragma once

#include <string>

#include <glm/vec2.hpp>

namespace reljef::gl {

struct Limits {
    std::string renderer;
    std::string version;
    int max_texture_size = 0;           ///< texels along a side
    int max_texture_units = 0;          ///< all stages together
    int max_fragment_texture_units = 0; ///< fragment stage
    glm::ivec2 max_viewport{0, 0};      ///< pixels
};

/// Precondition: a current context with loaded functions.
Limits query_limits();

/// Whether the driver ran out of memory since the last call. Clears all error flags.
bool ran_out_of_memory();

/// Whether the driver gave up the context, because a shader ran for too long or the GPU failed. Its
/// last picture is undefined then. Drivers tell it once, of contexts made by EGL on hardware.
bool is_context_lost();

} // namespace reljef::gl
