#include "engine/view/choice/technique_choice.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/terrain/mesh/tile_layout.h"
#include "engine/view/choice/ray_error.h"
#include "engine/view/error_view.h"
#include "engine/view/sample_count.h"

namespace reljef::view {
namespace {

// Estimates of triangles are that near: more may not fit.
constexpr double certain_share = 0.8;
constexpr double max_lack = 1e4; // times the triangles that fit
// Of the time that what is proven takes: estimates are about that near.
constexpr double share_worth_a_proof = 0.9;

bool is_automatic(const scene::TerrainNode& terrain) {
    return terrain.material.technique.id() == scene::TechniqueId::automatic;
}

bool is_chosen(const DrawList& list) {
    return !list.tiles.empty() &&
           std::any_of(list.terrains.begin(), list.terrains.end(),
                       [](const TerrainDraw& draw) { return is_automatic(*draw.terrain); });
}

// Rays write no depth, so nothing else may be in the picture. On the ellipsoid and over streams
// their error is not proven.
bool may_have_rays(const DrawList& list, const TerrainDraw& draw, int max_map_side) {
    const scene::TerrainNode& terrain = *draw.terrain;
    const Grid<float>& heights = terrain.surface->heightfield().heights;
    const auto side = static_cast<unsigned>(std::max(heights.cols(), heights.rows()));
    return list.terrains.size() == 1 && !draw.search && list.meshes.empty() && list.bases.empty() &&
           terrain.stream == nullptr && !terrain.material.wireframe && terrain.detail == nullptr &&
           terrain.surface->placement().kind() == terrain::PlacementKind::plane &&
           list.camera.projection == scene::ProjectionKind::perspective &&
           glm::dmat3(draw.world_from_local) == glm::dmat3(1.0) &&
           std::bit_ceil(side) <= static_cast<unsigned>(max_map_side);
}

RayError error_of_rays(const DrawList& list, const TerrainDraw& draw, double steepness) {
    return {list.camera, list.size, *draw.terrain->surface, steepness,
            glm::dvec3(draw.world_from_local[3])};
}

std::vector<std::shared_ptr<const scene::TerrainTile>> tiles_of(const DrawList& list) {
    std::vector<std::shared_ptr<const scene::TerrainTile>> tiles;
    tiles.reserve(list.tiles.size());
    for (const TileDraw& draw : list.tiles) {
        tiles.push_back(draw.tile);
    }
    return tiles;
}

// Metres by which triangles at a place may be off, or none if it is not visible.
std::optional<double> allowed_at(const terrain::ErrorView& view, glm::dvec3 place, double radius) {
    for (const glm::dvec4& side : view.sides) {
        if (glm::dot(glm::dvec3(side), place) + side.w < -radius) {
            return std::nullopt;
        }
    }
    const double depth = glm::dot(glm::dvec3(view.depth), place) + view.depth.w;
    const double nearest = std::max(depth, std::max(view.near, 0.5 * radius));
    const double lateral = glm::length(view.lateral_axes * place + view.lateral_origin);
    return view.max_error * nearest * nearest / (view.scale * std::max(lateral, 0.5 * radius));
}

double triangles_of(const scene::TerrainTile& tile, const TerrainDraw& draw,
                    const TriangleCounts& counts) {
    const auto* const view = std::get_if<terrain::ErrorView>(&*draw.coarseness);
    const scene::TerrainSurface& surface = *draw.terrain->surface;
    const Grid<float>& heights = surface.heightfield().heights;
    constexpr int block_cells = TriangleCounts::block_cells;
    const double radius =
        0.5 * block_cells * glm::length(surface.placement().spacing()); // along the ground
    double triangles = 0.0;
    for (int row = 0; row < tile.cells.y; row += block_cells) {
        for (int col = 0; col < tile.cells.x; col += block_cells) {
            const glm::ivec2 first = tile.first + glm::ivec2(col, row);
            const glm::ivec2 middle =
                glm::min(first + block_cells / 2, glm::ivec2(heights.cols(), heights.rows()) - 1);
            const glm::dvec3 place = surface.placement().world_from_sample(
                {glm::dvec2(middle), heights(middle.x, middle.y)});
            if (const auto allowed = allowed_at(*view, place, radius)) {
                triangles += counts.triangles(first / block_cells, *allowed);
            }
        }
    }
    return triangles;
}

glm::ivec2 tile_below(const DrawList& list, const TerrainDraw& draw) {
    constexpr double farthest = 1e6; // tiles
    const auto sample = draw.terrain->surface->placement().sample_from_world(
        list.camera.eye - glm::dvec3(draw.world_from_local[3]));
    const glm::dvec2 tile = glm::floor(glm::dvec2(*sample) / double{terrain::tile_cells});
    return glm::ivec2(glm::clamp(tile, -farthest, farthest));
}

int ring_of(const scene::TerrainTile& tile, glm::ivec2 below) {
    const glm::ivec2 away = glm::abs(tile.first / terrain::tile_cells - below);
    return std::max(away.x, away.y);
}

std::vector<RingCost> costs_of_rings(const DrawList& list, const TerrainDraw& draw,
                                     const TriangleCounts& counts, const ProbedView& probed) {
    const glm::ivec2 below = tile_below(list, draw);
    std::map<int, RingCost> rings;
    for (const TileDraw& tile : list.tiles) {
        const int ring = ring_of(*tile.tile, below);
        RingCost& cost = rings.try_emplace(ring, RingCost{.ring = ring}).first->second;
        const double triangles = triangles_of(*tile.tile, draw, counts);
        cost.triangles += triangles;
        const glm::ivec2 place = tile.tile->first / terrain::tile_cells;
        const auto seen = probed.tile_pixels.find({place.x, place.y});
        if (seen != probed.tile_pixels.end()) {
            cost.pixels += seen->second;
            cost.seen_triangles += triangles;
        }
    }
    std::vector<RingCost> costs;
    costs.reserve(rings.size());
    for (const auto& [ring, cost] : rings) {
        costs.push_back(cost);
    }
    return costs;
}

ViewCosts view_costs(const DrawList& list, const TriangleCounts& counts, const ProbedView& probed,
                     int samples) {
    const TerrainDraw& draw = list.terrains.front();
    const double pixels = static_cast<double>(list.size.x) * list.size.y;
    const bool is_free = samples == automatic_samples; // the driver chooses
    return {.rings = costs_of_rings(list, draw, counts, probed),
            .box_pixels = pixels * static_cast<double>(probed.of_box.size()) /
                          (static_cast<double>(view_probes.x) * view_probes.y),
            .samples_of_rays = is_free ? 1 : samples,
            .samples_of_both = is_free ? samples_of_triangles : samples,
            .max_triangles = certain_share * static_cast<double>(draw.terrain->max_triangles)};
}

// Leaves the tiles up to a ring to triangles, and all else to rays.
void split_at(DrawList& list, int last_ring, const scene::Technique& search) {
    TerrainDraw& terrain = list.terrains.front();
    const glm::ivec2 below = tile_below(list, terrain);
    std::erase_if(list.tiles,
                  [&](const TileDraw& draw) { return ring_of(*draw.tile, below) > last_ring; });
    terrain.search = SurfaceSearch{.technique = search};
    terrain.search->technique.options.shadow = terrain.terrain->material.technique.options.shadow;
}

bool allows_typical(const scene::TerrainNode& terrain) {
    const auto* const automatic =
        std::get_if<scene::Automatic>(&terrain.material.technique.parameters);
    return automatic != nullptr && automatic->typical;
}

// Of a search that takes that many steps in each ray, instead of exact rays. `interval` begins, as
// exact rays do, where the beams of blocks of pixels end.
TechniqueCosts with_search(TechniqueCosts costs, scene::TechniqueId id, double steps) {
    costs.rays_ms = id == scene::TechniqueId::interval ? costs.rays_ms : 0.0;
    costs.ray_pixel_ns = costs.search_pixel_ns + steps * costs.search_step_ns;
    return costs;
}

} // namespace

void TechniqueChooser::know(const scene::TerrainNode& terrain) {
    if (surface_.lock() != terrain.surface) {
        counts_ = terrain.bisection != nullptr
                      ? TriangleCounts(*terrain.bisection)
                      : TriangleCounts(terrain::Bisection(terrain.surface->heightfield(),
                                                          terrain.surface->placement()));
        probed_ = ProbedSurface(*terrain.surface);
        surface_ = terrain.surface;
    }
}

ViewPlan TechniqueChooser::cheapest(const ViewCosts& view, const TechniqueCosts& costs,
                                    Kinds kinds) {
    return kinds == Kinds::both ? cheapest_plan(view, costs) : cheaper_alone(view, costs);
}

TechniqueChooser::Decision TechniqueChooser::decide_proven(const DrawList& list,
                                                           const ViewCosts& view, Kinds kinds) {
    Decision decision;
    const TerrainDraw& draw = list.terrains.front();
    const int last_ring = view.rings.back().ring;
    const ViewPlan triangles = plan_up_to(last_ring, view, options_.costs);
    decision.choice.triangles_ms = triangles.ms;
    decision.choice.touched_pixels = triangles.touched_pixels;
    const double bound = scene::error_bound(draw.terrain->material.technique);
    const auto& error_view = std::get<terrain::ErrorView>(*draw.coarseness);
    const double triangle_error = std::max(bound, error_with_rounding(error_view));
    // With fewer triangles than they need, they are off by more, about in proportion.
    const double by_triangles =
        triangle_error * std::clamp(triangles.triangles / view.max_triangles, 1.0, max_lack);
    const double of_rays = rounding_.of(list, draw, tiles_of(list), RayFloats::opengl).error;
    const double kept = std::max(bound, of_rays);
    if (kept > by_triangles) {
        decision.choice.estimated_ms = triangles.ms;
        decision.last_ring = last_ring;
        return decision;
    }
    const ViewPlan best = cheapest(view, options_.costs, kinds);
    decision.choice.rays_ms = plan_up_to(-1, view, options_.costs).ms;
    decision.choice.estimated_ms = best.ms;
    decision.choice.ray_pixels = best.ray_pixels / (static_cast<double>(list.size.x) * list.size.y);
    decision.last_ring = best.last_ring;
    if (best.last_ring < last_ring) {
        decision.search = scene::make_technique(scene::TechniqueId::exact);
        decision.kept_error = kept;
        decision.exceeded_by_rounding = kept > bound && error_view.exceeded_by_rounding;
        decision.lacks_triangles = kept > triangle_error;
    }
    return decision;
}

// Rays alone: the pixels that triangles leave would be the worst ones, and between both there would
// be cracks.
void TechniqueChooser::consider_unproven(const DrawList& list, const ViewCosts& view,
                                         Decision& decision) {
    const TerrainDraw& draw = list.terrains.front();
    const double bound = scene::error_bound(draw.terrain->material.technique);
    const double steepness = rounding_.slopes_over(draw.terrain->surface).steepness;
    if (!error_of_rays(list, draw, steepness).keeps(bound)) {
        return; // floats would round by more than the probes know
    }
    const double pixels = static_cast<double>(list.size.x) * list.size.y;
    const TypicalSearch search({list.camera, list.size, glm::dvec3(draw.world_from_local[3])},
                               *draw.terrain->surface);
    const std::vector<ProbeRay> probes = probe_view(list, draw, nullptr).of_box;
    double limit = share_worth_a_proof * decision.choice.estimated_ms;
    const auto plan_with = [&](const scene::Technique& technique, double steps) {
        return plan_up_to(-1, view, with_search(options_.costs, technique.id(), steps));
    };
    for (const scene::Technique& technique : typical_searches()) {
        if (plan_with(technique, 0.0).ms >= limit) {
            continue;
        }
        const auto trial = search.try_along(technique, probes, {bound});
        const ViewPlan plan = plan_with(technique, trial ? trial->steps : 0.0);
        if (trial && plan.ms < limit) {
            limit = plan.ms;
            decision.choice.estimated_ms = plan.ms;
            decision.choice.ray_pixels = plan.ray_pixels / pixels;
            decision.choice.typical = TypicalChoice{scene::to_string(technique), trial->share()};
            decision.last_ring = plan.last_ring;
            decision.search = technique;
            decision.kept_error.reset();
        }
    }
}

// Whether the choice may well be another one once hidden tiles are dropped: what probes hit is
// about what is not hidden.
bool TechniqueChooser::may_hidden_decide(const ViewCosts& view, const Decision& decision) const {
    if (!decision.search || decision.last_ring >= 0 || decision.lacks_triangles) {
        return true;
    }
    ViewCosts seen = view;
    for (RingCost& ring : seen.rings) {
        ring.triangles = certain_share * ring.seen_triangles;
    }
    return cheapest_plan(seen, options_.costs).last_ring >= 0;
}

TechniqueChooser::Decision TechniqueChooser::decide(const DrawList& list, Kinds kinds,
                                                    const std::function<void()>& drop_hidden) {
    const TerrainDraw& draw = list.terrains.front();
    if (!may_have_rays(list, draw, max_map_side_)) {
        drop_hidden();
        return {};
    }
    know(*draw.terrain);
    const ProbedView probed = probe_view(list, draw, &probed_);
    ViewCosts view = view_costs(list, counts_, probed, samples_);
    Decision decision = decide_proven(list, view, kinds);
    if (may_hidden_decide(view, decision)) {
        const std::size_t tiles = list.tiles.size();
        drop_hidden();
        if (list.tiles.size() < tiles && !list.tiles.empty()) {
            view = view_costs(list, counts_, probed, samples_);
            decision = decide_proven(list, view, kinds);
        }
    }
    if (allows_typical(*draw.terrain)) {
        consider_unproven(list, view, decision);
    }
    return decision;
}

void TechniqueChooser::choose_for_parts(const DrawList& whole) {
    for_parts_.reset();
    if (is_chosen(whole) && !(options_.rays_draw && options_.rays_draw(whole))) {
        for_parts_ = decide(whole, Kinds::one, [] {}); // hidden tiles are dropped already
    }
}

// Rays on the CPU state their own, and other searches none.
void TechniqueChooser::state_error_of_rays(DrawList& list) {
    const auto is_exact = [](const TerrainDraw& draw) {
        return draw.search && draw.search->technique.id() == scene::TechniqueId::exact;
    };
    if (std::none_of(list.terrains.begin(), list.terrains.end(), is_exact) ||
        (options_.rays_draw && options_.rays_draw(list))) {
        return;
    }
    for (const TerrainDraw& draw : list.terrains) {
        if (is_exact(draw)) {
            state_error_of_rays(list, draw);
        }
    }
}

void TechniqueChooser::state_error_of_rays(DrawList& list, const TerrainDraw& draw) {
    const SurfaceSearch& search = *draw.search;
    const bool has_tiles = !search.tiles.empty();
    const bool is_proven =
        has_tiles ? search.tile_error.has_value()
                  : draw.terrain->stream == nullptr && draw.terrain->surface->has_all_samples();
    if (!is_proven) {
        return;
    }
    const auto& tiles = has_tiles ? search.tiles : draw.terrain->surface->tiles();
    const auto rounding = rounding_.of(list, draw, tiles, RayFloats::opengl);
    const double of_tiles = search.tile_error.value_or(0.0);
    const double before = list.stats.kept_error.value_or(0.0);
    if (of_tiles + rounding.error > before) {
        list.stats.exceeded_by_rounding = rounding.is_of_view && rounding.error > of_tiles;
    }
    list.stats.kept_error = std::max(before, of_tiles + rounding.error);
}

void TechniqueChooser::choose(DrawList& list, const std::function<void()>& drop_hidden) {
    if (!is_chosen(list)) {
        drop_hidden();
        state_error_of_rays(list);
        return;
    }
    if (options_.rays_draw && options_.rays_draw(list)) {
        drop_hidden();
        const auto tiles = static_cast<int>(list.tiles.size());
        list.stats.choice = Choice{.tiles_by_rays = tiles, .ray_pixels = 1.0};
        return;
    }
    Decision decision;
    if (list.camera.whole != glm::ivec2(0) && for_parts_) { // a part
        if (!for_parts_->search) {
            drop_hidden();
        }
        decision = *for_parts_;
    } else {
        decision = decide(list, Kinds::both, drop_hidden);
    }
    if (list.tiles.empty()) {
        return; // all are hidden
    }
    const auto tiles = static_cast<int>(list.tiles.size());
    if (decision.search) {
        split_at(list, decision.last_ring, *decision.search);
        if (list.terrains.front().terrain->surface->has_all_samples()) {
            list.stats.kept_error = decision.kept_error; // by rays; triangles state their own
        }
        list.stats.lacks_triangles = decision.lacks_triangles;
        list.stats.exceeded_by_rounding = decision.exceeded_by_rounding;
    }
    decision.choice.tiles_as_triangles = static_cast<int>(list.tiles.size());
    decision.choice.tiles_by_rays = tiles - decision.choice.tiles_as_triangles;
    if (decision.choice.typical) {
        list.stats.tiles_unproven += decision.choice.tiles_by_rays;
    }
    list.stats.choice = decision.choice;
}

} // namespace reljef::view
