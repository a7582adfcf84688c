#include "engine/gl/depth_map.h"

#include <fmt/format.h>
#include <glad/gl.h>

namespace reljef::gl {

Result<DepthMap> DepthMap::create(int side) {
    auto depth = Texture2D::create(
        {.size = {side, side}, .format = Format::depth32f, .filter = Filter::bilinear});
    if (!depth) {
        return depth.error();
    }
    DepthMap map;
    map.depth_ = std::move(*depth);
    map.side_ = side;
    glTextureParameteri(map.depth_.id(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTextureParameteri(map.depth_.id(), GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    map.id_ = UniqueId<delete_framebuffer>(name);
    glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, map.depth_.id(), 0);
    glNamedFramebufferDrawBuffer(name, GL_NONE);
    const GLenum status = glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        return Error{fmt::format("depth map of {0} x {0} texels: the driver calls it incomplete "
                                 "(status 0x{1:04x})",
                                 side, status)};
    }
    return map;
}

void DepthMap::bind(glm::ivec2 low, int side) const {
    glBindFramebuffer(GL_FRAMEBUFFER, id_.get());
    glViewport(low.x, low.y, side, side);
}

void DepthMap::clear() const {
    constexpr float far = 0.0F;
    glClearNamedFramebufferfv(id_.get(), GL_DEPTH, 0, &far);
}

} // namespace reljef::gl
