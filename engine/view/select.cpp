#include "engine/view/select.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <variant>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/core/check.h"
#include "engine/core/nearest_first.h"
#include "engine/core/stopwatch.h"
#include "engine/scene/graph/terrain_base.h"
#include "engine/terrain/mesh/patch_mesh.h"
#include "engine/view/error_view.h"
#include "engine/view/grid_mesh.h"
#include "engine/view/occlusion.h"
#include "engine/view/relief_samples.h"
#include "engine/view/stream_view.h"
#include "engine/view/tile_selection.h"

namespace reljef::view {
namespace {

std::size_t triangle_count(const scene::TerrainNode& terrain, glm::ivec2 cells, bool flat) {
    const glm::ivec2 quads = flat ? flat_quads(terrain.surface->placement(), cells) : cells;
    return 2U * static_cast<std::size_t>(quads.x) * static_cast<std::size_t>(quads.y);
}

// Levels of an overview whose tiles are not loaded yet: it is not worth a bisection.
constexpr int overview_levels = terrain::max_patch_levels + 1;

// Empty if every sample is a vertex. `stands_in`: the terrain is drawn until tiles are loaded.
std::optional<Coarseness> coarseness_of(const scene::TerrainNode& terrain, const DrawList& list,
                                        const glm::dmat4& world_from_local, bool stands_in) {
    const scene::Technique& technique = terrain.material.technique;
    const bool is_exact = technique.id() == scene::TechniqueId::exact; // its rays bend too much
    if (!scene::draws_triangles(technique.id()) && !is_exact) {
        return std::nullopt;
    }
    const auto* const polygons = std::get_if<scene::Polygons>(&technique.parameters);
    const double error =
        is_exact ? scene::max_expected_error_of_rays : scene::triangle_bound(terrain, technique);
    const scene::TerrainSurface& surface = *terrain.surface;
    if (error > 0.0 && !stands_in) {
        terrain::ErrorView view =
            error_view(list.camera, list.size, world_from_local, surface.placement().kind(),
                       std::max(error, min_error));
        view.morph_from = polygons != nullptr && polygons->morph ? morph_from : 1.0;
        return view;
    }
    const int levels = error > 0.0 ? overview_levels : polygons->max_levels;
    if (levels == 1) {
        return std::nullopt;
    }
    const glm::dvec3 eye(glm::inverse(world_from_local) * glm::dvec4(list.camera.eye, 1.0));
    return terrain::patch_levels(surface.heightfield(), surface.placement(), eye, levels);
}

// The vector from the nearest point of a box.
glm::dvec3 away_from(glm::dvec3 point, const Box& box) {
    return point - glm::clamp(point, box.low, box.high);
}

bool is_flat(const scene::TerrainNode& terrain) {
    return scene::geometry_of(terrain.material.technique.id()) == scene::Geometry::flat;
}

bool is_on_ellipsoid(const scene::TerrainNode& terrain) {
    return terrain.surface->placement().kind() == terrain::PlacementKind::ellipsoid;
}

bool has_streamed_tiles(const scene::TerrainNode& terrain) {
    return terrain.stream != nullptr && scene::draws_tiles(terrain.material.technique);
}

// Share of the error bound, where memory leaves tiles too coarse for it; less for tiles with the
// largest error.
constexpr double share_of_triangles = 0.25;

// What a tile's error leaves of the bound for its triangles, pixels. `largest_error`: of all tiles.
double triangle_error(double bound, double error, double largest_error) {
    const double below_worst = largest_error + min_share_of_triangles * bound - error;
    return std::max(bound - error, std::min(share_of_triangles * bound, below_worst));
}

double largest_error(const TileSelection& selection) {
    double largest = 0.0;
    for (const TileSelection::Drawn& drawn : selection.drawn) {
        largest = std::max(largest, drawn.error);
    }
    return largest;
}

// The error bound of a terrain's triangles, pixels; 0: none.
double bound_of(const std::optional<Coarseness>& coarseness) {
    const auto* const view = coarseness ? std::get_if<terrain::ErrorView>(&*coarseness) : nullptr;
    return view != nullptr ? view->max_error : 0.0;
}

// The drawn tiles and loaded ones above them, the coarsest first.
std::vector<std::shared_ptr<const scene::TerrainTile>>
with_coarser(const scene::TerrainNode& terrain, std::span<const TileSelection::Drawn> drawn) {
    const scene::TileStream& stream = *terrain.stream;
    std::map<terrain::TreeTile, std::shared_ptr<const scene::TerrainTile>> coarser;
    const terrain::TreeTile root = stream.tree().root();
    coarser.emplace(root, stream.find(root));
    for (const TileSelection::Drawn& tile : drawn) {
        terrain::TreeTile above = tile.tile->id;
        while (above.level < root.level) {
            above = {above.level + 1, above.col / 2, above.row / 2};
            if (!coarser.contains(above)) {
                coarser.emplace(above, stream.find(above));
            }
        }
    }
    for (const TileSelection::Drawn& tile : drawn) {
        coarser.erase(tile.tile->id);
    }
    std::vector<std::shared_ptr<const scene::TerrainTile>> tiles;
    for (auto tile = coarser.rbegin(); tile != coarser.rend(); ++tile) {
        if (tile->second != nullptr && is_ready(terrain, *tile->second) &&
            tiles.size() + drawn.size() < max_relief_tiles) {
            tiles.push_back(tile->second);
        }
    }
    for (const TileSelection::Drawn& tile : drawn) {
        tiles.push_back(tile.tile);
    }
    std::stable_sort(tiles.begin(), tiles.end(),
                     [](const auto& a, const auto& b) { return b->id.level < a->id.level; });
    return tiles;
}

class Selector {
public:
    Selector(FrameView& frame, const Frustum& frustum, const SelectOptions& options,
             double mesh_bound)
        : list_(frame.list), requests_(frame.requests), frustum_(frustum), options_(options),
          mesh_bound_(mesh_bound) {}

    void add(const SeenNode& seen) {
        if (const auto* mesh = seen.node->get<scene::MeshNode>()) {
            add_mesh(*mesh, seen.world_from_local, seen.local_bounds);
        } else if (const auto* terrain = seen.node->get<scene::TerrainNode>()) {
            add_terrain(*terrain, seen.world_from_local);
        }
    }

    /// The tiles of all terrains, front to back.
    void order_tiles() {
        if (options_.front_to_back) {
            seen_ = nearest_first(std::move(seen_));
        }
        list_.tiles.reserve(seen_.size());
        for (const SeenTile& seen : seen_) {
            TileDraw& draw = draws_[seen.draw];
            draw.distance = std::sqrt(seen.distance);
            draw.detail = detail_of(*draw.terrain, draw.distance);
            list_.tiles.push_back(std::move(draw));
        }
    }

private:
    struct SeenTile {
        double distance = 0.0; // squared
        std::size_t draw = 0;
    };

    void add_terrain(const scene::TerrainNode& terrain, const glm::dmat4& world_from_local) {
        if (terrain.base != nullptr && scene::shows_heights(terrain.material.technique) &&
            !terrain.material.wireframe && !terrain.hides_overlay &&
            scene::may_show_base(*terrain.surface, world_from_local, list_.camera)) {
            list_.bases.push_back({terrain.base.get(), world_from_local, false, {}});
        }
        if (scene::searches_surface(terrain.material.technique.id())) {
            add_relief(terrain, world_from_local);
        } else if (!has_streamed_tiles(terrain) ||
                   !add_streamed(terrain, world_from_local,
                                 select_streamed(terrain, world_from_local))) {
            add_tiles(terrain, world_from_local);
        }
    }

    void add_mesh(const scene::MeshNode& mesh, const glm::dmat4& world_from_local,
                  const Box& local_bounds) {
        if (!options_.frustum || frustum_.may_see(transformed(world_from_local, local_bounds))) {
            MeshDraw draw =
                with_level({&mesh, world_from_local, true, local_bounds}, list_, mesh_bound_);
            count_level(draw);
            if (scene::is_seen_from_behind(mesh.material)) {
                list_.meshes.push_back(draw);
            }
            draw.from_behind = false;
            list_.meshes.push_back(draw);
        } else {
            list_.meshes_beside.push_back({&mesh, world_from_local, false, local_bounds});
            ++list_.stats.skipped.nodes_outside_frustum;
            list_.stats.skipped.triangles_outside_frustum += mesh.mesh->indices.size() / 3;
        }
    }

    void count_level(const MeshDraw& draw) {
        if (draw.level > 0) {
            list_.stats.mesh_error = std::max(list_.stats.mesh_error.value_or(0.0), draw.error);
            list_.stats.skipped.triangles_under_error +=
                (draw.mesh->mesh->indices.size() - drawn_mesh(draw)->indices.size()) / 3;
        }
    }

    void add_relief(const scene::TerrainNode& terrain, const glm::dmat4& world_from_local) {
        const Box bounds = transformed(world_from_local, terrain.surface->bounds());
        SurfaceSearch search{.technique = terrain.material.technique,
                             .distance = glm::length(away_from(list_.camera.eye, bounds))};
        bool is_seen = frustum_.may_see(bounds);
        std::optional<TileSelection> choice;
        if (has_streamed_tiles(terrain)) {
            choice = select_streamed(terrain, world_from_local);
            if (choice->has_root) {
                search.tiles = with_coarser(terrain, choice->drawn);
                is_seen = !choice->drawn.empty();
            } else if (needs_cones(terrain) && terrain.cones == nullptr) {
                add_tiles(terrain, world_from_local); // meanwhile
                return;
            }
        }
        if (!is_seen) {
            ++list_.stats.skipped.nodes_outside_frustum;
            return;
        }
        TerrainDraw draw{.terrain = &terrain,
                         .world_from_local = world_from_local,
                         .coarseness = {},
                         .search = std::move(search)};
        if (is_on_ellipsoid(terrain)) {
            add_on_ellipsoid(std::move(draw), std::move(choice));
        } else {
            add_rays(std::move(draw), choice);
        }
    }

    void add_rays(TerrainDraw draw, const std::optional<TileSelection>& choice) {
        SurfaceSearch& search = *draw.search;
        if (!search.tiles.empty() && search.technique.id() == scene::TechniqueId::exact) {
            const auto errors =
                error_of_ray_tiles(*draw.terrain, list_.camera, list_.size, draw.world_from_local,
                                   choice->drawn, search.tiles);
            search.tile_error = errors.proven;
            list_.stats.tiles_unproven += errors.unproven;
        } else if (search.tiles.empty() && !draw.terrain->surface->has_all_samples()) {
            list_.stats.tiles_unproven += static_cast<int>(draw.terrain->surface->tiles().size());
        }
        list_.terrains.push_back(std::move(draw));
    }

    void add_on_ellipsoid(TerrainDraw draw, std::optional<TileSelection> choice) {
        const scene::TerrainNode& terrain = *draw.terrain;
        const Box samples =
            choice && choice->has_root
                ? samples_of(terrain, choice->drawn)
                : seen_samples(*terrain.surface, frustum_.in_local(draw.world_from_local));
        if (samples.empty()) {
            ++list_.stats.skipped.nodes_outside_frustum;
            return;
        }
        draw.search->course =
            ray_course(list_.camera, list_.size, draw.world_from_local,
                       terrain.surface->placement(), samples, sun_rays(terrain, list_.sun));
        if (draw.search->course) {
            add_rays(std::move(draw), choice);
            return;
        }
        ++list_.stats.reliefs_as_triangles;
        if (!choice || !add_streamed(terrain, draw.world_from_local, std::move(*choice))) {
            add_tiles(terrain, draw.world_from_local);
        }
    }

    // Requests and counts the tiles of a stream.
    TileSelection select_streamed(const scene::TerrainNode& terrain,
                                  const glm::dmat4& world_from_local) {
        TileSelection choice = select_tiles(terrain, list_.camera, list_.size, world_from_local,
                                            {.keeps_hidden = !options_.occlusion});
        requests_.push_back({terrain.stream, std::move(choice.requested), std::move(choice.used),
                             needs_cones(terrain)});
        list_.stats.skipped.tiles_outside_frustum += choice.outside_frustum;
        list_.stats.skipped.tiles_occluded += choice.hidden_unread;
        list_.stats.tiles_missing += static_cast<int>(requests_.back().missing.size());
        return choice;
    }

    // False if the overview is drawn: before the root of the stream is loaded.
    bool add_streamed(const scene::TerrainNode& terrain, const glm::dmat4& world_from_local,
                      TileSelection choice) {
        TileDraw draw = draw_of(terrain);
        auto coarseness = coarseness_of(terrain, list_, world_from_local, false);
        const double bound = bound_of(coarseness);
        const double worst = largest_error(choice);
        const auto add = [&](TileSelection::Drawn& drawn, bool is_hidden) {
            draw.tile = std::move(drawn.tile);
            draw.error = drawn.error;
            draw.error_with_hidden = drawn.error_with_hidden;
            draw.triangle_error = bound > 0.0 ? triangle_error(bound, drawn.error, worst) : 0.0;
            draw.is_hidden = is_hidden;
            draw.coarse = coarseness && !is_hidden;
            list_.stats.tiles_unproven += draw.is_proven() || is_hidden ? 0 : 1;
            see(draw, drawn.distance * drawn.distance);
        };
        for (TileSelection::Drawn& drawn : choice.drawn) {
            add(drawn, false);
        }
        for (TileSelection::Drawn& hidden : choice.hidden) {
            add(hidden, true);
        }
        if (choice.has_root) {
            add_entry(terrain, world_from_local, std::move(coarseness));
        }
        return choice.has_root;
    }

    void add_tiles(const scene::TerrainNode& terrain, const glm::dmat4& world_from_local) {
        const auto& tiles = terrain.surface->tiles();
        const Frustum frustum = frustum_.in_local(world_from_local);
        const std::size_t before = seen_.size();
        auto coarseness =
            coarseness_of(terrain, list_, world_from_local, terrain.stream != nullptr);
        TileDraw draw = draw_of(terrain);
        draw.coarse = coarseness.has_value();
        draw.triangle_error = bound_of(coarseness);
        const bool is_only_moved = glm::dmat3(world_from_local) == glm::dmat3(1.0);
        const glm::dvec3 eye =
            list_.camera.eye - (is_only_moved ? glm::dvec3(world_from_local[3]) : glm::dvec3(0.0));
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            const Box& bounds = draw.flat ? terrain.surface->flat_bounds()[i] : tiles[i]->bounds;
            if (!options_.frustum || frustum.may_see(bounds)) {
                const glm::dvec3 away =
                    away_from(eye, is_only_moved ? bounds : transformed(world_from_local, bounds));
                draw.tile = tiles[i];
                list_.stats.tiles_unproven += draw.is_proven() ? 0 : 1;
                see(draw, glm::dot(away, away));
            } else {
                ++list_.stats.skipped.tiles_outside_frustum;
                list_.stats.skipped.triangles_outside_frustum +=
                    triangle_count(terrain, tiles[i]->cells, draw.flat);
            }
        }
        if (seen_.size() == before) {
            ++list_.stats.skipped.nodes_outside_frustum;
            return;
        }
        add_entry(terrain, world_from_local, std::move(coarseness));
    }

    void add_entry(const scene::TerrainNode& terrain, const glm::dmat4& world_from_local,
                   std::optional<Coarseness> coarseness) {
        list_.terrains.push_back({.terrain = &terrain,
                                  .world_from_local = world_from_local,
                                  .coarseness = std::move(coarseness)});
    }

    // A tile of the next terrain.
    TileDraw draw_of(const scene::TerrainNode& terrain) {
        TileDraw draw;
        draw.terrain = &terrain;
        draw.node = list_.terrains.size();
        draw.flat = is_flat(terrain);
        return draw;
    }

    void see(const TileDraw& draw, double squared_distance) {
        seen_.push_back({squared_distance, draws_.size()});
        draws_.push_back(draw);
    }

    // Counts details that are too far away to be visible.
    DetailLevel detail_of(const scene::TerrainNode& terrain, double distance) {
        const DetailLevel seen = seen_detail(terrain, list_.camera, list_.size, distance);
        const bool is_skipped = terrain.detail != nullptr && seen == DetailLevel::none;
        list_.stats.skipped.details_too_small += is_skipped ? 1 : 0;
        return seen;
    }

    DrawList& list_;
    std::vector<TileRequests>& requests_;
    const Frustum& frustum_;
    const SelectOptions& options_;
    double mesh_bound_; // pixels; 0: none
    std::vector<SeenTile> seen_;
    std::vector<TileDraw> draws_;
};

// North and up are those of the first terrain.
std::optional<scene::SeenSky> picture_of_sky(const SceneView& view) {
    if (!view.sky() || view.sky()->picture == nullptr) {
        return std::nullopt;
    }
    const auto& nodes = view.nodes();
    const auto first = std::find_if(nodes.begin(), nodes.end(), [](const SeenNode& seen) {
        return seen.node->get<scene::TerrainNode>() != nullptr;
    });
    const glm::dmat3 axes =
        first == nodes.end()
            ? glm::dmat3(1.0)
            : scene::ground_axes(first->node->get<scene::TerrainNode>()->surface->placement(),
                                 first->world_from_local, view.camera().eye);
    return scene::seen_sky(*view.sky(), view.camera(), view.size(), axes);
}

bool hides_overlay(const SceneView& view) {
    return std::ranges::any_of(view.nodes(), [](const SeenNode& seen) {
        const auto* const terrain = seen.node->get<scene::TerrainNode>();
        return terrain != nullptr && terrain->hides_overlay;
    });
}

} // namespace

FrameView select(const scene::Scene& scene, glm::ivec2 size, const SelectOptions& options) {
    return select(SceneView(scene, size), options);
}

FrameView select(const SceneView& view, const SelectOptions& options) {
    FrameView frame;
    DrawList& list = frame.list;
    list.camera = view.camera();
    list.size = view.size();
    list.sun = view.sun();
    list.sky = view.sky();
    list.sky_picture = picture_of_sky(view);
    list.eye_dome = hides_overlay(view) ? 0.0 : view.eye_dome();
    if (list.camera.projection == scene::ProjectionKind::orthographic) {
        list.camera = scene::with_fitted_depth(list.camera, view.bounds());
    }
    const Frustum frustum(scene::clip_from_world(list.camera, list.size));
    const Frustum of_whole(scene::clip_from_world(scene::camera_of_whole(list.camera, list.size),
                                                  scene::whole_picture(list.camera, list.size)));
    list.point_lights =
        seen_point_lights(view.point_lights(), list.camera, of_whole, list.stats.skipped);
    Selector selector(frame, frustum, options, view.error_bound());
    for (const SeenNode& seen : view.nodes()) {
        selector.add(seen);
    }
    selector.order_tiles();
    list.stats.nodes = view.node_count();
    list.stats.skipped.invisible_nodes = view.node_count() - view.visible_count();
    list.stats.skipped.sky = list.sky ? 0 : 1;
    const auto drop_hidden = [&] {
        if (options.occlusion) {
            drop_occluded(list);
        }
    };
    if (options.refine) {
        options.refine(list, drop_hidden);
    } else {
        drop_hidden();
    }
    return frame;
}

std::vector<TileRequests> tile_requests(const scene::Scene& scene, const scene::Camera& camera,
                                        glm::ivec2 size) {
    std::vector<TileRequests> requests;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& transform) {
        const auto* terrain = node.get<scene::TerrainNode>();
        if (terrain != nullptr && has_streamed_tiles(*terrain)) {
            TileSelection choice = select_tiles(*terrain, camera, size, transform);
            requests.push_back({terrain->stream, std::move(choice.requested),
                                std::move(choice.used), needs_cones(*terrain)});
        }
    });
    return requests;
}

const FrameView& FrameSelector::select(const scene::Scene& scene, glm::ivec2 size) {
    const Stopwatch watch;
    const bool has_changed = view_.look(scene, size);
    if (has_changed || !frame_ || selects_always_) {
        frame_ = view::select(view_, options_);
        ++count_;
        milliseconds_ = watch.milliseconds();
    }
    return *frame_;
}

const FrameView& FrameSelector::selected() const {
    check(frame_.has_value(), "a selected frame was expected");
    return *frame_;
}

void FrameSelector::forget() {
    view_ = {};
    frame_.reset();
}

} // namespace reljef::view
