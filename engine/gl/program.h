#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/fwd.hpp>

#include "engine/core/result.h"
#include "engine/gl/unique_id.h"

namespace reljef::gl {

enum class Stage {
    vertex,
    tessellation_control,
    tessellation_evaluation,
    geometry,
    fragment,
    compute
};

/// One shader stage. `name` is the file that messages speak of. Where the text is joined from
/// several files, each part starts with `#line LINE NUMBER`, where 0 is `name` and k is
/// `included[k - 1]`.
struct StageSource {
    Stage stage = Stage::vertex;
    std::string name;
    std::string text;
    std::vector<std::string> included{};
};

/// GLSL's name of a uniform's type. Other types do not compile.
template <class T> struct GlslType;
template <> struct GlslType<int> { static constexpr std::string_view name = "int"; };
template <> struct GlslType<float> { static constexpr std::string_view name = "float"; };
template <> struct GlslType<glm::ivec2> { static constexpr std::string_view name = "ivec2"; };
template <> struct GlslType<glm::vec2> { static constexpr std::string_view name = "vec2"; };
template <> struct GlslType<glm::vec3> { static constexpr std::string_view name = "vec3"; };
template <> struct GlslType<glm::vec4> { static constexpr std::string_view name = "vec4"; };
template <> struct GlslType<glm::mat3> { static constexpr std::string_view name = "mat3"; };
template <> struct GlslType<glm::mat4> { static constexpr std::string_view name = "mat4"; };

/// A uniform outside blocks as shaders declare it: `uniform TYPE NAME;`.
struct UniformDeclaration {
    std::string_view name;
    std::string_view type;

    friend auto operator<=>(const UniformDeclaration&, const UniformDeclaration&) = default;
};
template <class T> struct Uniform : UniformDeclaration {
    constexpr explicit Uniform(std::string_view glsl_name)
        : UniformDeclaration{glsl_name, GlslType<T>::name} {}
};

/// A linked program. Default-constructed and moved-from ones hold nothing (id 0).
class Program {
public:
    Program() = default;

    /// Fails with the file, the line and the driver's words when a stage does not compile, with all
    /// file names when they do not link.
    static Result<Program> create(std::span<const StageSource> stages);

    void use() const;

    /// Whether the linked program uses that uniform (outside blocks): the driver drops unused ones.
    /// Array names come without [0].
    [[nodiscard]] bool has_uniform(std::string_view name) const;

    /// Sets a uniform, whether or not the program is in use. Returns false, and does nothing, when
    /// the program does not use it. A value of another type does not compile.
    template <class T> bool set(const Uniform<T>& uniform, const T& value) {
        const int at = location(uniform.name);
        if (at >= 0) {
            write(at, value);
        }
        return at >= 0;
    }

    /// Bytes that the program expects of a uniform block; 0 when it does not use it.
    [[nodiscard]] int block_size(std::string_view name) const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }

private:
    using Locations = std::map<std::string, int, std::less<>>;

    [[nodiscard]] int location(std::string_view name) const;
    void read_uniform_locations();
    void write(int location, int value);
    void write(int location, float value);
    void write(int location, const glm::ivec2& value);
    void write(int location, const glm::vec2& value);
    void write(int location, const glm::vec3& value);
    void write(int location, const glm::vec4& value);
    void write(int location, const glm::mat3& value);
    void write(int location, const glm::mat4& value);

    UniqueId<delete_program> id_;
    Locations locations_;
};

} // namespace reljef::gl
