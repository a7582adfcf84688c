#pragma once

#include "engine/render/shaders/shader_library.h"
#include "engine/render/shaders/uniform_blocks.h"
#include "engine/scene/technique/technique.h"

namespace reljef::render {

ShaderFeatures technique_features(const scene::Technique& technique);

/// The height in [0,1] that does not change when heights fade: the reference plane of parallax,
/// else the middle.
double reference_height(const scene::Technique& technique);

/// A technique's parameters and options. `reference`: see reference_height().
TechniqueBlock technique_block(const scene::Technique& technique, double reference);

/// Whether the rays of a terrain's relief begin where their beam may hit (beams.h): techniques
/// whose result does not depend on the start, and interval, whose steps get shorter.
bool has_beams(const scene::Technique& technique);

/// Whether the relief of a terrain needs its maximum mipmap: for exact searches and beams.
bool uses_max_mipmap(const scene::Technique& technique);

} // namespace reljef::render
