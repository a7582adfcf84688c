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

    /// Sets a uniform of exactly that GLSL type (bool, int, uint, float, ivec2, vec2, vec3, vec4,
    /// mat3, mat4, float[], vec4[]), whether or not the program is in use. Returns false, and does
    /// nothing, when the program does not use it.
    bool set_uniform(std::string_view name, bool value);
    bool set_uniform(std::string_view name, int value);
    bool set_uniform(std::string_view name, unsigned int value);
    bool set_uniform(std::string_view name, float value);
    bool set_uniform(std::string_view name, const glm::ivec2& value);
    bool set_uniform(std::string_view name, const glm::vec2& value);
    bool set_uniform(std::string_view name, const glm::vec3& value);
    bool set_uniform(std::string_view name, const glm::vec4& value);
    bool set_uniform(std::string_view name, const glm::mat3& value);
    bool set_uniform(std::string_view name, const glm::mat4& value);
    bool set_uniform(std::string_view name, std::span<const float> values);
    bool set_uniform(std::string_view name, std::span<const glm::vec4> values);

    /// The texture unit that a sampler reads. False when the program does not use it.
    bool bind_sampler(std::string_view name, unsigned int unit);
    /// The binding point of a uniform block, see Buffer::bind_uniform_block(). False when the
    /// program does not use it.
    bool bind_block(std::string_view name, unsigned int binding);
    /// Bytes that the program expects of a uniform block; 0 when it does not use it.
    [[nodiscard]] int block_size(std::string_view name) const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }

private:
    using Locations = std::map<std::string, int, std::less<>>;

    [[nodiscard]] int location(std::string_view name) const;
    void read_uniform_locations();

    UniqueId<delete_program> id_;
    Locations locations_;
};

} // namespace reljef::gl
