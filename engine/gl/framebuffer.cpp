#include "engine/gl/framebuffer.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glad/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include "engine/gl/limits.h"

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
    std::sort(counts.begin(), counts.end());
    return counts;
}

Result<void> check_options(const FramebufferOptions& options) {
    const glm::ivec2 max = query_limits().max_viewport;
    if (options.size.x < 1 || options.size.y < 1 || options.size.x > max.x ||
        options.size.y > max.y) {
        return Error{fmt::format("framebuffer of {} x {} pixels: expected 1 x 1 to {} x {}",
                                 options.size.x, options.size.y, max.x, max.y)};
    }
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

Result<GLuint> make_renderbuffer(const FramebufferOptions& options, Format format) {
    GLuint name = 0;
    glCreateRenderbuffers(1, &name);
    glNamedRenderbufferStorageMultisample(name, options.samples == 1 ? 0 : options.samples,
                                          traits(format).internal, options.size.x, options.size.y);
    if (ran_out_of_memory()) {
        delete_renderbuffer(name);
        return Error{fmt::format("framebuffer of {} x {} pixels with {} samples each: the driver "
                                 "has no memory for it",
                                 options.size.x, options.size.y, options.samples)};
    }
    return name;
}

std::string_view incompleteness(GLenum status) {
    switch (status) {
    case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
        return "an attachment cannot be drawn to";
    case GL_FRAMEBUFFER_UNSUPPORTED:
        return "the driver does not support this combination of formats";
    default:
        return "the driver calls it incomplete";
    }
}

} // namespace

void bind_window() {
    // Mesa updates a window's size when the window is bound.
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    // Without conversion colours are plain bytes, whatever the window's encoding.
    glDisable(GL_FRAMEBUFFER_SRGB);
}

std::vector<int> sample_counts(const FramebufferOptions& options) {
    std::vector<int> common = counts_of(options.color);
    if (options.depth) {
        const std::vector<int> of_depth = counts_of(Format::depth32f);
        std::erase_if(common, [&](int count) {
            return !std::binary_search(of_depth.begin(), of_depth.end(), count);
        });
    }
    if (common.empty() || common.front() != 1) {
        common.insert(common.begin(), 1);
    }
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
    if (const auto attached = framebuffer.attach_color(options); !attached) {
        return attached.error();
    }
    if (const auto attached = framebuffer.attach_depth(options); !attached) {
        return attached.error();
    }
    const GLenum status = glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        return Error{fmt::format("framebuffer of {} x {} pixels: {} (status 0x{:04x})",
                                 options.size.x, options.size.y, incompleteness(status), status)};
    }
    return framebuffer;
}

Result<void> Framebuffer::attach_color(const FramebufferOptions& options) {
    if (options.samples == 1) {
        auto color = Texture2D::create(
            {.size = options.size, .format = options.color, .filter = Filter::nearest});
        if (!color) {
            return color.error();
        }
        color_ = std::move(*color);
        glNamedFramebufferTexture(id(), GL_COLOR_ATTACHMENT0, color_.id(), 0);
        return options.second_color ? attach_second_color(options) : Result<void>();
    }
    const auto color = make_renderbuffer(options, options.color);
    if (!color) {
        return color.error();
    }
    sample_color_ = UniqueId<delete_renderbuffer>(*color);
    glNamedFramebufferRenderbuffer(id(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, *color);
    return {};
}

Result<void> Framebuffer::attach_second_color(const FramebufferOptions& options) {
    auto color = Texture2D::create(
        {.size = options.size, .format = *options.second_color, .filter = Filter::nearest});
    if (!color) {
        return color.error();
    }
    second_color_ = std::move(*color);
    glNamedFramebufferTexture(id(), GL_COLOR_ATTACHMENT1, second_color_.id(), 0);
    constexpr std::array<GLenum, 2> outputs{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(id(), static_cast<GLsizei>(outputs.size()), outputs.data());
    return {};
}

Result<void> Framebuffer::attach_depth(const FramebufferOptions& options) {
    if (!options.depth) {
        return {};
    }
    const auto depth = make_renderbuffer(options, Format::depth32f);
    if (!depth) {
        return depth.error();
    }
    depth_ = UniqueId<delete_renderbuffer>(*depth);
    glNamedFramebufferRenderbuffer(id(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, *depth);
    return {};
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, id());
    glEnable(GL_FRAMEBUFFER_SRGB);
    glViewport(0, 0, size_.x, size_.y);
}

void Framebuffer::clear_color(glm::vec4 linear) const {
    glEnable(GL_FRAMEBUFFER_SRGB);
    glClearNamedFramebufferfv(id(), GL_COLOR, 0, glm::value_ptr(linear));
    if (second_color_.id() != 0U) {
        constexpr std::array<float, 4> zeros{};
        glClearNamedFramebufferfv(id(), GL_COLOR, 1, zeros.data());
    }
}

void Framebuffer::clear_depth(float depth) const {
    check(depth_.get() != 0U, "framebuffer has no depth");
    glClearNamedFramebufferfv(id(), GL_DEPTH, 0, &depth);
}

void Framebuffer::blit_to_window(glm::ivec2 window_size, FirstRow first) const {
    bind_window();
    const int bottom = first == FirstRow::bottom ? 0 : size_.y;
    glBlitNamedFramebuffer(id(), 0, 0, bottom, size_.x, size_.y - bottom, 0, 0, window_size.x,
                           window_size.y, GL_COLOR_BUFFER_BIT,
                           window_size == size_ ? GL_NEAREST : GL_LINEAR);
}

void Framebuffer::blit_area_to_window(glm::ivec2 low, glm::ivec2 size) const {
    bind_window();
    const glm::ivec2 high = low + size;
    glBlitNamedFramebuffer(id(), 0, low.x, low.y, high.x, high.y, low.x, size_.y - low.y, high.x,
                           size_.y - high.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Framebuffer::resolve_to(const Framebuffer& target) const {
    check(size_ == target.size_ && target.samples_ == 1, "resolved to another kind of framebuffer");
    // With conversion the driver averages decoded samples.
    glEnable(GL_FRAMEBUFFER_SRGB);
    glBlitNamedFramebuffer(id(), target.id(), 0, 0, size_.x, size_.y, 0, 0, size_.x, size_.y,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

const Texture2D& Framebuffer::color() const {
    check(color_.id() != 0U, "framebuffer has no colour texture");
    return color_;
}

const Texture2D& Framebuffer::second_color() const {
    check(second_color_.id() != 0U, "framebuffer has no second colour");
    return second_color_;
}

} // namespace reljef::gl
