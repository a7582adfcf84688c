#pragma once

#include <glm/vec2.hpp>

#include "engine/core/result.h"
#include "engine/gl/texture.h"
#include "engine/gl/unique_id.h"

namespace reljef::gl {

/// A 32-bit float depth that is drawn without colours and then compared with in shaders
/// (sampler2DShadow): 1 where the reference is at least the depth, 0 where it is less, linear
/// between the four texels around a place.
class DepthMap {
public:
    DepthMap() = default;

    /// A square; undefined content. Fails as Texture2D::create, and when the driver refuses it.
    static Result<DepthMap> create(int side);

    /// Makes a square of it the draw target; what is outside of it is clipped.
    void bind(glm::ivec2 low, int side) const;
    /// To 0, the far end of a reversed depth. Precondition: depth writing is on.
    void clear() const;

    /// GLSL `layout(binding = unit) uniform sampler2DShadow`.
    void bind_texture(unsigned int unit) const { depth_.bind(unit); }

    /// 0 if it was not created.
    [[nodiscard]] int side() const { return side_; }

private:
    UniqueId<delete_framebuffer> id_;
    Texture2D depth_;
    int side_ = 0;
};

} // namespace reljef::gl
