#include "engine/session/options.h"

#include "engine/scene/graph/terrain_node.h"

namespace reljef::session {

scene::Technique technique_of(const SceneOptions& options) {
    if (options.technique && options.max_error.value_or(0.0) == 0.0) {
        return *options.technique;
    }
    return scene::with_parameter(
        options.technique.value_or(scene::make_technique(scene::TechniqueId::polygons)), "error",
        options.max_error.value_or(default_max_error));
}

bool may_stream(const SceneOptions& options) {
    return scene::draws_tiles(technique_of(options));
}

bool may_stream_pictures(const SceneOptions& options) {
    const scene::Technique technique = technique_of(options);
    const bool is_bounded =
        technique.id == scene::TechniqueId::polygons && scene::parameter(technique, "error") > 0.0;
    const bool is_named = options.technique || options.max_error;
    return may_stream(options) && !(is_named && is_bounded);
}

} // namespace reljef::session
