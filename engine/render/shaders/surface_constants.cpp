#include "engine/render/shaders/surface_constants.h"

#include <cstddef>
#include <span>
#include <utility>

#include "engine/render/shaders/uniforms.h"

namespace reljef::render {
namespace {

template <class Vector> Vector vector_of(std::span<const float> values) {
    Vector vector{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        vector[static_cast<glm::length_t>(i)] = values[i];
    }
    return vector;
}

// One that the compiler removed is left out.
void set_constant(gl::Program& program, const scene::ShaderConstant& constant) {
    const std::span<const float> values = constant.values;
    switch (values.size()) {
    case 1:
        program.set(gl::Uniform<float>(constant.name), values.front());
        break;
    case 2:
        program.set(gl::Uniform<glm::vec2>(constant.name), vector_of<glm::vec2>(values));
        break;
    case 3:
        program.set(gl::Uniform<glm::vec3>(constant.name), vector_of<glm::vec3>(values));
        break;
    default:
        program.set(gl::Uniform<glm::vec4>(constant.name), vector_of<glm::vec4>(values));
    }
}

} // namespace

ShaderVariant with_surface(ShaderVariant variant, const scene::Material& material) {
    if (material.shader == nullptr) {
        return variant;
    }
    variant.surface = material.shader;
    for (const scene::ShaderConstant& constant : material.constants) {
        variant.constants += constant.name + ' ';
    }
    return variant;
}

void set_surface(gl::Program& program, const scene::Material& material,
                 const scene::Camera& camera) {
    if (material.shader == nullptr) {
        return;
    }
    program.set(uniforms.eye_place, glm::vec3(camera.eye));
    for (const scene::ShaderConstant& constant : material.constants) {
        set_constant(program, constant);
    }
}

} // namespace reljef::render
