#pragma once

#include <map>
#include <memory>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/view/draw_list.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// The shadow of ground as two heights at each sample of a terrain: the one below which ground
/// hides the sun, and that of the ground. A stream has those of its overview. The sun is as high as
/// in the middle of the terrain.
class GroundShadow {
public:
    /// Computes the heights of the terrains that cast shadows: of those with triangles, and, if
    /// there are meshes, of the first; again if the light changes. `max_side`: of textures, texels.
    /// Fails without memory.
    Result<void> prepare(const view::DrawList& list, int max_side, view::FrameStats& stats);

    /// Whether it lies on triangles of a terrain. Precondition: prepared.
    [[nodiscard]] bool is_on(const scene::TerrainNode& terrain) const {
        return grounds_.contains(&terrain);
    }
    [[nodiscard]] bool is_on_ground() const { return !grounds_.empty(); }

    /// Binds the heights for triangles of a tile, and returns texture coordinate = sample · xy +
    /// zw. Precondition: is_on().
    [[nodiscard]] glm::vec4 bind(const view::TileDraw& draw, glm::vec2 first_sample) const;

    /// Binds the heights for meshes, if ground casts shadows on them. Precondition: prepared.
    void bind() const;
    /// To texture coordinates (xy) and true heights (z), from world directions relative to the eye,
    /// metres; linear around the mesh. All zeros if no ground casts shadows.
    [[nodiscard]] glm::mat4 place_on(const view::DrawList& list, const view::MeshDraw& draw) const;

private:
    struct Ground {
        std::weak_ptr<const scene::TerrainSurface> owner;
        std::optional<scene::TerrainLight> light;
        gl::Texture2D heights;
        double step = 1.0; // samples between texels
    };
    Result<void> prepare(const view::DrawList& list, const view::TerrainDraw& draw, int max_side,
                         view::FrameStats& stats);

    std::map<const scene::TerrainNode*, Ground> grounds_;
    const scene::TerrainNode* below_meshes_ = nullptr;
    glm::dmat4 world_from_local_{1.0}; // of the terrain below meshes
};

} // namespace reljef::render
