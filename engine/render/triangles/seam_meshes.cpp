#include "engine/render/triangles/seam_meshes.h"

#include <utility>

#include "engine/core/parallel_for.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::render {
namespace {

struct UnseamedTile {
    const view::TileDraw* draw = nullptr;
    ResidentTriangles* triangles = nullptr;
    std::vector<Seam> seams;
};

// The tiles whose seams are not those of their triangles and of those beside them.
std::vector<UnseamedTile> unseamed(const DrawnGroup& drawn) {
    std::vector<terrain::TreeTile> tiles;
    tiles.reserve(drawn.draws.size());
    for (const view::TileDraw* const draw : drawn.draws) {
        tiles.push_back(draw->tile->id);
    }
    const view::DrawnTiles beside(drawn.draws.front()->terrain->stream->tree(), tiles);
    std::vector<UnseamedTile> changed;
    for (const view::TileDraw* const draw : drawn.draws) {
        ResidentTriangles& tile = drawn.triangles_of(*draw);
        std::vector<Seam> seams;
        for (const view::OpenSide& open : beside.open_sides(draw->tile->id)) {
            Seam& seam = seams.emplace_back(Seam{open, 0, {}});
            if (open.neighbour) {
                seam.neighbour_shape = drawn.group.tiles.at(*open.neighbour).shape;
            } else {
                seam.error = view::border_error(drawn.list, *draw);
            }
        }
        if (tile.seamed_shape != tile.shape || tile.seams != seams) {
            changed.push_back({draw, &tile, std::move(seams)});
        }
    }
    return changed;
}

std::vector<view::SeamPart> seam_parts(const MeshGroup& group, const UnseamedTile& tile) {
    const view::TileSurface surface = view::surface_of(*tile.draw);
    view::SeamMaker maker(surface, tile.triangles->border);
    for (const Seam& seam : tile.seams) {
        if (seam.open.neighbour) {
            maker.join(seam.open, group.tiles.at(*seam.open.neighbour).border);
        } else {
            maker.hang(seam.open, seam.error);
        }
    }
    return maker.take();
}

Result<void> keep(UnseamedTile& made, std::vector<view::SeamPart> parts, view::FrameStats& stats) {
    ResidentTriangles& tile = *made.triangles;
    tile.meshes.resize(tile.meshes.size() - tile.seam_count);
    tile.seam_count = 0;
    for (const view::SeamPart& part : parts) {
        auto mesh = tile_mesh(part.vertices, part.indices, stats);
        if (!mesh) {
            return mesh.error();
        }
        tile.meshes.push_back(std::move(*mesh));
        ++tile.seam_count;
    }
    tile.seamed_shape = tile.shape;
    tile.seams = std::move(made.seams);
    tile.seam_parts = std::move(parts);
    tile.slivers_version = 0;
    return {};
}

} // namespace

Result<void> seam_meshes(const DrawnGroup& drawn, view::FrameStats& stats) {
    std::vector<UnseamedTile> tiles = unseamed(drawn);
    std::vector<std::vector<view::SeamPart>> parts(tiles.size());
    parallel_for(static_cast<int>(tiles.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        parts[at] = seam_parts(drawn.group, tiles[at]);
    });
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        if (auto done = keep(tiles[i], std::move(parts[i]), stats); !done) {
            return done;
        }
    }
    return {};
}

} // namespace reljef::render
