#pragma once

#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/gl/limits.h"
#include "engine/scene/technique/technique.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

struct DrawnSurface {
    bool is_mesh = false;
    glm::ivec2 samples{0}; ///< of the heights
};

/// The context's limit that the technique exceeds, as "found, expected": the OpenGL version, the
/// texture units of its maps, or the texture size of the heights and their max mipmap. Empty if it
/// can draw the surface.
std::optional<std::string> missing_support(scene::TechniqueId id, const DrawnSurface& surface,
                                           const gl::Limits& limits);

/// The nearest technique in the catalogue, predecessors first, that can draw the surface.
std::optional<scene::TechniqueId>
nearest_technique(scene::TechniqueId id, const DrawnSurface& surface, const gl::Limits& limits);

/// Fails when the context cannot draw the list, with the exceeded limit and the nearest technique
/// that works.
Result<void> check_support(const view::DrawList& list, const gl::Limits& limits);

} // namespace reljef::render
