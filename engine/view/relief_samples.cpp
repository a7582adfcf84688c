#include "engine/view/relief_samples.h"

namespace reljef::view {

Box samples_of(const scene::TerrainNode& terrain, std::span<const TileSelection::Drawn> drawn) {
    const scene::TileBuilder& builder = terrain.stream->maker();
    const terrain::MinMax range = terrain.surface->pyramid().total();
    Box samples;
    for (const TileSelection::Drawn& seen : drawn) {
        const terrain::TreeTile tile = seen.tile->id;
        const auto add = [&](glm::ivec2 vertex, double height) {
            samples.add(glm::dvec3(builder.on_overview(builder.sample(tile, vertex)), height));
        };
        add({0, 0}, range.low);
        add(builder.tree().cells(tile), range.high);
    }
    return samples;
}

Box seen_samples(const scene::TerrainSurface& surface, const Frustum& frustum) {
    const terrain::MinMax range = surface.pyramid().total();
    Box samples;
    for (const auto& tile : surface.tiles()) {
        if (frustum.may_see(tile->bounds)) {
            samples.add(glm::dvec3(glm::dvec2(tile->first), range.low));
            samples.add(glm::dvec3(glm::dvec2(tile->first + tile->cells), range.high));
        }
    }
    return samples;
}

std::optional<SunRays> sun_rays(const scene::TerrainNode& terrain,
                                const std::optional<scene::Light>& sun) {
    if (!sun || !terrain.material.technique.options.shadow) {
        return std::nullopt;
    }
    const Grid<float>& heights = terrain.surface->heightfield().heights;
    glm::dvec2 first(0.0);
    glm::dvec2 last(heights.cols() - 1, heights.rows() - 1);
    if (terrain.stream != nullptr) { // its outer samples lie beyond those of the overview
        const scene::TileBuilder& builder = terrain.stream->maker();
        const terrain::TreeTile root = builder.tree().root();
        first = builder.on_overview(builder.sample(root, {0, 0}));
        last = builder.on_overview(builder.sample(root, builder.tree().cells(root)));
    }
    const terrain::MinMax range = terrain.surface->pyramid().total();
    return SunRays{scene::to_light(*sun),
                   {glm::dvec3(first, range.low), glm::dvec3(last, range.high)}};
}

} // namespace reljef::view
