#include "engine/render/residency/ground_residency.h"

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "engine/gl/limits.h"
#include "engine/render/residency/uploads.h"

namespace reljef::render {
namespace {

// One draw of each terrain with visible detail.
std::vector<const view::TileDraw*> first_detailed(const std::vector<view::TileDraw>& draws) {
    std::vector<const view::TileDraw*> first;
    std::set<const scene::TerrainNode*> found;
    for (const view::TileDraw& draw : draws) {
        if (draw.detail != view::DetailLevel::none && found.insert(draw.terrain).second) {
            first.push_back(&draw);
        }
    }
    return first;
}

} // namespace

Result<ResidentGround> resident_ground(const view::GroundMap& map, glm::vec4 ground_from_sample,
                                       view::FrameStats& stats) {
    auto albedo = upload_mipmapped(map.albedo, gl::Format::rgba8_srgb, stats);
    if (!albedo) {
        return albedo.error();
    }
    auto surface = upload_mipmapped(snorm16(map.surface), gl::Format::rgba16_snorm, stats);
    if (!surface) {
        return surface.error();
    }
    return ResidentGround{std::move(*albedo), std::move(*surface), ground_from_sample};
}

Result<void> GroundResidency::prepare(const view::DrawList& list, view::FrameStats& stats) {
    tiles_.forget_unused();
    std::erase_if(grounds_, [](const auto& entry) { return entry.second.owner.expired(); });
    for (const view::TileDraw* const draw : first_detailed(list.tiles)) {
        if (auto done = prepare_tile(*draw->terrain->detail, stats); !done) {
            return done;
        }
        if (!draw->tile->borrows) {
            continue; // it has a map of its own
        }
        if (auto done = prepare_ground(list, *draw->terrain, list.world_from_local(*draw), stats);
            !done) {
            return done;
        }
    }
    return prepare_lit_grounds(list, stats);
}

// Terrains in memory: loaded tiles have maps of their own.
Result<void> GroundResidency::prepare_lit_grounds(const view::DrawList& list,
                                                  view::FrameStats& stats) {
    std::map<const scene::TerrainNode*, glm::dmat4> reached;
    for (const view::TileDraw& draw : list.tiles) {
        if (draw.tile->borrows && view::needs_ground(list, draw)) {
            reached.emplace(draw.terrain, list.world_from_local(draw));
        }
    }
    for (const view::TerrainDraw* const draw : view::searched_terrains(list)) {
        if (draw->search->tiles.empty() && view::needs_ground(list, *draw)) {
            reached.emplace(draw->terrain, draw->world_from_local);
        }
    }
    for (const auto& [terrain, world_from_local] : reached) {
        if (auto done = prepare_ground(list, *terrain, world_from_local, stats); !done) {
            return done;
        }
    }
    return {};
}

Result<void> GroundResidency::prepare_tile(const scene::TerrainDetail& detail,
                                           view::FrameStats& stats) {
    return tiles_.prepare(detail.set, ground_side(), detail.technique.id(), stats);
}

Result<void> GroundResidency::prepare_ground(const view::DrawList& list,
                                             const scene::TerrainNode& terrain,
                                             const glm::dmat4& world_from_local,
                                             view::FrameStats& stats) {
    const auto light = view::light_on(list, world_from_local);
    const auto found = grounds_.find(&terrain);
    if (found != grounds_.end() && found->second.owner.lock() == terrain.surface &&
        found->second.light == light) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const view::GroundMap map =
        view::ground_map(*terrain.surface, light, gl::query_limits().max_texture_size);
    const Grid<float>& heights = terrain.surface->heightfield().heights;
    auto resident =
        resident_ground(map,
                        view::texture_from_sample({heights.cols(), heights.rows()},
                                                  {map.albedo.cols(), map.albedo.rows()}),
                        stats);
    if (!resident) {
        return resident.error();
    }
    grounds_.insert_or_assign(&terrain, Ground{terrain.surface, light, std::move(*resident)});
    return {};
}

const ResidentGround& GroundResidency::ground(const scene::TerrainNode& terrain) const {
    return grounds_.at(&terrain).resident;
}

} // namespace reljef::render
