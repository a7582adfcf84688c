#include "engine/render/residency/terrain_meshes.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/core/parallel_for.h"
#include "engine/scene/tile_stream.h"

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

Result<std::vector<ResidentMesh>> uploaded(const view::CutMesh& cut, view::FrameStats& stats) {
    std::vector<ResidentMesh> meshes;
    for (std::size_t i = 0; i < cut.parts.size(); ++i) {
        auto mesh =
            with_indices(upload_vertices(cut.vertices[i], stats), cut.parts[i].indices, stats);
        if (!mesh) {
            return mesh.error();
        }
        meshes.push_back(std::move(*mesh));
    }
    return meshes;
}

const view::Coarseness& coarseness_of(const view::DrawList& list,
                                      const scene::TerrainNode& terrain) {
    const auto found =
        std::find_if(list.coarse_terrains.begin(), list.coarse_terrains.end(),
                     [&](const view::CoarseTerrain& entry) { return entry.terrain == &terrain; });
    check(found != list.coarse_terrains.end(), "a coarse terrain of the list was expected");
    return found->coarseness;
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
                                          : upload_whole(list, *group, draws, stats);
        if (!done) {
            return done;
        }
    }
    return {};
}

Result<void> TerrainMeshes::upload_whole(const view::DrawList& list, Group& group,
                                         const Draws& draws, view::FrameStats& stats) {
    std::vector<Outdated> outdated;
    for (const view::TileDraw* const draw : draws) {
        Entry& entry = group.tiles.at(draw->tile->id);
        const terrain::Skirt skirt = view::skirt_of(list, *draw);
        if (!entry.meshes.empty() && entry.skirt == skirt) {
            ++stats.skipped.uploads_unchanged;
        } else {
            outdated.push_back({draw, &entry, skirt});
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
    std::vector<view::CutMesh> skirts(tiles.size());
    parallel_for(static_cast<int>(tiles.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const Outdated& tile = tiles[at];
        if (tile.entry->meshes.empty()) {
            grids[at] = whole_mesh(*tile.draw);
        }
        skirts[at] = view::whole_skirt(view::surface_of(*tile.draw), tile.skirt);
    });
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        Entry& entry = *tiles[i].entry;
        if (entry.meshes.empty()) {
            auto mesh = grids_.upload(grids[i], stats);
            if (!mesh) {
                return mesh.error();
            }
            entry.meshes.push_back(std::move(*mesh));
        }
        auto walls = uploaded(skirts[i], stats);
        if (!walls) {
            return walls.error();
        }
        entry.meshes.resize(1);
        std::move(walls->begin(), walls->end(), std::back_inserter(entry.meshes));
        entry.skirt = tiles[i].skirt;
    }
    return {};
}

std::vector<TerrainMeshes::Outdated> TerrainMeshes::outdated_cuts(const view::DrawList& list,
                                                                  Group& group, const Draws& draws,
                                                                  view::FrameStats& stats) {
    std::vector<Outdated> outdated;
    for (const view::TileDraw* const draw : draws) {
        Entry& entry = group.tiles.at(draw->tile->id);
        const terrain::Skirt skirt = view::skirt_of(list, *draw);
        if (entry.version == group.version && entry.error == draw->error &&
            entry.triangle_error == draw->triangle_error && entry.skirt == skirt) {
            ++stats.skipped.cuts_unchanged;
            ++stats.skipped.uploads_unchanged;
        } else {
            outdated.push_back({draw, &entry, skirt});
        }
    }
    stats.tiles_cut += static_cast<int>(outdated.size());
    return outdated;
}

Result<void> TerrainMeshes::cut(const view::DrawList& list, Group& group, const Draws& draws,
                                view::FrameStats& stats) {
    const scene::TerrainNode& terrain = *draws.front()->terrain;
    const view::Coarseness& coarseness = coarseness_of(list, terrain);
    if (group.version == 0 || group.coarseness != coarseness) {
        group.coarseness = coarseness;
        ++group.version;
    }
    const std::vector<Outdated> outdated = outdated_cuts(list, group, draws, stats);
    const bool by_error = std::holds_alternative<terrain::ErrorView>(coarseness);
    const terrain::Bisection* const shared =
        by_error && draws.front()->tile->borrows && !outdated.empty() ? &bisection_of(terrain)
                                                                      : nullptr;
    std::vector<view::CutMesh> cuts(outdated.size());
    parallel_for(static_cast<int>(outdated.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const auto& [draw, entry, skirt] = outdated[at];
        const terrain::Bisection* const bisection =
            by_error && shared == nullptr ? &entry->own_bisection(draw->tile) : shared;
        cuts[at] =
            view::cut_tile(coarseness, view::surface_of(*draw),
                           {bisection, draw->error, draw->triangle_error, skirt}, entry->last);
    });
    for (std::size_t i = 0; i < outdated.size(); ++i) {
        const auto& [draw, entry, skirt] = outdated[i];
        entry->version = group.version;
        entry->error = draw->error;
        entry->triangle_error = draw->triangle_error;
        entry->skirt = skirt;
        entry->kept_error = cuts[i].error;
        if (cuts[i].parts.empty()) {
            ++stats.skipped.uploads_unchanged;
            continue;
        }
        auto meshes = uploaded(cuts[i], stats);
        if (!meshes) {
            return meshes.error();
        }
        entry->meshes = std::move(*meshes);
        entry->last = std::move(cuts[i]);
    }
    if (by_error) {
        add_kept_errors(group, draws, stats);
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
