#pragma once

#include <cstdint>

#include "engine/gl/program.h"
#include "engine/scene/technique.h"

namespace reljef::render {

/// The shader features that a technique's options ask for (shader_library.h).
std::uint32_t option_features(const scene::TechniqueOptions& options);

/// Sets the uniforms that say a relief's parameters and options.
void set_relief_options(gl::Program& program, const scene::Technique& technique);

} // namespace reljef::render
