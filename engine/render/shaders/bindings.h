#pragma once

/// The binding points of uniform blocks and the units of maps, as the shaders have them.
namespace reljef::render::bindings {

using uint = unsigned int;
#include "shaders/frame/bindings.inc"

} // namespace reljef::render::bindings
