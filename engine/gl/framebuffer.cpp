#include "engine/gl/framebuffer.h"

#include <fmt/format.h>
#include <glad/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include "engine/gl/limits.h"

namespace reljef::gl {

namespace {

Result<void> check_options(const FramebufferOptions& options) {
    const Limits limits = query_limits();
    const glm::ivec2 most = limits.max_viewport;
    if (options.size.x < 1 || options.size.y < 1 || options.size.x > most.x ||
        options.size.y > most.y) {
        return Error{fmt::format("framebuffer of {} x {} pixels: expected 1 x 1 to {} x {}",
                                 options.size.x, options.size.y, most.x, most.y)};
    }
    if (options.colors.size() > static_cast<std::size_t>(limits.max_color_attachments)) {
        return Error{fmt::format("framebuffer with {} colours: expected at most {}",
                                 options.colors.size(), limits.max_color_attachments)};
    }
    return {};
}

Result<Texture2D> make_target(glm::ivec2 size, Format format) {
    return Texture2D::create({.size = size, .format = format, .filter = Filter::nearest});
}

std::string_view incompleteness(GLenum status) {
    switch (status) {
    case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
        return "an attachment cannot be drawn to";
    case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
        return "it has neither colour nor depth";
    case GL_FRAMEBUFFER_UNSUPPORTED:
        return "the driver does not support this combination of formats";
    default:
        return "the driver calls it incomplete";
    }
}

Result<void> check_complete(GLuint framebuffer, glm::ivec2 size) {
    const GLenum status = glCheckNamedFramebufferStatus(framebuffer, GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        return Error{fmt::format("framebuffer of {} x {} pixels: {} (status 0x{:04x})", size.x,
                                 size.y, incompleteness(status), status)};
    }
    return {};
}

void draw_to_all(GLuint framebuffer, std::size_t colors) {
    std::vector<GLenum> buffers;
    for (std::size_t index = 0; index < colors; ++index) {
        buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index));
    }
    glNamedFramebufferDrawBuffers(framebuffer, static_cast<GLsizei>(colors), buffers.data());
}

} // namespace

Result<Framebuffer> Framebuffer::create(const FramebufferOptions& options) {
    if (const auto possible = check_options(options); !possible) {
        return possible.error();
    }
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    Framebuffer framebuffer;
    framebuffer.id_ = UniqueId<delete_framebuffer>(name);
    framebuffer.size_ = options.size;
    for (const Format format : options.colors) {
        auto color = make_target(options.size, format);
        if (!color) {
            return color.error();
        }
        const auto index = static_cast<GLenum>(framebuffer.colors_.size());
        glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0 + index, color->id(), 0);
        framebuffer.colors_.push_back(std::move(*color));
    }
    draw_to_all(name, options.colors.size());
    if (options.depth) {
        auto depth = make_target(options.size, Format::depth32f);
        if (!depth) {
            return depth.error();
        }
        glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth->id(), 0);
        framebuffer.depth_ = std::move(*depth);
    }
    if (const auto complete = check_complete(name, options.size); !complete) {
        return complete.error();
    }
    return framebuffer;
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, id());
    glEnable(GL_FRAMEBUFFER_SRGB);
    glViewport(0, 0, size_.x, size_.y);
}

void Framebuffer::clear_color(glm::vec4 linear, std::size_t index) const {
    check(index < colors_.size(), "framebuffer has no such colour");
    glEnable(GL_FRAMEBUFFER_SRGB);
    glClearNamedFramebufferfv(id(), GL_COLOR, static_cast<GLint>(index), glm::value_ptr(linear));
}

void Framebuffer::clear_depth(float depth) const {
    check(has_depth(), "framebuffer has no depth");
    glClearNamedFramebufferfv(id(), GL_DEPTH, 0, &depth);
}

void Framebuffer::blit_to_window(glm::ivec2 window_size, std::size_t index) const {
    check(index < colors_.size(), "framebuffer has no such colour");
    // Mesa looks at a window's size where it is bound.
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    // With the conversion off both sides are plain bytes, whatever the window's encoding.
    glDisable(GL_FRAMEBUFFER_SRGB);
    glNamedFramebufferReadBuffer(id(), GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index));
    glBlitNamedFramebuffer(id(), 0, 0, 0, size_.x, size_.y, 0, 0, window_size.x, window_size.y,
                           GL_COLOR_BUFFER_BIT, window_size == size_ ? GL_NEAREST : GL_LINEAR);
}

const Texture2D& Framebuffer::color(std::size_t index) const {
    check(index < colors_.size(), "framebuffer has no such colour");
    return colors_[index];
}

const Texture2D& Framebuffer::depth() const {
    check(has_depth(), "framebuffer has no depth");
    return depth_;
}

void bind_window_framebuffer(glm::ivec2 window_size) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, window_size.x, window_size.y);
}

} // namespace reljef::gl
