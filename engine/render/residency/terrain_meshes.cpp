#include "engine/render/residency/terrain_meshes.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "engine/core/parallel_for.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::render {
namespace {

// Frames that unused tiles stay. Most tiles of a stream are ancestors of the drawn ones.
constexpr std::uint64_t kept_frames_loaded = 8;
constexpr std::uint64_t kept_frames_cut = 32;
constexpr std::uint64_t kept_always = std::numeric_limits<std::uint64_t>::max();

// Tiles per batch; limits the memory for vertices that are not yet uploaded.
constexpr std::size_t batch_tiles = 8;

view::GridMesh whole_mesh(const view::TileDraw& draw) {
    const view::TileSurface surface = view::surface_of(draw);
    const double flat_height = terrain::reference_height(draw.terrain->surface->heightfield());
    return draw.flat ? view::flat_mesh(surface.placement, surface.samples, flat_height)
                     : view::full_mesh(surface.heightfield, surface.placement, surface.samples);
}

// Of the tile's vertices, pixels. What is hidden by nearer ground shows where the triangles of that
// ground are off by more than the bound.
double tile_error(const view::TileDraw& draw, const view::Coarseness& coarseness,
                  const view::Coarsening& coarsening) {
    const auto* const bound = std::get_if<terrain::ErrorView>(&coarseness);
    const bool is_beyond =
        bound != nullptr && (coarsening.min_size > 0 || coarsening.min_error > bound->max_error ||
                             bound->exceeded_by_rounding);
    return is_beyond ? std::max(draw.error, draw.error_with_hidden) : draw.error;
}

std::size_t triangle_count(const view::CutMesh& mesh) {
    std::size_t indices = 0;
    for (const terrain::Triangulation& part : mesh.parts) {
        indices += part.indices.size();
    }
    return indices / 3;
}

// Tiles in memory have one border with their neighbours; flat ones, too.
bool has_seams(const view::TileDraw& draw) {
    return !draw.tile->borrows && !draw.flat;
}

const view::Coarseness& coarseness_of(const view::DrawList& list, const view::TileDraw& draw) {
    const auto& coarseness = list.terrains[draw.node].coarseness;
    check(coarseness.has_value(), "a coarse terrain of the list was expected");
    return *coarseness;
}

} // namespace

TerrainMeshes::TileBisection::TileBisection(std::shared_ptr<const scene::TerrainTile> of)
    : tile(std::move(of)),
      bisection(tile->heightfield, *tile->placement, {.threads = 1, .stop = {}, .progress = {}}) {}

bool TerrainMeshes::Entry::is_held_elsewhere() const {
    return owner.use_count() > (bisection != nullptr ? 1 : 0);
}

const terrain::Bisection&
TerrainMeshes::Entry::own_bisection(const std::shared_ptr<const scene::TerrainTile>& tile) {
    if (bisection == nullptr) {
        bisection = std::make_unique<const TileBisection>(tile);
    }
    return bisection->bisection;
}

std::vector<view::SliverView::Triangles> TerrainMeshes::triangles_of(const Entry& entry) {
    std::vector<view::SliverView::Triangles> parts;
    for (std::size_t i = 0; i < entry.last.parts.size(); ++i) {
        const terrain::Triangulation& part = entry.last.parts[i];
        parts.push_back({entry.last.vertices[i], part.indices, &part});
    }
    for (const view::SeamPart& part : entry.seam_parts) {
        parts.push_back({part.vertices, part.indices, nullptr});
    }
    return parts;
}

TerrainMeshes::Key TerrainMeshes::key_of(const view::TileDraw& draw) {
    if (!draw.tile->borrows) {
        return {draw.terrain->stream.get(), draw.flat, draw.coarse, nullptr, std::nullopt};
    }
    const void* const source = draw.terrain->surface.get();
    return draw.coarse ? Key{source, draw.flat, true, draw.terrain,
                             draw.terrain->material.technique.parameters}
                       : Key{source, draw.flat, false, nullptr, std::nullopt};
}

TerrainMeshes::Group& TerrainMeshes::group_of(const view::TileDraw& draw) {
    const scene::TerrainNode& terrain = *draw.terrain;
    const bool borrows = draw.tile->borrows;
    const std::shared_ptr<const void> owner = borrows ? std::shared_ptr<const void>(terrain.surface)
                                                      : std::shared_ptr<const void>(terrain.stream);
    Group& group = groups_[key_of(draw)];
    if (group.owner.lock() != owner) {
        group = {};
        group.owner = owner;
        group.kept_frames = !borrows      ? kept_frames_loaded
                            : draw.coarse ? kept_frames_cut
                                          : kept_always;
    }
    return group;
}

TerrainMeshes::Entry& TerrainMeshes::entry_of(Group& group, const view::TileDraw& draw) {
    Entry& entry = group.tiles[draw.tile->id];
    if (entry.owner.lock() != draw.tile) {
        entry = {};
        entry.owner = draw.tile;
    }
    entry.drawn = frame_;
    return entry;
}

void TerrainMeshes::forget_unused() {
    std::erase_if(bisections_, [](const auto& entry) { return entry.second.owner.expired(); });
    for (auto& [key, group] : groups_) {
        std::erase_if(group.tiles, [&, kept = group.kept_frames](const auto& entry) {
            return !entry.second.is_held_elsewhere() || frame_ - entry.second.drawn > kept;
        });
    }
    std::erase_if(groups_, [](const auto& entry) {
        return entry.second.owner.expired() || entry.second.tiles.empty();
    });
}

Result<void> TerrainMeshes::prepare(const view::DrawList& list, view::FrameStats& stats) {
    ++frame_;
    drawn_.clear();
    drawn_.reserve(list.tiles.size());
    std::vector<std::pair<Group*, Draws>> groups; // as they appear in the list
    for (const view::TileDraw& draw : list.tiles) {
        Group& group = group_of(draw);
        drawn_.push_back(&entry_of(group, draw));
        auto found = std::find_if(groups.begin(), groups.end(),
                                  [&](const auto& entry) { return entry.first == &group; });
        if (found == groups.end()) {
            found = groups.insert(groups.end(), {&group, {}});
        }
        found->second.push_back(&draw);
    }
    forget_unused();
    for (const auto& [group, draws] : groups) {
        auto done = draws.front()->coarse ? cut(list, *group, draws, stats)
                                          : upload_whole(*group, draws, stats);
        if (done && has_seams(*draws.front())) {
            done = close_seams(list, *group, draws, stats);
        }
        if (done && draws.front()->coarse &&
            std::holds_alternative<terrain::ErrorView>(group->coarseness)) {
            done = part_slivers(list, *group, draws, stats);
        }
        if (!done) {
            return done;
        }
    }
    return {};
}

Result<void> TerrainMeshes::upload_whole(Group& group, const Draws& draws,
                                         view::FrameStats& stats) {
    std::vector<Outdated> outdated;
    for (const view::TileDraw* const draw : draws) {
        Entry& entry = group.tiles.at(draw->tile->id);
        if (!entry.meshes.empty()) {
            ++stats.skipped.uploads_unchanged;
        } else {
            outdated.push_back({draw, &entry});
        }
    }
    for (std::size_t i = 0; i < outdated.size(); i += batch_tiles) {
        const auto part = std::span(outdated).subspan(i);
        if (auto done = upload(part.first(std::min(part.size(), batch_tiles)), stats); !done) {
            return done;
        }
    }
    return {};
}

Result<void> TerrainMeshes::upload(std::span<const Outdated> tiles, view::FrameStats& stats) {
    std::vector<view::GridMesh> grids(tiles.size());
    parallel_for(static_cast<int>(tiles.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const auto& [draw, entry] = tiles[at];
        grids[at] = whole_mesh(*draw);
        if (has_seams(*draw)) {
            entry->border = view::border_of_samples(view::surface_of(*draw));
        }
    });
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        auto mesh = grids_.upload(grids[i], stats);
        if (!mesh) {
            return mesh.error();
        }
        std::vector<TileMesh> meshes;
        meshes.push_back({std::move(*mesh), {}, {}, {}});
        replace_meshes(*tiles[i].entry, std::move(meshes));
    }
    return {};
}

// Keeps the seams.
void TerrainMeshes::replace_meshes(Entry& entry, std::vector<TileMesh> meshes) {
    std::move(entry.meshes.end() - static_cast<std::ptrdiff_t>(entry.seam_count),
              entry.meshes.end(), std::back_inserter(meshes));
    entry.meshes = std::move(meshes);
    entry.shape = ++shapes_;
    entry.slivers_version = 0;
}

// Forgets what fitted another view, or other errors of the tiles.
void TerrainMeshes::note_errors(const view::Coarseness& coarseness, const Draws& draws,
                                Group& group) {
    std::vector<std::tuple<terrain::TreeTile, double, double>> errors;
    errors.reserve(draws.size());
    for (const view::TileDraw* const draw : draws) {
        errors.emplace_back(draw->tile->id, draw->error, draw->triangle_error);
    }
    const std::size_t max_triangles = draws.front()->terrain->max_triangles;
    if (group.errors != errors || group.max_triangles != max_triangles) {
        group.errors = std::move(errors);
        group.max_triangles = max_triangles;
        group.coarsening = {};
    }
    if (group.version == 0 || group.coarseness != coarseness) {
        group.coarseness = coarseness;
        group.coarsening = {};
        ++group.version;
    }
}

// The tiles that need other triangles; counts those of the others.
std::vector<TerrainMeshes::Outdated> TerrainMeshes::outdated_cuts(Group& group, const Draws& draws,
                                                                  terrain::TriangleBudget& budget) {
    std::vector<Outdated> outdated;
    for (const view::TileDraw* const draw : draws) {
        Entry& entry = group.tiles.at(draw->tile->id);
        if (entry.version == group.version && entry.error == draw->error &&
            entry.triangle_error == draw->triangle_error && entry.coarsening == group.coarsening) {
            budget.add(entry.triangles);
        } else {
            outdated.push_back({draw, &entry});
        }
    }
    return outdated;
}

void TerrainMeshes::forget_cuts() {
    for (auto& [key, group] : groups_) {
        for (auto& [id, entry] : group.tiles) {
            entry.version = 0;
        }
    }
}

// `shared`: the bisection of a terrain in memory.
view::CutOptions TerrainMeshes::cut_options(const Group& group, const Outdated& tile,
                                            const terrain::Bisection* shared) {
    const auto& [draw, entry] = tile;
    const bool has_own =
        shared == nullptr && std::holds_alternative<terrain::ErrorView>(group.coarseness);
    return {has_own ? &entry->own_bisection(draw->tile) : shared,
            tile_error(*draw, group.coarseness, group.coarsening), draw->triangle_error,
            group.coarsening, nullptr};
}

// The triangles of the tiles that need others. Empty if all tiles together have too many.
std::optional<TerrainMeshes::Cuts> TerrainMeshes::try_to_cut(Group& group, const Draws& draws) {
    const bool by_error = std::holds_alternative<terrain::ErrorView>(group.coarseness);
    const bool is_limited = by_error && !view::is_coarsest(group.coarsening);
    terrain::TriangleBudget budget(group.max_triangles);
    Cuts cuts;
    cuts.tiles = outdated_cuts(group, draws, budget);
    const terrain::Bisection* const shared =
        by_error && !cuts.tiles.empty() ? shared_bisection(*draws.front()) : nullptr;
    cuts.meshes.resize(cuts.tiles.size());
    cuts.borders.resize(cuts.tiles.size());
    parallel_for(static_cast<int>(cuts.tiles.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const auto& [draw, entry] = cuts.tiles[at];
        const view::TileSurface surface = view::surface_of(*draw);
        view::CutOptions options = cut_options(group, cuts.tiles[at], shared);
        options.budget = is_limited ? &budget : nullptr;
        cuts.meshes[at] = view::cut_tile(group.coarseness, surface, options, entry->last);
        if (has_seams(*draw)) {
            cuts.borders[at] = view::border_of(surface, cuts.meshes[at]);
        }
    });
    return is_limited && budget.is_exceeded() ? std::nullopt : std::make_optional(std::move(cuts));
}

// The same with the least coarsening that fits the terrain's number of triangles.
TerrainMeshes::Cuts TerrainMeshes::cut_within_budget(Group& group, const Draws& draws) {
    auto cuts = try_to_cut(group, draws);
    while (!cuts) {
        group.coarsening =
            view::coarser(std::get<terrain::ErrorView>(group.coarseness), group.coarsening);
        cuts = try_to_cut(group, draws);
    }
    return std::move(*cuts);
}

Result<void> TerrainMeshes::keep(Cuts cuts, const Group& group, view::FrameStats& stats) {
    stats.tiles_cut += static_cast<int>(cuts.tiles.size());
    for (std::size_t i = 0; i < cuts.tiles.size(); ++i) {
        const auto& [draw, entry] = cuts.tiles[i];
        view::CutMesh& mesh = cuts.meshes[i];
        const double kept_error = mesh.error;
        if (mesh.parts.empty()) {
            ++stats.skipped.uploads_unchanged;
        } else {
            auto meshes = tile_meshes(mesh, stats);
            if (!meshes) {
                return meshes.error();
            }
            replace_meshes(*entry, std::move(*meshes));
            entry->border = std::move(cuts.borders[i]);
            entry->triangles = triangle_count(mesh);
            entry->last = std::move(mesh);
        }
        entry->version = group.version;
        entry->error = draw->error;
        entry->triangle_error = draw->triangle_error;
        entry->coarsening = group.coarsening;
        entry->kept_error = kept_error;
        entry->slivers_version = 0;
    }
    return {};
}

Result<void> TerrainMeshes::cut(const view::DrawList& list, Group& group, const Draws& draws,
                                view::FrameStats& stats) {
    note_errors(coarseness_of(list, *draws.front()), draws, group);
    Cuts cuts = cut_within_budget(group, draws);
    const auto unchanged = static_cast<int>(draws.size() - cuts.tiles.size());
    stats.skipped.cuts_unchanged += unchanged;
    stats.skipped.uploads_unchanged += unchanged;
    if (auto done = keep(std::move(cuts), group, stats); !done) {
        return done;
    }
    stats.lacks_triangles = stats.lacks_triangles || group.coarsening != view::Coarsening{};
    if (const auto* const bound = std::get_if<terrain::ErrorView>(&group.coarseness)) {
        stats.exceeded_by_rounding = stats.exceeded_by_rounding || bound->exceeded_by_rounding;
        add_kept_errors(group, draws, stats);
    }
    return {};
}

// The tiles whose seams are not those of their triangles and of those beside them.
std::vector<TerrainMeshes::Unseamed> TerrainMeshes::unseamed(const view::DrawList& list,
                                                             Group& group, const Draws& draws) {
    std::vector<terrain::TreeTile> tiles;
    tiles.reserve(draws.size());
    for (const view::TileDraw* const draw : draws) {
        tiles.push_back(draw->tile->id);
    }
    const view::DrawnTiles drawn(draws.front()->terrain->stream->tree(), tiles);
    std::vector<Unseamed> changed;
    for (const view::TileDraw* const draw : draws) {
        Entry& entry = group.tiles.at(draw->tile->id);
        std::vector<Seam> seams;
        for (const view::OpenSide& open : drawn.open_sides(draw->tile->id)) {
            Seam& seam = seams.emplace_back(Seam{open, 0, {}});
            if (open.neighbour) {
                seam.neighbour_shape = group.tiles.at(*open.neighbour).shape;
            } else {
                seam.error = view::border_error(list, *draw);
            }
        }
        if (entry.seamed_shape != entry.shape || entry.seams != seams) {
            changed.push_back({draw, &entry, std::move(seams)});
        }
    }
    return changed;
}

Result<void> TerrainMeshes::close_seams(const view::DrawList& list, Group& group,
                                        const Draws& draws, view::FrameStats& stats) {
    std::vector<Unseamed> tiles = unseamed(list, group, draws);
    std::vector<std::vector<view::SeamPart>> parts(tiles.size());
    parallel_for(static_cast<int>(tiles.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const view::TileSurface surface = view::surface_of(*tiles[at].draw);
        view::SeamMaker maker(surface, tiles[at].entry->border);
        for (const Seam& seam : tiles[at].seams) {
            if (seam.open.neighbour) {
                maker.join(seam.open, group.tiles.at(*seam.open.neighbour).border);
            } else {
                maker.hang(seam.open, seam.error);
            }
        }
        parts[at] = maker.take();
    });
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        Entry& entry = *tiles[i].entry;
        entry.meshes.resize(entry.meshes.size() - entry.seam_count);
        entry.seam_count = 0;
        for (const view::SeamPart& part : parts[i]) {
            auto mesh = tile_mesh(part.vertices, part.indices, stats);
            if (!mesh) {
                return mesh.error();
            }
            entry.meshes.push_back(std::move(*mesh));
            ++entry.seam_count;
        }
        entry.seamed_shape = entry.shape;
        entry.seams = std::move(tiles[i].seams);
        entry.seam_parts = std::move(parts[i]);
        entry.slivers_version = 0;
    }
    return {};
}

// Parts of a large picture have one version.
void TerrainMeshes::forget_slivers_of_others(Group& group, const PictureView& picture) {
    if (group.slivers_of != picture) {
        for (auto& [id, entry] : group.tiles) {
            entry.slivers_version = 0;
        }
        group.slivers_of = picture;
    }
}

// Draws the slivers of the view apart.
Result<void> TerrainMeshes::part_slivers(const view::DrawList& list, Group& group,
                                         const Draws& draws, view::FrameStats& stats) {
    std::vector<Outdated> tiles;
    forget_slivers_of_others(group, {list.camera, list.size});
    for (const view::TileDraw* const draw : draws) {
        Entry& entry = group.tiles.at(draw->tile->id);
        if (entry.slivers_version != group.version) {
            tiles.push_back({draw, &entry});
        }
    }
    if (tiles.empty()) {
        return {};
    }
    const terrain::Bisection* const shared = shared_bisection(*draws.front());
    std::vector<std::vector<view::Slivers>> slivers(tiles.size());
    parallel_for(static_cast<int>(tiles.size()), [&](int i) {
        const Outdated& tile = tiles[static_cast<std::size_t>(i)];
        const view::SliverView view(list, *tile.draw, cut_options(group, tile, shared));
        for (const auto& part : triangles_of(*tile.entry)) {
            slivers[static_cast<std::size_t>(i)].push_back(view.slivers(part));
        }
    });
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        Entry& entry = *tiles[i].entry;
        const auto parts = triangles_of(entry);
        for (std::size_t j = 0; j < parts.size(); ++j) {
            auto done = set_slivers(entry.meshes[j], parts[j], std::move(slivers[i][j]), stats);
            if (!done) {
                return done;
            }
        }
        entry.slivers_version = group.version;
    }
    return {};
}

void TerrainMeshes::add_kept_errors(const Group& group, const Draws& draws,
                                    view::FrameStats& stats) {
    for (const view::TileDraw* const draw : draws) {
        if (draw->is_proven()) {
            const double error = group.tiles.at(draw->tile->id).kept_error;
            stats.kept_error = std::max(stats.kept_error.value_or(0.0), error);
        }
    }
}

// Null: each tile has its own.
const terrain::Bisection* TerrainMeshes::shared_bisection(const view::TileDraw& draw) {
    return draw.tile->borrows ? &bisection_of(*draw.terrain) : nullptr;
}

const terrain::Bisection& TerrainMeshes::bisection_of(const scene::TerrainNode& terrain) {
    if (terrain.bisection != nullptr) {
        return *terrain.bisection;
    }
    const auto [entry, is_new] = bisections_.try_emplace(terrain.surface.get());
    if (is_new) {
        entry->second = {terrain.surface,
                         std::make_unique<const terrain::Bisection>(terrain.surface->heightfield(),
                                                                    terrain.surface->placement())};
    }
    return *entry->second.bisection;
}

} // namespace reljef::render
