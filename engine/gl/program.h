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

enum class Stage { vertex, fragment };

/// One shader stage. `name` is the file name in messages. In a text joined from several files each
/// part starts with `#line LINE NUMBER`; number 0 is `name`, number k is `included[k - 1]`.
struct StageSource {
    Stage stage = Stage::vertex;
    std::string name;
    std::string text;
    std::vector<std::string> included{};
};

template <class T> struct GlslType;
template <> struct GlslType<int> { static constexpr std::string_view name = "int"; };
template <> struct GlslType<float> { static constexpr std::string_view name = "float"; };
template <> struct GlslType<glm::ivec2> { static constexpr std::string_view name = "ivec2"; };
template <> struct GlslType<glm::vec2> { static constexpr std::string_view name = "vec2"; };
template <> struct GlslType<glm::vec3> { static constexpr std::string_view name = "vec3"; };
template <> struct GlslType<glm::vec4> { static constexpr std::string_view name = "vec4"; };
template <> struct GlslType<glm::mat3> { static constexpr std::string_view name = "mat3"; };
template <> struct GlslType<glm::mat4> { static constexpr std::string_view name = "mat4"; };

/// `uniform TYPE NAME;` outside blocks.
struct UniformDeclaration {
    std::string_view name;
    std::string_view type;

    friend auto operator<=>(const UniformDeclaration&, const UniformDeclaration&) = default;
};
template <class T> struct Uniform : UniformDeclaration {
    constexpr explicit Uniform(std::string_view glsl_name)
        : UniformDeclaration{glsl_name, GlslType<T>::name} {}
};

/// A linked program.
class Program {
public:
    Program() = default;

    /// Fails with file, line and the driver's message when a stage does not compile, and with all
    /// file names when the stages do not link.
    static Result<Program> create(std::span<const StageSource> stages);

    /// Whether a stage compiles by itself. Fails as create().
    static Result<void> check(const StageSource& stage);

    void use() const;

    /// Sets a uniform; the program need not be in use. Returns false when the program does not use
    /// the uniform.
    template <class T> bool set(const Uniform<T>& uniform, const T& value) {
        const int at = location(uniform.name);
        if (at >= 0) {
            write(at, value);
        }
        return at >= 0;
    }

    /// Size of a uniform block in bytes; 0 when the program does not use the block.
    [[nodiscard]] int block_size(std::string_view name) const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }

private:
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
    std::map<std::string, int, std::less<>> locations_;
};

} // namespace reljef::gl
