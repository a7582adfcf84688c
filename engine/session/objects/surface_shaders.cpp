#include "engine/session/objects/surface_shaders.h"

#include <memory>
#include <utility>

#include "engine/core/atomic_file.h"

namespace reljef::session {

Result<void> set_surface_shader(const io::SurfaceShaderDescription& description,
                                const std::vector<scene::Material*>& materials) {
    auto text = read_text_file(description.file, scene::SurfaceShader::max_bytes);
    if (!text) {
        return text.error();
    }
    auto shader = scene::SurfaceShader::create(description.file.string(), std::move(*text));
    if (!shader) {
        return shader.error();
    }
    std::vector<scene::ShaderConstant> constants;
    for (const auto& [name, values] : description.constants) {
        constants.push_back({name, {values.begin(), values.end()}});
    }
    if (auto good = shader->check(constants); !good) {
        return good;
    }
    const auto shared = std::make_shared<const scene::SurfaceShader>(std::move(*shader));
    for (scene::Material* const material : materials) {
        material->shader = shared;
        material->constants = constants;
    }
    return {};
}

} // namespace reljef::session
