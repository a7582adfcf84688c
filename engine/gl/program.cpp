#include "engine/gl/program.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glad/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include "engine/core/check.h"
#include "engine/gl/shader_log.h"

namespace reljef::gl {

namespace {

using Shader = UniqueId<delete_shader>;

std::string info_log(GLuint object, PFNGLGETSHADERIVPROC get, PFNGLGETSHADERINFOLOGPROC get_log) {
    GLint length = 0;
    get(object, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    get_log(object, length, nullptr, log.data());
    return log;
}

Result<Shader> compile(const StageSource& source) {
    Shader shader(
        glCreateShader(source.stage == Stage::vertex ? GL_VERTEX_SHADER : GL_FRAGMENT_SHADER));
    const char* text = source.text.data();
    const auto length = static_cast<GLint>(source.text.size());
    glShaderSource(shader.get(), 1, &text, &length);
    glCompileShader(shader.get());
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_FALSE) {
        const std::string log = info_log(shader.get(), glGetShaderiv, glGetShaderInfoLog);
        return Error{
            fmt::format("shader {} does not compile: {}", source.name, readable_log(source, log))};
    }
    return shader;
}

Result<void> link(GLuint program, std::span<const StageSource> stages) {
    glLinkProgram(program);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == GL_TRUE) {
        return {};
    }
    std::vector<std::string_view> names;
    for (const StageSource& stage : stages) {
        names.emplace_back(stage.name);
    }
    const std::string log = info_log(program, glGetProgramiv, glGetProgramInfoLog);
    return Error{
        fmt::format("shaders {} do not link: {}", fmt::join(names, " + "), readable_log({}, log))};
}

} // namespace

Result<Program> Program::create(std::span<const StageSource> stages) {
    std::vector<Shader> shaders;
    for (const StageSource& stage : stages) {
        auto shader = compile(stage);
        if (!shader) {
            return shader.error();
        }
        shaders.push_back(std::move(*shader));
    }
    Program program;
    program.id_ = UniqueId<delete_program>(glCreateProgram());
    for (const Shader& shader : shaders) {
        glAttachShader(program.id(), shader.get());
    }
    if (const auto linked = link(program.id(), stages); !linked) {
        return linked.error();
    }
    for (const Shader& shader : shaders) {
        glDetachShader(program.id(), shader.get());
    }
    program.read_uniform_locations();
    return program;
}

Result<void> Program::check(const StageSource& stage) {
    const auto shader = gl::compile(stage);
    return shader ? Result<void>() : shader.error();
}

void Program::read_uniform_locations() {
    GLint count = 0;
    GLint longest = 0;
    glGetProgramInterfaceiv(id(), GL_UNIFORM, GL_ACTIVE_RESOURCES, &count);
    glGetProgramInterfaceiv(id(), GL_UNIFORM, GL_MAX_NAME_LENGTH, &longest);
    std::string name(static_cast<std::size_t>(longest), '\0');
    for (GLuint index = 0; index < static_cast<GLuint>(count); ++index) {
        constexpr GLenum property = GL_LOCATION;
        GLint found = -1;
        GLsizei length = 0;
        glGetProgramResourceiv(id(), GL_UNIFORM, index, 1, &property, 1, nullptr, &found);
        glGetProgramResourceName(id(), GL_UNIFORM, index, longest, &length, name.data());
        std::string_view plain(name.data(), static_cast<std::size_t>(length));
        if (plain.ends_with("[0]")) {
            plain.remove_suffix(3);
        }
        if (found >= 0) {
            locations_.emplace(plain, found);
        }
    }
}

void Program::use() const {
    glUseProgram(id());
}

int Program::location(std::string_view name) const {
    const auto found = locations_.find(name);
    return found == locations_.end() ? -1 : found->second;
}

void Program::write(int location, int value) {
    glProgramUniform1i(id(), location, value);
}

void Program::write(int location, float value) {
    glProgramUniform1f(id(), location, value);
}

void Program::write(int location, const glm::ivec2& value) {
    glProgramUniform2iv(id(), location, 1, glm::value_ptr(value));
}

void Program::write(int location, const glm::vec2& value) {
    glProgramUniform2fv(id(), location, 1, glm::value_ptr(value));
}

void Program::write(int location, const glm::vec3& value) {
    glProgramUniform3fv(id(), location, 1, glm::value_ptr(value));
}

void Program::write(int location, const glm::vec4& value) {
    glProgramUniform4fv(id(), location, 1, glm::value_ptr(value));
}

void Program::write(int location, const glm::mat3& value) {
    glProgramUniformMatrix3fv(id(), location, 1, GL_FALSE, glm::value_ptr(value));
}

void Program::write(int location, const glm::mat4& value) {
    glProgramUniformMatrix4fv(id(), location, 1, GL_FALSE, glm::value_ptr(value));
}

int Program::block_size(std::string_view name) const {
    if (id() == 0U) {
        return 0;
    }
    const GLuint block = glGetUniformBlockIndex(id(), std::string(name).c_str());
    if (block == GL_INVALID_INDEX) {
        return 0;
    }
    GLint size = 0;
    glGetActiveUniformBlockiv(id(), block, GL_UNIFORM_BLOCK_DATA_SIZE, &size);
    return size;
}

} // namespace reljef::gl
