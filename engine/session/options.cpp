#include "engine/session/options.h"

#include "engine/scene/graph/terrain_node.h"

namespace reljef::session {

scene::Technique technique_of(const SceneOptions& options) {
    const scene::Technique technique =
        options.technique.value_or(scene::make_technique(scene::TechniqueId::polygons));
    return options.max_error ? scene::with_parameter(technique, "error", *options.max_error)
                             : technique;
}

bool may_stream(const SceneOptions& options) {
    return scene::draws_tiles(technique_of(options));
}

bool may_stream_pictures(const SceneOptions& options) {
    const scene::Technique technique = technique_of(options);
    const bool promised =
        technique.id == scene::TechniqueId::polygons && scene::parameter(technique, "error") > 0.0;
    return may_stream(options) && !promised;
}

} // namespace reljef::session
