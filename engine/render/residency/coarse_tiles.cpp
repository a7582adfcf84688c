#include "engine/render/residency/coarse_tiles.h"

#include <utility>

#include "engine/core/parallel_for.h"
#include "engine/terrain/mesh/patch_mesh.h"
#include "engine/view/grid_mesh.h"

namespace reljef::render {
namespace {

// A tile's triangles and vertices by part; without vertices if the triangles did not change.
struct NewCut {
    std::vector<terrain::Triangulation> parts;
    std::vector<std::vector<view::GridVertex>> vertices;
};

struct LastCut {
    const std::vector<terrain::Triangulation>& parts;
    const std::vector<std::vector<view::GridVertex>>& vertices;
};

std::vector<std::vector<view::GridVertex>>
vertices_of(const std::vector<terrain::Triangulation>& parts, const scene::TerrainSurface& surface,
            const terrain::Tile& tile, const LastCut& last) {
    view::VertexPlacer placer(surface.heightfield(), surface.placement(), tile);
    for (std::size_t i = 0; i < last.parts.size(); ++i) {
        placer.know(last.parts[i], last.vertices[i]);
    }
    std::vector<std::vector<view::GridVertex>> vertices;
    vertices.reserve(parts.size());
    for (const terrain::Triangulation& part : parts) {
        vertices.push_back(placer.place(part));
    }
    return vertices;
}

NewCut cut_tile(const terrain::Bisection* bisection, const view::Coarseness& coarseness,
                const scene::TerrainSurface& surface, const terrain::Tile& tile,
                const LastCut& last) {
    NewCut cut;
    if (const auto* view = std::get_if<terrain::ErrorView>(&coarseness)) {
        cut.parts = terrain::triangulate(*bisection, tile, *view);
    } else {
        cut.parts = {terrain::triangulate_patches(std::get<Grid<std::uint8_t>>(coarseness), tile)};
    }
    if (cut.parts != last.parts) {
        cut.vertices = vertices_of(cut.parts, surface, tile, last);
    }
    return cut;
}

Result<std::vector<ResidentMesh>> uploaded(const NewCut& cut, view::FrameStats& stats) {
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

} // namespace

std::span<const ResidentMesh> CoarseTiles::tile(const view::TileDraw& draw) const {
    const Cut& cut = cuts_.at({draw.terrain, draw.terrain->material.technique.parameters});
    return cut.tiles[static_cast<std::size_t>(draw.tile)].meshes;
}

Result<void> CoarseTiles::prepare(const view::DrawList& list, view::FrameStats& stats) {
    for (const view::CoarseTerrain& terrain : list.coarse_terrains) {
        if (auto done = prepare(list, terrain, stats); !done) {
            return done;
        }
    }
    return {};
}

void CoarseTiles::forget_unused() {
    constexpr int kept_frames = 32;
    ++frame_;
    std::erase_if(cuts_, [&](const auto& entry) {
        return entry.second.owner.expired() || frame_ - entry.second.frame > kept_frames;
    });
    std::erase_if(bisections_, [](const auto& entry) { return entry.second.owner.expired(); });
}

Result<void> CoarseTiles::prepare(const view::DrawList& list, const view::CoarseTerrain& terrain,
                                  view::FrameStats& stats) {
    const scene::TerrainSurface& surface = *terrain.terrain->surface;
    Cut& cut = cut_of(terrain);
    const auto outdated = outdated_tiles(list, *terrain.terrain, cut, stats);
    const bool by_error = std::holds_alternative<terrain::ErrorView>(cut.coarseness);
    const terrain::Bisection* bisection =
        by_error && !outdated.empty() ? &bisection_of(*terrain.terrain) : nullptr;
    std::vector<NewCut> cuts(outdated.size());
    parallel_for(static_cast<int>(outdated.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const CutTile& last = cut.tiles[outdated[at]];
        cuts[at] = cut_tile(bisection, cut.coarseness, surface, surface.tiles()[outdated[at]],
                            {last.parts, last.vertices});
    });
    for (std::size_t i = 0; i < outdated.size(); ++i) {
        CutTile& tile = cut.tiles[outdated[i]];
        tile.version = cut.version;
        if (cuts[i].parts == tile.parts) {
            ++stats.skipped.uploads_unchanged;
            continue;
        }
        auto meshes = uploaded(cuts[i], stats);
        if (!meshes) {
            return meshes.error();
        }
        tile.meshes = std::move(*meshes);
        tile.parts = std::move(cuts[i].parts);
        tile.vertices = std::move(cuts[i].vertices);
    }
    return {};
}

CoarseTiles::Cut& CoarseTiles::cut_of(const view::CoarseTerrain& terrain) {
    const auto& surface = terrain.terrain->surface;
    Cut& cut = cuts_[{terrain.terrain, terrain.terrain->material.technique.parameters}];
    cut.frame = frame_;
    if (cut.owner.lock() != surface) {
        cut = {surface, terrain.coarseness, 0, frame_, {}};
        cut.tiles.resize(surface->tiles().size());
    } else if (cut.coarseness != terrain.coarseness) {
        cut.coarseness = terrain.coarseness;
        ++cut.version;
    }
    return cut;
}

const terrain::Bisection& CoarseTiles::bisection_of(const scene::TerrainNode& terrain) {
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

std::vector<std::size_t> CoarseTiles::outdated_tiles(const view::DrawList& list,
                                                     const scene::TerrainNode& terrain,
                                                     const Cut& cut, view::FrameStats& stats) {
    std::vector<std::size_t> outdated;
    for (const view::TileDraw& draw : list.tiles) {
        const auto index = static_cast<std::size_t>(draw.tile);
        if (draw.terrain != &terrain) {
            continue;
        }
        if (cut.tiles[index].version == cut.version) {
            ++stats.skipped.cuts_unchanged;
            ++stats.skipped.uploads_unchanged;
        } else {
            outdated.push_back(index);
        }
    }
    stats.tiles_cut += static_cast<int>(outdated.size());
    return outdated;
}

} // namespace reljef::render
