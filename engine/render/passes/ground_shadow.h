#pragma once

#include <memory>
#include <optional>

#include <glm/mat4x4.hpp>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/render/shaders/uniform_blocks.h"
#include "engine/view/draw_list.h"
#include "engine/view/frame_stats.h"

namespace reljef::render {

/// The shadow that ground casts on meshes: the heights below which it hides the sun, one at each
/// sample of a terrain on a plane. A stream has those of its overview.
class GroundShadow {
public:
    /// Takes the first terrain on a plane that casts shadows, and computes its heights if it or its
    /// light is another one than before. `max_side`: of textures, texels. Precondition: the list
    /// has a sun.
    Result<void> prepare(const view::DrawList& list, int max_side, view::FrameStats& stats);

    /// Binds the heights, and sets what programs need to find places on them. Without a terrain,
    /// nothing is in shadow.
    void bind(MeshShadowBlock& block) const;

private:
    std::weak_ptr<const scene::TerrainSurface> owner_;
    std::optional<scene::TerrainLight> light_;
    gl::Texture2D heights_;
    std::optional<glm::mat4> place_from_relative_; // empty: no ground casts shadows
};

} // namespace reljef::render
