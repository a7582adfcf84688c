#pragma once

#include <utility>

#include <glm/vec2.hpp>

#include "engine/session/flight_keys.h"
#include "engine/session/scene_renderer.h"
#include "engine/session/scene_setup.h"
#include "tests/support/test_data.h"

namespace reljef::test {

/// Opens a terrain without reporting anything.
inline Result<session::TerrainSource> open_terrain(const session::SourceOptions& options) {
    session::Log silent;
    return session::open_terrain(options, silent, {});
}

inline Result<session::TerrainScene> make_scene(session::TerrainSource source,
                                                const session::SourceOptions& options = {},
                                                const session::SceneOptions& view = {}) {
    session::Log silent;
    return session::make_scene(std::move(source), options, view, silent);
}

inline Result<scene::CameraPath> open_path(const session::TerrainScene& scene,
                                           const std::string& name) {
    session::Log silent;
    return session::open_path(scene, name, silent);
}

/// Draws with the current context of a software renderer.
inline Result<session::SceneRenderer> make_renderer(glm::ivec2 size,
                                                    const view::SelectOptions& select = {}) {
    return session::SceneRenderer::create(
        {.opengl = render::DriverOptions{.size = size, .shader_dir = {}, .software = true},
         .select = select});
}

} // namespace reljef::test
