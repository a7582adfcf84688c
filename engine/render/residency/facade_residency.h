#pragma once

#include <map>
#include <memory>
#include <optional>

#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/view/draw_list.h"
#include "engine/view/facade_view.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// A view::FacadeMap in GPU memory.
struct ResidentFacades {
    gl::Texture2D samples;
    gl::Texture2D walls;
    glm::vec3 sun{0.0F};
    glm::vec3 sky{0.0F};
};

/// The façades of the terrains that show some, each in its last light.
class FacadeResidency {
public:
    Result<void> prepare(const view::DrawList& list, view::FrameStats& stats);

    /// Binds the maps. Preconditions: prepared; view::shows_facades().
    const ResidentFacades& bind(const scene::TerrainNode& terrain) const;

private:
    struct Entry {
        std::weak_ptr<const scene::TerrainSurface> owner;
        std::optional<scene::TerrainLight> light;
        ResidentFacades facades;
    };
    Result<void> prepare(const scene::TerrainNode& terrain, const glm::dmat4& world_from_local,
                         const std::optional<scene::TerrainLight>& light, view::FrameStats& stats);

    std::map<const scene::TerrainSurface*, Entry> entries_;
};

} // namespace reljef::render
