#include "engine/gl/program.h"

#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glad/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include "engine/core/check.h"
#include "engine/gl/shader_log.h"

namespace reljef::gl {

namespace {

using Shader = UniqueId<delete_shader>;

GLenum shader_type(Stage stage) {
    switch (stage) {
    case Stage::vertex:
        return GL_VERTEX_SHADER;
    case Stage::tessellation_control:
        return GL_TESS_CONTROL_SHADER;
    case Stage::tessellation_evaluation:
        return GL_TESS_EVALUATION_SHADER;
    case Stage::geometry:
        return GL_GEOMETRY_SHADER;
    case Stage::fragment:
        return GL_FRAGMENT_SHADER;
    case Stage::compute:
        return GL_COMPUTE_SHADER;
    }
    abort_with("unknown shader stage");
}

std::string shader_info_log(GLuint shader) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetShaderInfoLog(shader, length, nullptr, log.data());
    return log;
}

std::string program_info_log(GLuint program) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetProgramInfoLog(program, length, nullptr, log.data());
    return log;
}

Result<Shader> compile(const StageSource& source) {
    Shader shader(glCreateShader(shader_type(source.stage)));
    const char* text = source.text.data();
    const auto length = static_cast<GLint>(source.text.size());
    glShaderSource(shader.get(), 1, &text, &length);
    glCompileShader(shader.get());
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_FALSE) {
        return Error{fmt::format("shader {} does not compile: {}", source.name,
                                 readable_log(source, shader_info_log(shader.get())))};
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
    return Error{fmt::format("shaders {} do not link: {}", fmt::join(names, " + "),
                             readable_log({}, program_info_log(program)))};
}

GLuint block_index(GLuint program, std::string_view name) {
    return program == 0U ? GL_INVALID_INDEX
                         : glGetUniformBlockIndex(program, std::string(name).c_str());
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

void Program::read_uniform_locations() {
    GLint count = 0;
    GLint longest = 0;
    glGetProgramInterfaceiv(id(), GL_UNIFORM, GL_ACTIVE_RESOURCES, &count);
    glGetProgramInterfaceiv(id(), GL_UNIFORM, GL_MAX_NAME_LENGTH, &longest);
    std::string name(static_cast<std::size_t>(longest), '\0');
    for (GLuint index = 0; index < static_cast<GLuint>(count); ++index) {
        constexpr GLenum asked = GL_LOCATION;
        GLint found = -1;
        GLsizei length = 0;
        glGetProgramResourceiv(id(), GL_UNIFORM, index, 1, &asked, 1, nullptr, &found);
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

bool Program::has_uniform(std::string_view name) const {
    return location(name) >= 0;
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
    const GLuint block = block_index(id(), name);
    if (block == GL_INVALID_INDEX) {
        return 0;
    }
    GLint size = 0;
    glGetActiveUniformBlockiv(id(), block, GL_UNIFORM_BLOCK_DATA_SIZE, &size);
    return size;
}

} // namespace reljef::gl
