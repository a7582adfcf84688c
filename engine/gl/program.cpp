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

template <class Set> bool set_at(int location, const Set& set) {
    if (location < 0) {
        return false;
    }
    set(location);
    return true;
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

bool Program::set_uniform(std::string_view name, bool value) {
    return set_uniform(name, value ? 1 : 0);
}

bool Program::set_uniform(std::string_view name, int value) {
    return set_at(location(name), [&](int at) { glProgramUniform1i(id(), at, value); });
}

bool Program::set_uniform(std::string_view name, unsigned int value) {
    return set_at(location(name), [&](int at) { glProgramUniform1ui(id(), at, value); });
}

bool Program::set_uniform(std::string_view name, float value) {
    return set_at(location(name), [&](int at) { glProgramUniform1f(id(), at, value); });
}

bool Program::set_uniform(std::string_view name, const glm::ivec2& value) {
    return set_at(location(name),
                  [&](int at) { glProgramUniform2iv(id(), at, 1, glm::value_ptr(value)); });
}

bool Program::set_uniform(std::string_view name, const glm::vec2& value) {
    return set_at(location(name),
                  [&](int at) { glProgramUniform2fv(id(), at, 1, glm::value_ptr(value)); });
}

bool Program::set_uniform(std::string_view name, const glm::vec3& value) {
    return set_at(location(name),
                  [&](int at) { glProgramUniform3fv(id(), at, 1, glm::value_ptr(value)); });
}

bool Program::set_uniform(std::string_view name, const glm::vec4& value) {
    return set_at(location(name),
                  [&](int at) { glProgramUniform4fv(id(), at, 1, glm::value_ptr(value)); });
}

bool Program::set_uniform(std::string_view name, const glm::mat3& value) {
    return set_at(location(name), [&](int at) {
        glProgramUniformMatrix3fv(id(), at, 1, GL_FALSE, glm::value_ptr(value));
    });
}

bool Program::set_uniform(std::string_view name, const glm::mat4& value) {
    return set_at(location(name), [&](int at) {
        glProgramUniformMatrix4fv(id(), at, 1, GL_FALSE, glm::value_ptr(value));
    });
}

bool Program::set_uniform(std::string_view name, std::span<const float> values) {
    return set_at(location(name), [&](int at) {
        glProgramUniform1fv(id(), at, static_cast<GLsizei>(values.size()), values.data());
    });
}

bool Program::set_uniform(std::string_view name, std::span<const glm::vec4> values) {
    const float* first = values.empty() ? nullptr : glm::value_ptr(values.front());
    return set_at(location(name), [&](int at) {
        glProgramUniform4fv(id(), at, static_cast<GLsizei>(values.size()), first);
    });
}

bool Program::bind_sampler(std::string_view name, unsigned int unit) {
    return set_uniform(name, static_cast<int>(unit));
}

bool Program::bind_block(std::string_view name, unsigned int binding) {
    const GLuint block = block_index(id(), name);
    if (block == GL_INVALID_INDEX) {
        return false;
    }
    glUniformBlockBinding(id(), block, binding);
    return true;
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
