#pragma once

#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/gl/limits.h"
#include "engine/scene/technique/technique.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

/// What a technique is to draw: a terrain or a mesh with a tile, of so many samples of heights.
struct DrawnSurface {
    bool is_mesh = false;
    glm::ivec2 samples{0};
};

/// The limit of a context that a technique would exceed, as "found, expected"; nothing where it can
/// draw the surface: OpenGL below 4.5, in whose language the shaders are; fewer texture units than
/// its maps take; heights, or the pyramid over them, that are wider than a texture may be.
std::optional<std::string> lack_of(scene::TechniqueId id, const DrawnSurface& surface,
                                   const gl::Limits& limits);

/// The technique next to one in the catalogue, the one before it first, that draws the same kind of
/// surface and lacks nothing; nothing where none is left.
std::optional<scene::TechniqueId>
nearest_technique(scene::TechniqueId id, const DrawnSurface& surface, const gl::Limits& limits);

/// Whether the context can draw all of a list; fails with what is lacking and the nearest technique
/// that works.
Result<void> check_support(const view::DrawList& list, const gl::Limits& limits);

} // namespace reljef::render
