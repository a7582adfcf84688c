#pragma once

#include <cstdint>

#include "engine/gl/program.h"
#include "engine/scene/technique.h"

namespace reljef::render {

/// The shader features that a relief technique asks for: how it searches, and its options
/// (shader_library.h).
std::uint32_t relief_features(const scene::Technique& technique);

/// Sets the uniforms that say a relief's parameters and options.
void set_relief_options(gl::Program& program, const scene::Technique& technique);

} // namespace reljef::render
