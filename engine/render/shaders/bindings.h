#pragma once

/// Binding points of uniform blocks and texture units, shared with GLSL.
namespace reljef::render::bindings {

using uint = unsigned int;
#include "shaders/frame/bindings.inc"

} // namespace reljef::render::bindings
