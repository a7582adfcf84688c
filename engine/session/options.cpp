#include "engine/session/options.h"

#include <variant>

#include "engine/scene/graph/terrain_node.h"

namespace reljef::session {

scene::Technique technique_of(const SceneOptions& options) {
    scene::Technique technique = options.technique.value_or(scene::Technique{});
    auto* const polygons = std::get_if<scene::Polygons>(&technique.parameters);
    if (polygons != nullptr && !options.technique) {
        polygons->error = options.max_error.value_or(default_max_error);
    } else if (polygons != nullptr && options.max_error.value_or(0.0) > 0.0) {
        polygons->error = *options.max_error;
    }
    return technique;
}

bool may_stream(const SceneOptions& options) {
    return scene::draws_tiles(technique_of(options));
}

bool may_stream_pictures(const SceneOptions& options) {
    const bool is_named = options.technique || options.max_error;
    const bool is_bounded = scene::error_bound(technique_of(options)) > 0.0;
    return may_stream(options) && !(is_named && is_bounded);
}

} // namespace reljef::session
