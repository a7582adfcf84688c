#include "engine/render/residency/terrain_meshes.h"

#include <algorithm>
#include <cmath>
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

struct PlacedVertex {
    glm::dvec3 place; // local metres
    float height;     // true metres
};

PlacedVertex placed(const view::TileDraw& draw, glm::ivec2 vertex) {
    const scene::TerrainTile& tile = *draw.tile;
    if (draw.flat) {
        const double height = terrain::reference_height(draw.terrain->surface->heightfield());
        return {draw.terrain->stream->maker().place(tile.id, vertex, height),
                static_cast<float>(height)};
    }
    return {tile.place(vertex), tile.heightfield.heights(vertex.x, vertex.y)};
}

std::set<terrain::TreeTile> tiles_of(const std::vector<terrain::EdgeMove>& moves) {
    std::set<terrain::TreeTile> tiles;
    for (const terrain::EdgeMove& move : moves) {
        tiles.insert(move.to.tile);
    }
    return tiles;
}

// On a global terrain sample columns repeat: the one nearest to `place`.
glm::dvec2 nearest_turn(const scene::TileBuilder& maker, glm::dvec2 sample, glm::dvec2 place) {
    if (maker.tree().wraps_longitude()) {
        const terrain::TreeTile root = maker.tree().root();
        const double turn = maker.sample(root, maker.tree().cells(root)).x - maker.first(root).x;
        sample.x -= turn * std::round((sample.x - place.x) / turn);
    }
    return sample;
}

view::GridMesh loaded_mesh(const view::TileDraw& draw, const std::vector<terrain::EdgeMove>& moves,
                           const DrawnById& drawn) {
    const scene::TerrainTile& tile = *draw.tile;
    const scene::TileBuilder& maker = draw.terrain->stream->maker();
    const glm::dvec2 first = maker.first(tile.id);
    view::GridMesh mesh{tile.cells.x, tile.cells.y, {}};
    const auto vertex_of = [&](const view::TileDraw& from, glm::ivec2 vertex, glm::ivec2 own) {
        const PlacedVertex at = placed(from, vertex);
        const glm::dvec2 sample =
            nearest_turn(maker, maker.sample(from.tile->id, vertex), maker.sample(tile.id, own));
        return view::grid_vertex(at.place, at.height, sample - first);
    };
    mesh.vertices.reserve(tile.normals.size());
    for (int row = 0; row <= tile.cells.y; ++row) {
        for (int col = 0; col <= tile.cells.x; ++col) {
            mesh.vertices.push_back(vertex_of(draw, {col, row}, {col, row}));
        }
    }
    for (const terrain::EdgeMove& move : moves) {
        const int index = move.vertex.y * (tile.cells.x + 1) + move.vertex.x;
        mesh.vertices[static_cast<std::size_t>(index)] =
            vertex_of(*drawn.at(move.to.tile), move.to.vertex, move.vertex);
    }
    return mesh;
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

view::GridMesh tile_mesh(const view::TileDraw& draw, const std::vector<terrain::EdgeMove>& moves,
                         const DrawnById& drawn) {
    if (!draw.tile->borrows) {
        return loaded_mesh(draw, moves, drawn);
    }
    const scene::TerrainSurface& surface = *draw.terrain->surface;
    const terrain::Tile samples = scene::samples_of(*draw.tile);
    return draw.flat ? view::flat_mesh(surface.placement(), samples,
                                       terrain::reference_height(surface.heightfield()))
                     : view::full_mesh(surface.heightfield(), surface.placement(), samples);
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
        entry.since = frame_;
    }
    entry.drawn = frame_;
    return entry;
}

void TerrainMeshes::forget_unused() {
    std::erase_if(bisections_, [](const auto& entry) { return entry.second.owner.expired(); });
    for (auto& [key, group] : groups_) {
        std::erase_if(group.tiles, [&, kept = group.kept_frames](const auto& entry) {
            return entry.second.owner.expired() || frame_ - entry.second.drawn > kept;
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
        if (auto done = prepare_group(list, *group, draws, stats); !done) {
            return done;
        }
    }
    return {};
}

Result<void> TerrainMeshes::prepare_group(const view::DrawList& list, Group& group,
                                          const Draws& draws, view::FrameStats& stats) {
    const view::TileDraw& first = *draws.front();
    if (first.tile->borrows && first.coarse) {
        return cut_in_memory(list, group, draws, stats);
    }
    DrawnById drawn;
    std::set<terrain::TreeTile> beside; // tiles that meet
    for (const view::TileDraw* const draw : draws) {
        drawn.emplace(draw->tile->id, draw);
        if (!draw->tile->borrows && !draw->is_hidden) {
            beside.insert(draw->tile->id);
        }
    }
    if (!first.tile->borrows && !(group.cover && group.cover->tiles.tiles() == beside)) {
        const terrain::TileTree& tree = first.terrain->stream->tree();
        group.cover.emplace(Cover{terrain::DrawnTiles(tree, std::move(beside))});
    }
    if (auto done = prepare_vertices(group, drawn, stats); !done) {
        return done;
    }
    return first.coarse ? cut_loaded(list, group, drawn, stats) : Result<void>();
}

Result<void> TerrainMeshes::prepare_vertices(Group& group, const DrawnById& drawn,
                                             view::FrameStats& stats) {
    static const std::vector<terrain::EdgeMove> none;
    std::vector<ChangedMesh> changed;
    for (const auto& [id, draw] : drawn) {
        const bool meets = group.cover && !draw->is_hidden;
        const std::vector<terrain::EdgeMove>& moves = meets ? group.cover->tiles.moves(id) : none;
        const Entry& entry = group.tiles.at(id);
        const bool is_there = draw->coarse ? !entry.vertices.empty() : entry.is_whole;
        if (is_there && is_moved_as(group, entry, moves)) {
            ++stats.skipped.uploads_unchanged;
        } else {
            changed.push_back({draw, &moves});
        }
    }
    for (std::size_t i = 0; i < changed.size(); i += batch_tiles) {
        const auto part = std::span(changed).subspan(i);
        const std::size_t count = std::min(part.size(), batch_tiles);
        if (auto done = upload_all(group, part.first(count), drawn, stats); !done) {
            return done;
        }
    }
    return {};
}

// To the same vertices, whose tiles are not newer than the upload.
bool TerrainMeshes::is_moved_as(const Group& group, const Entry& entry,
                                const std::vector<terrain::EdgeMove>& moves) {
    const auto is_newer = [&](terrain::TreeTile tile) {
        return group.tiles.at(tile).since > entry.uploaded;
    };
    return entry.moves == moves &&
           std::none_of(entry.moved_to.begin(), entry.moved_to.end(), is_newer);
}

Result<void> TerrainMeshes::upload_all(Group& group, std::span<const ChangedMesh> changed,
                                       const DrawnById& drawn, view::FrameStats& stats) {
    std::vector<view::GridMesh> meshes(changed.size());
    parallel_for(static_cast<int>(changed.size()), [&](int i) {
        const auto& [draw, moves] = changed[static_cast<std::size_t>(i)];
        meshes[static_cast<std::size_t>(i)] = tile_mesh(*draw, *moves, drawn);
    });
    for (std::size_t i = 0; i < changed.size(); ++i) {
        const auto& [draw, moves] = changed[i];
        Entry& entry = group.tiles.at(draw->tile->id);
        entry.cut.view.reset();
        if (draw->coarse) {
            entry.vertices = std::move(meshes[i].vertices);
        } else {
            auto mesh = grids_.upload(meshes[i], stats);
            if (!mesh) {
                return mesh.error();
            }
            entry.meshes.clear();
            entry.meshes.push_back(std::move(*mesh));
            entry.is_whole = true;
        }
        entry.moves = *moves;
        entry.moved_to = tiles_of(*moves);
        entry.uploaded = frame_;
    }
    return {};
}

Result<void> TerrainMeshes::cut_in_memory(const view::DrawList& list, Group& group,
                                          const Draws& draws, view::FrameStats& stats) {
    const scene::TerrainNode& terrain = *draws.front()->terrain;
    const view::Coarseness& coarseness = coarseness_of(list, terrain);
    if (group.version == 0 || group.coarseness != coarseness) {
        group.coarseness = coarseness;
        ++group.version;
    }
    Draws outdated;
    for (const view::TileDraw* const draw : draws) {
        if (group.tiles.at(draw->tile->id).version == group.version) {
            ++stats.skipped.cuts_unchanged;
            ++stats.skipped.uploads_unchanged;
        } else {
            outdated.push_back(draw);
        }
    }
    stats.tiles_cut += static_cast<int>(outdated.size());
    const bool by_error = std::holds_alternative<terrain::ErrorView>(coarseness);
    const terrain::Bisection* const bisection =
        by_error && !outdated.empty() ? &bisection_of(terrain) : nullptr;
    std::vector<view::CutMesh> cuts(outdated.size());
    parallel_for(static_cast<int>(outdated.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const scene::TerrainTile& tile = *outdated[at]->tile;
        cuts[at] = view::cut_alone(bisection, coarseness, *terrain.surface, scene::samples_of(tile),
                                   group.tiles.at(tile.id).last);
    });
    for (std::size_t i = 0; i < outdated.size(); ++i) {
        Entry& entry = group.tiles.at(outdated[i]->tile->id);
        entry.version = group.version;
        if (cuts[i].parts == entry.last.parts) {
            ++stats.skipped.uploads_unchanged;
            continue;
        }
        auto meshes = uploaded(cuts[i], stats);
        if (!meshes) {
            return meshes.error();
        }
        entry.meshes = std::move(*meshes);
        entry.last = std::move(cuts[i]);
    }
    return {};
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

Result<void> TerrainMeshes::cut_loaded(const view::DrawList& list, Group& group,
                                       const DrawnById& drawn, view::FrameStats& stats) {
    std::vector<view::TileToCut> tiles;
    for (const auto& [id, draw] : drawn) {
        tiles.push_back({draw, &group.tiles.at(id).cut});
    }
    view::cut_together(list, group.cover->tiles, std::exchange(group.cover->is_new, false), tiles);
    for (const view::TileToCut& tile : tiles) {
        if (!tile.triangles) {
            ++stats.skipped.cuts_unchanged;
            continue;
        }
        const scene::TerrainTile& content = *tile.draw->tile;
        auto done =
            set_triangles(group.tiles.at(content.id), *tile.triangles, content.cells, stats);
        if (!done) {
            return done;
        }
        tile.cut->view = tile.view;
    }
    return {};
}

Result<void> TerrainMeshes::set_triangles(Entry& entry, const terrain::Triangulation& triangles,
                                          glm::ivec2 cells, view::FrameStats& stats) {
    std::vector<view::GridVertex> used;
    used.reserve(triangles.vertices.size());
    for (const terrain::Steps place : triangles.vertices) {
        const glm::ivec2 vertex = terrain::sample_before(place);
        used.push_back(
            entry.vertices[static_cast<std::size_t>(vertex.y * (cells.x + 1) + vertex.x)]);
    }
    auto mesh = with_indices(upload_vertices(used, stats), triangles.indices, stats);
    if (!mesh) {
        return mesh.error();
    }
    ++stats.tiles_cut;
    entry.meshes.clear();
    entry.meshes.push_back(std::move(*mesh));
    return {};
}

} // namespace reljef::render
