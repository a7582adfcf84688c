#include "engine/render/residency/facade_residency.h"

#include <cstring>
#include <utility>

#include "engine/render/residency/uploads.h"
#include "engine/render/shaders/bindings.h"

namespace reljef::render {
namespace {

constexpr int wall_texels = 4;
static_assert(sizeof(view::FacadeTexels) == wall_texels * sizeof(glm::vec4));
constexpr int walls_a_row = 256;

// Row after row.
Grid<glm::vec4> texels_of(const std::vector<view::FacadeTexels>& walls) {
    const int rows = (static_cast<int>(walls.size()) + walls_a_row - 1) / walls_a_row;
    Grid<glm::vec4> texels(walls_a_row * wall_texels, rows, glm::vec4(0.0F));
    std::memcpy(texels.samples().data(), walls.data(), walls.size() * sizeof(view::FacadeTexels));
    return texels;
}

} // namespace

Result<void> FacadeResidency::prepare(const view::DrawList& list, view::FrameStats& stats) {
    std::erase_if(entries_, [](const auto& entry) { return entry.second.owner.expired(); });
    for (const view::TerrainDraw& draw : list.terrains) {
        if (!view::shows_facades(*draw.terrain)) {
            continue;
        }
        const auto light = view::light_on(list, draw.world_from_local);
        if (auto done = prepare(*draw.terrain, draw.world_from_local, light, stats); !done) {
            return done;
        }
    }
    return {};
}

Result<void> FacadeResidency::prepare(const scene::TerrainNode& terrain,
                                      const glm::dmat4& world_from_local,
                                      const std::optional<scene::TerrainLight>& light,
                                      view::FrameStats& stats) {
    const auto found = entries_.find(terrain.surface.get());
    if (found != entries_.end() && found->second.light == light) {
        return {};
    }
    const view::FacadeMap map = view::facade_map(*terrain.surface, world_from_local, light);
    auto samples = upload_grid(map.samples,
                               {.format = gl::Format::rg32f, .filter = gl::Filter::nearest}, stats);
    if (!samples) {
        return samples.error();
    }
    auto walls = upload_grid(texels_of(map.walls),
                             {.format = gl::Format::rgba32f, .filter = gl::Filter::nearest}, stats);
    if (!walls) {
        return walls.error();
    }
    entries_[terrain.surface.get()] = {
        terrain.surface, light, {std::move(*samples), std::move(*walls), map.sun, map.sky}};
    return {};
}

const ResidentFacades& FacadeResidency::bind(const scene::TerrainNode& terrain) const {
    const ResidentFacades& facades = entries_.at(terrain.surface.get()).facades;
    facades.samples.bind(bindings::facade_samples_unit);
    facades.walls.bind(bindings::facade_walls_unit);
    return facades;
}

} // namespace reljef::render
