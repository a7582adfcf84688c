#include "engine/render/residency/residency.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/matrix.hpp>

#include "engine/gl/limits.h"
#include "engine/render/residency/prewarp.h"
#include "engine/render/residency/uploads.h"
#include "engine/render/shaders/relief_options.h"
#include "engine/scene/streaming/certain_sun.h"
#include "engine/view/terrain_maps.h"

namespace reljef::render {
namespace {

Result<ResidentMaps> with_place(const scene::TerrainSurface& surface, gl::Texture2D lit,
                                std::optional<gl::Texture2D> sun) {
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::vec4 lit_from_sample =
        view::texture_from_sample({heights.cols(), heights.rows()}, lit.size());
    return ResidentMaps{std::move(lit), std::move(sun), lit_from_sample};
}

Result<ResidentMaps> upload_light(const scene::TerrainSurface& surface, const Image& lit,
                                  const Image& sun, view::FrameStats& stats) {
    auto lit_texture = upload_mipmapped(lit, gl::Format::rgba8_srgb, stats);
    if (!lit_texture) {
        return lit_texture.error();
    }
    if (sun.empty()) {
        return with_place(surface, std::move(*lit_texture), std::nullopt);
    }
    auto sun_texture = upload_mipmapped(sun, gl::Format::rgba8_srgb, stats);
    return sun_texture ? with_place(surface, std::move(*lit_texture), std::move(*sun_texture))
                       : sun_texture.error();
}

Result<ResidentMaps> make_maps(const scene::TerrainSurface& surface,
                               const std::optional<scene::TerrainLight>& light, bool in_parts,
                               view::FrameStats& stats) {
    const int largest_side = gl::query_limits().max_texture_size;
    if (!in_parts) {
        return upload_light(surface, view::lit_map(surface, light, largest_side), {}, stats);
    }
    const view::LightParts parts = view::light_parts(surface, *light, largest_side);
    return upload_light(surface, parts.sky, parts.sun, stats);
}

// Empty if nothing is certain of the sun: only exact finds all that hides it.
std::optional<scene::TerrainLight> light_of_certain_sun(const view::DrawList& list,
                                                        const view::TerrainDraw& draw) {
    const scene::Technique& technique = draw.terrain->material.technique;
    const bool casts_hard_shadows =
        technique.id() == scene::TechniqueId::exact && scene::casts_hard_shadows(technique.options);
    const auto light = view::light_on(list, draw.world_from_local);
    const bool is_known =
        casts_hard_shadows && light &&
        scene::sun_in_samples(draw.terrain->surface->placement(), *light).has_value();
    return is_known ? light : std::nullopt;
}

Result<gl::Texture2D> cone_texture(const std::shared_ptr<const material::ConeMaps>& cones,
                                   const Grid<float>& heights, view::FrameStats& stats) {
    const Grid<glm::vec2> texels =
        cone_texels(cones ? *cones : *material::cone_maps(heights.view()));
    return upload_grid(texels, {.format = gl::Format::rg32f, .filter = gl::Filter::nearest}, stats);
}

} // namespace

Result<void> Residency::prepare(const view::DrawList& list, bool with_maps,
                                std::span<const view::MeshDraw> casters, view::FrameStats& stats) {
    forget_unused();
    auto done = terrain_meshes_.prepare(list, stats);
    done = done && with_maps ? prepare_colors(list, stats) : done;
    done = done ? prepare_warped(list, stats) : done;
    done = done ? relief_tiles_.prepare(list, with_maps, tile_maps_, stats) : done;
    done = done ? prepare_reliefs(list, with_maps, stats) : done;
    std::vector<view::MeshDraw> meshes = list.meshes;
    meshes.insert(meshes.end(), list.bases.begin(), list.bases.end());
    meshes.insert(meshes.end(), casters.begin(), casters.end());
    return done ? meshes_.prepare(meshes, list.camera, stats) : done;
}

Result<void> Residency::prepare_colors(const view::DrawList& list, view::FrameStats& stats) {
    auto done = tile_maps_.prepare(list, stats);
    done = done ? prepare_all_maps(list, stats) : done;
    done = done ? ground_.prepare(list, stats) : done;
    done = done ? grain_.prepare(list, stats) : done;
    done = done ? facades_.prepare(list, stats) : done;
    return done ? sky_.prepare(list, stats) : done;
}

Result<void> Residency::prepare_reliefs(const view::DrawList& list, bool with_maps,
                                        view::FrameStats& stats) {
    CertainSuns last = with_maps ? std::exchange(certain_suns_, {}) : CertainSuns();
    for (const view::TerrainDraw* const draw : view::searched_terrains(list)) {
        if (!draw->search->tiles.empty()) { // of a stream: relief_tiles_ has them
            continue;
        }
        auto done = prepare_relief(*draw, stats);
        done = done && with_maps ? prepare_certain_sun(list, *draw, last, stats) : done;
        if (!done) {
            return done;
        }
    }
    return {};
}

Result<void> Residency::add_light(const view::PreparedLight& prepared) {
    const view::LightRequest& request = prepared.request;
    if (request.stream != nullptr) {
        tile_maps_.add_light(request.stream, request.light, prepared.irradiance);
        return {};
    }
    view::FrameStats ignored;
    auto maps = upload_light(*request.surface, prepared.lit, prepared.sun, ignored);
    if (!maps) {
        return maps.error();
    }
    surface_of(request.surface)
        .maps.push_back({request.light, request.in_parts,
                         std::make_shared<const ResidentMaps>(std::move(*maps))});
    return {};
}

void Residency::forget_unused() {
    std::erase_if(surfaces_, [](const auto& entry) { return entry.second.owner.expired(); });
}

Residency::Surface&
Residency::surface_of(const std::shared_ptr<const scene::TerrainSurface>& surface) {
    auto [entry, is_new] = surfaces_.try_emplace(surface.get());
    if (is_new) {
        entry->second.owner = surface;
    }
    return entry->second;
}

Result<void> Residency::prepare_all_maps(const view::DrawList& list, view::FrameStats& stats) {
    maps_.clear();
    for (const view::TileDraw& draw : list.tiles) {
        if (!draw.tile->borrows) {
            continue;
        }
        if (auto done = prepare_maps(list, *draw.terrain, list.world_from_local(draw), stats);
            !done) {
            return done;
        }
    }
    for (const view::TerrainDraw* const draw : view::searched_terrains(list)) {
        if (!draw->search->tiles.empty()) {
            continue;
        }
        if (auto done = prepare_maps(list, *draw->terrain, draw->world_from_local, stats); !done) {
            return done;
        }
    }
    for (const auto& [terrain, maps] : maps_) {
        std::erase_if(surface_of(terrain->surface).maps,
                      [](const LitMaps& entry) { return entry.maps.use_count() == 1; });
    }
    return {};
}

Result<void> Residency::prepare_maps(const view::DrawList& list, const scene::TerrainNode& terrain,
                                     const glm::dmat4& world_from_local, view::FrameStats& stats) {
    if (maps_.contains(&terrain)) {
        return {};
    }
    auto maps = maps_for(terrain, view::light_on(list, world_from_local), stats);
    if (!maps) {
        return maps.error();
    }
    maps_.emplace(&terrain, std::move(*maps));
    return {};
}

Result<std::shared_ptr<const ResidentMaps>>
Residency::maps_for(const scene::TerrainNode& terrain,
                    const std::optional<scene::TerrainLight>& light, view::FrameStats& stats) {
    std::vector<LitMaps>& entries = surface_of(terrain.surface).maps;
    const bool in_parts = light && terrain.material.technique.options.shadow;
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const LitMaps& entry) {
        return entry.light == light && entry.in_parts == in_parts;
    });
    if (found != entries.end()) {
        ++stats.skipped.uploads_unchanged;
        return found->maps;
    }
    auto maps = make_maps(*terrain.surface, light, in_parts, stats);
    if (!maps) {
        return maps.error();
    }
    entries.push_back({light, in_parts, std::make_shared<const ResidentMaps>(std::move(*maps))});
    return entries.back().maps;
}

Result<void> Residency::prepare_relief(const view::TerrainDraw& draw, view::FrameStats& stats) {
    const scene::TerrainSurface& surface = *draw.terrain->surface;
    const scene::Technique& technique = draw.search->technique;
    std::optional<ResidentRelief>& relief = surface_of(draw.terrain->surface).relief;
    const bool uses_mipmap = uses_max_mipmap(technique);
    const bool needs_mipmap = uses_mipmap && !(relief && relief->max_mipmap);
    const bool needs_cones =
        technique.id() == scene::TechniqueId::cone && !(relief && relief->cones);
    if (relief && !needs_mipmap && !needs_cones) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const Grid<float> heights = terrain::unit_heights(surface.heightfield().heights.view());
    if (!relief) {
        auto texture = upload_grid(heights, {.format = gl::Format::r32f}, stats);
        if (!texture) {
            return texture.error();
        }
        relief.emplace();
        relief->space = relief_space(surface);
        relief->heights = std::move(*texture);
    }
    if (needs_mipmap) {
        auto kept = keep(upload_levels(max_mipmap(heights.view()), stats), relief->max_mipmap);
        if (!kept) {
            return kept;
        }
    }
    return needs_cones ? keep(cone_texture(draw.terrain->cones, heights, stats), relief->cones)
                       : Result<void>();
}

Result<void> Residency::prepare_certain_sun(const view::DrawList& list,
                                            const view::TerrainDraw& draw, CertainSuns& last,
                                            view::FrameStats& stats) {
    const auto light = light_of_certain_sun(list, draw);
    if (!light) {
        return {};
    }
    if (const auto kept = last.find(draw.terrain);
        kept != last.end() && kept->second.light == *light &&
        kept->second.surface.lock() == draw.terrain->surface) {
        certain_suns_.insert(last.extract(kept));
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const scene::TerrainSurface& of = *draw.terrain->surface;
    // relief_shadow.glsl begins 1/4096 of the heights above the surface; some renderers interpolate
    // heights to 1/256 of a cell.
    const terrain::MinMax total = of.pyramid().total();
    const double range = total.high - total.low;
    const auto known = scene::certain_sun(
        of.heightfield().heights.view(),
        {*scene::sun_in_samples(of.placement(), *light), range / 2048.0, range / 16.0});
    Grid<float> texels(known.cols(), known.rows());
    std::transform(known.samples().begin(), known.samples().end(), texels.samples().begin(),
                   [](scene::CertainSun cell) { return static_cast<float>(cell); });
    auto texture =
        upload_grid(texels, {.format = gl::Format::r32f, .filter = gl::Filter::nearest}, stats);
    if (!texture) {
        return texture.error();
    }
    certain_suns_.emplace(draw.terrain,
                          CertainSun{draw.terrain->surface, *light, std::move(*texture)});
    return {};
}

Result<void> Residency::prepare_warped(const view::DrawList& list, view::FrameStats& stats) {
    std::map<const scene::TerrainNode*, gl::Texture2D> last = std::exchange(warped_, {});
    for (const view::TileDraw& draw : list.tiles) {
        const scene::TerrainNode& terrain = *draw.terrain;
        if (terrain.material.technique.id() != scene::TechniqueId::prewarp ||
            warped_.contains(&terrain)) {
            continue;
        }
        const Grid<glm::vec4> places =
            warped_places(*terrain.surface, warp_eye(list.camera, list.world_from_local(draw)));
        auto texture = upload_places(places, last[&terrain], stats);
        if (!texture) {
            return texture.error();
        }
        warped_.emplace(&terrain, std::move(*texture));
    }
    return {};
}

const ResidentMaps& Residency::maps(const scene::TerrainNode& terrain) const {
    return *maps_.at(&terrain);
}

const ResidentRelief& Residency::relief(const view::TerrainDraw& draw) const {
    const auto& relief = surfaces_.at(draw.terrain->surface.get()).relief;
    check(relief.has_value(), "a relief that was not prepared");
    return *relief;
}

const gl::Texture2D* Residency::certain_sun(const view::TerrainDraw& draw) const {
    const auto found = certain_suns_.find(draw.terrain);
    return found == certain_suns_.end() ? nullptr : &found->second.cells;
}

const gl::Texture2D& Residency::warped(const scene::TerrainNode& terrain) const {
    return warped_.at(&terrain);
}

} // namespace reljef::render
