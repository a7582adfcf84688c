#pragma once

#include <cstdint>

#include "engine/render/shaders/uniform_blocks.h"
#include "engine/scene/technique/technique.h"

namespace reljef::render {

/// The shader features that a technique asks for (shader_library.h): how it searches or lights, and
/// its options.
std::uint32_t technique_features(const scene::Technique& technique);

/// The height in [0,1] that stays where it is when heights fade: of parallax its reference plane,
/// else the middle.
double reference_height(const scene::Technique& technique);

/// A relief's parameters and options. `reference` is the height in [0,1] that stays where it is
/// when heights fade.
TechniqueBlock technique_block(const scene::Technique& technique, double reference);

/// Whether the rays of a terrain's relief begin where their beam may meet something (beams.h):
/// those whose result does not hang on where they begin, and interval, whose steps are then
/// shorter.
bool has_beams(const scene::Technique& technique);

} // namespace reljef::render
