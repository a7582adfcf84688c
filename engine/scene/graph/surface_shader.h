#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"

namespace reljef::scene {

/// A value for a uniform of a surface shader.
struct ShaderConstant {
    std::string name;
    std::vector<float> values; ///< 1: float, 2 to 4: vec2 to vec4

    friend bool operator==(const ShaderConstant&, const ShaderConstant&) = default;
};

/// A material's own shader: GLSL 4.50 that changes the light which a surface reflects. It changes
/// no hit. Only OpenGL draws it.
///
/// The text has the function `vec3 surface_color(Surface surface)`, which returns linear light;
/// `Surface` is declared in shaders/material/surface.glsl. Terrains with `prewarp` have albedo 1
/// and a vertical normal. It may have other functions, and constants `uniform float|vec2|vec3|vec4
/// NAME;`, with or without a value, each in a declaration of its own.
class SurfaceShader {
public:
    struct Declaration {
        std::string name;
        std::size_t size = 0;     ///< numbers
        bool has_default = false; ///< declared with a value
    };

    /// `name`: the file, for errors. Fails without that name, with other uniforms or names that are
    /// no identifiers, with a zero byte, and with more than max_bytes bytes. A byte order mark is
    /// left out. Other errors are found when it is compiled.
    static Result<SurfaceShader> create(std::string name, std::string text);

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] std::span<const Declaration> constants() const { return constants_; }

    /// Fails if a constant's name is no identifier, is not declared, has another size, or has no
    /// value although its declaration has none.
    [[nodiscard]] Result<void> check(std::span<const ShaderConstant> constants) const;

    static constexpr std::size_t max_bytes = 65'536;

private:
    SurfaceShader(std::string name, std::string text)
        : name_(std::move(name)), text_(std::move(text)) {}

    std::string name_;
    std::string text_;
    std::vector<Declaration> constants_;
};

} // namespace reljef::scene
