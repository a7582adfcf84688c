#include "engine/gl/framebuffer.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glad/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include "engine/gl/limits.h"
#include "engine/gl/memory.h"
#include "engine/gl/texture_format.h"

namespace reljef::gl {

namespace {

std::vector<int> counts_of(Format format) {
    GLint count = 0;
    glGetInternalformativ(GL_RENDERBUFFER, traits(format).internal, GL_NUM_SAMPLE_COUNTS, 1,
                          &count);
    std::vector<int> counts(static_cast<std::size_t>(std::max(count, 0)));
    if (!counts.empty()) {
        glGetInternalformativ(GL_RENDERBUFFER, traits(format).internal, GL_SAMPLES, count,
                              counts.data());
    }
    return counts;
}

Result<void> check_samples(const FramebufferOptions& options) {
    if (options.samples == 1) {
        return {};
    }
    const std::vector<int> counts = sample_counts(options);
    if (std::find(counts.begin(), counts.end(), options.samples) == counts.end()) {
        return Error{fmt::format("framebuffer with {} samples a pixel: expected one of {}",
                                 options.samples, fmt::join(counts, ", "))};
    }
    return {};
}

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
    return check_samples(options);
}

// The name of a renderbuffer; fails where the driver has no memory for it.
Result<GLuint> make_renderbuffer(const FramebufferOptions& options, Format format) {
    GLuint name = 0;
    glCreateRenderbuffers(1, &name);
    glNamedRenderbufferStorageMultisample(name, options.samples, traits(format).internal,
                                          options.size.x, options.size.y);
    if (ran_out_of_memory()) {
        delete_renderbuffer(name);
        return Error{fmt::format("framebuffer of {} x {} pixels with {} samples each: the driver "
                                 "has no memory for it",
                                 options.size.x, options.size.y, options.samples)};
    }
    return name;
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

std::vector<int> sample_counts(const FramebufferOptions& options) {
    std::vector<Format> formats = options.colors;
    if (options.depth) {
        formats.push_back(Format::depth32f);
    }
    std::vector<int> common;
    for (std::size_t index = 0; index < formats.size(); ++index) {
        const std::vector<int> counts = counts_of(formats[index]);
        const auto is_missing = [&](int count) {
            return std::find(counts.begin(), counts.end(), count) == counts.end();
        };
        if (index == 0) {
            common = counts;
        } else {
            std::erase_if(common, is_missing);
        }
    }
    common.push_back(1);
    std::sort(common.begin(), common.end());
    common.erase(std::unique(common.begin(), common.end()), common.end());
    return common;
}

Result<Framebuffer> Framebuffer::create(const FramebufferOptions& options) {
    if (const auto possible = check_options(options); !possible) {
        return possible.error();
    }
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    Framebuffer framebuffer;
    framebuffer.id_ = UniqueId<delete_framebuffer>(name);
    framebuffer.size_ = options.size;
    framebuffer.samples_ = options.samples;
    const auto attached = options.samples == 1 ? framebuffer.attach_textures(options)
                                               : framebuffer.attach_samples(options);
    if (!attached) {
        return attached.error();
    }
    draw_to_all(name, options.colors.size());
    if (const auto complete = check_complete(name, options.size); !complete) {
        return complete.error();
    }
    return framebuffer;
}

Result<void> Framebuffer::attach_textures(const FramebufferOptions& options) {
    for (const Format format : options.colors) {
        auto color = make_target(options.size, format);
        if (!color) {
            return color.error();
        }
        const auto index = static_cast<GLenum>(colors_.size());
        glNamedFramebufferTexture(id(), GL_COLOR_ATTACHMENT0 + index, color->id(), 0);
        colors_.push_back(std::move(*color));
    }
    if (options.depth) {
        auto depth = make_target(options.size, Format::depth32f);
        if (!depth) {
            return depth.error();
        }
        glNamedFramebufferTexture(id(), GL_DEPTH_ATTACHMENT, depth->id(), 0);
        depth_ = std::move(*depth);
    }
    return {};
}

Result<void> Framebuffer::attach_samples(const FramebufferOptions& options) {
    for (const Format format : options.colors) {
        const auto color = make_renderbuffer(options, format);
        if (!color) {
            return color.error();
        }
        const auto index = static_cast<GLenum>(sample_colors_.size());
        sample_colors_.emplace_back(*color);
        glNamedFramebufferRenderbuffer(id(), GL_COLOR_ATTACHMENT0 + index, GL_RENDERBUFFER, *color);
    }
    if (options.depth) {
        const auto depth = make_renderbuffer(options, Format::depth32f);
        if (!depth) {
            return depth.error();
        }
        sample_depth_ = Renderbuffer(*depth);
        glNamedFramebufferRenderbuffer(id(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, *depth);
    }
    return {};
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, id());
    glEnable(GL_FRAMEBUFFER_SRGB);
    glViewport(0, 0, size_.x, size_.y);
}

void Framebuffer::clear_color(glm::vec4 linear, std::size_t index) const {
    check(index < color_count(), "framebuffer has no such colour");
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

void Framebuffer::resolve_to(const Framebuffer& target, std::size_t index) const {
    check(index < color_count() && index < target.color_count(), "framebuffer has no such colour");
    check(size_ == target.size_ && target.samples_ == 1, "resolved to another kind of framebuffer");
    const auto attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index);
    // With the conversion on, samples are decoded before the mean is taken.
    glEnable(GL_FRAMEBUFFER_SRGB);
    glNamedFramebufferReadBuffer(id(), attachment);
    glNamedFramebufferDrawBuffer(target.id(), attachment);
    glBlitNamedFramebuffer(id(), target.id(), 0, 0, size_.x, size_.y, 0, 0, size_.x, size_.y,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
    draw_to_all(target.id(), target.color_count());
}

const Texture2D& Framebuffer::color(std::size_t index) const {
    check(index < colors_.size(), "framebuffer has no such colour");
    return colors_[index];
}

const Texture2D& Framebuffer::depth() const {
    check(depth_.id() != 0U, "framebuffer has no depth texture");
    return depth_;
}

void bind_window_framebuffer(glm::ivec2 window_size) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, window_size.x, window_size.y);
}

} // namespace reljef::gl
