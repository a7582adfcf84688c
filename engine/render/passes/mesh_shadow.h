#pragma once

#include <vector>

#include "engine/core/result.h"
#include "engine/gl/depth_map.h"
#include "engine/render/passes/draw_state.h"
#include "engine/render/residency/residency.h"
#include "engine/render/shaders/sun_maps.h"
#include "engine/view/draw_list.h"

namespace reljef::render {

/// The shadows of the meshes of a frame, as depth maps from the sun.
class MeshShadow {
public:
    /// Chooses the maps, see sun_maps(). `max_side`: of textures, texels. Fails without memory.
    Result<void> prepare(const view::DrawList& list, int max_side);

    /// Whether meshes may cast shadows into the picture. Without any, nothing is drawn and no
    /// program of meshes reads the maps.
    [[nodiscard]] bool is_cast() const { return !maps_.empty(); }

    /// The meshes beside the picture that are drawn into the maps. Precondition: prepared.
    [[nodiscard]] std::vector<view::MeshDraw> casters_beside(const view::DrawList& list) const;

    /// Draws the casters into the maps. Precondition: prepared, and `residency` for the same list
    /// with casters_beside().
    Result<void> draw(const view::DrawList& list, const Residency& residency,
                      DrawState& state) const;

    /// Sets what programs with feature_mesh_shadows read: also that there are no maps.
    Result<void> bind(DrawState& state) const;

private:
    std::vector<SunMap> maps_;
    gl::DepthMap depth_; // made for the first shadow
};

} // namespace reljef::render
