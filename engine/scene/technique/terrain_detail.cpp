#include "engine/scene/technique/terrain_detail.h"

#include <fmt/format.h>

namespace reljef::scene {
namespace {

bool shows_ground(TechniqueId id) {
    return id != TechniqueId::polygons && id != TechniqueId::displacement &&
           id != TechniqueId::prewarp && !looks_for_layers(id);
}

bool has_foreign_options(const TechniqueOptions& options) {
    TechniqueOptions allowed;
    allowed.steps = options.steps;
    allowed.shadow = options.shadow;
    return options != allowed;
}

} // namespace

Result<void> check_terrain_detail_technique(const Technique& technique) {
    if (!shows_ground(technique.id())) {
        return Error{fmt::format("technique {}: a tile of detail on a terrain found, a mesh was "
                                 "expected; normal, relief and exact show both",
                                 technique_info(technique.id()).name)};
    }
    if (has_foreign_options(technique.options)) {
        return Error{fmt::format("technique {}: a tile of detail on a terrain found with an option "
                                 "that only meshes have, none beside steps and shadow was expected",
                                 to_string(technique))};
    }
    return {};
}

} // namespace reljef::scene
