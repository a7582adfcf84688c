#include "engine/gl/debug_log.h"

#include <glad/gl.h>

#include "engine/core/check.h"

namespace reljef::gl {

namespace {

Severity severity_of(GLenum severity) {
    switch (severity) {
    case GL_DEBUG_SEVERITY_HIGH:
        return Severity::high;
    case GL_DEBUG_SEVERITY_MEDIUM:
        return Severity::medium;
    default:
        return Severity::low;
    }
}

void GLAD_API_PTR collect(GLenum /*source*/, GLenum type, GLuint id, GLenum severity,
                          GLsizei length, const GLchar* text, const void* user) {
    if (severity == GL_DEBUG_SEVERITY_NOTIFICATION) {
        return;
    }
    auto* messages = static_cast<std::vector<DebugMessage>*>(const_cast<void*>(user));
    const std::string_view view = length < 0
                                      ? std::string_view(text)
                                      : std::string_view(text, static_cast<std::size_t>(length));
    messages->push_back({.severity = severity_of(severity),
                         .error = type == GL_DEBUG_TYPE_ERROR,
                         .id = id,
                         .text = std::string(view)});
}

} // namespace

std::string_view to_string(Severity severity) {
    switch (severity) {
    case Severity::low:
        return "low";
    case Severity::medium:
        return "medium";
    case Severity::high:
        return "high";
    }
    abort_with("unknown severity");
}

DebugLog::DebugLog() : messages_(std::make_unique<std::vector<DebugMessage>>()) {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    glDebugMessageCallback(collect, messages_.get());
}

DebugLog::DebugLog(DebugLog&&) noexcept = default;

DebugLog::~DebugLog() {
    if (messages_ != nullptr) {
        glDebugMessageCallback(nullptr, nullptr);
    }
}

const std::vector<DebugMessage>& DebugLog::messages() const {
    check(messages_ != nullptr, "debug log was moved from");
    return *messages_;
}

std::vector<std::string> DebugLog::problems() const {
    std::vector<std::string> texts;
    for (const DebugMessage& message : messages()) {
        if (message.error || message.severity != Severity::low) {
            texts.push_back(message.text);
        }
    }
    return texts;
}

void DebugLog::clear() {
    check(messages_ != nullptr, "debug log was moved from");
    messages_->clear();
}

} // namespace reljef::gl
