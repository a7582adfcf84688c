#include "engine/render/residency/streamed_tiles.h"

#include <algorithm>
#include <utility>

#include "engine/core/parallel_for.h"
#include "engine/render/residency/uploads.h"
#include "engine/scene/tile_stream.h"

namespace reljef::render {
namespace {

struct PlacedVertex {
    glm::dvec3 place; // local metres
    float height;     // true metres
};

PlacedVertex placed(const view::StreamedDraw& draw, glm::ivec2 vertex) {
    const scene::StreamedTile& tile = *draw.tile;
    if (draw.flat) {
        const double height = terrain::reference_height(draw.terrain->surface->heightfield());
        return {draw.terrain->stream->maker().place(tile.id, vertex, height),
                static_cast<float>(height)};
    }
    return {tile.place(vertex), tile.heights(vertex.x, vertex.y)};
}

std::map<const scene::TileStream*, StreamedByTile> draws_by_stream(const view::DrawList& list) {
    std::map<const scene::TileStream*, StreamedByTile> streams;
    for (const view::StreamedDraw& draw : list.streamed_tiles) {
        streams[draw.terrain->stream.get()].emplace(draw.tile->id, &draw);
    }
    return streams;
}

// Frames that an unused tile stays.
constexpr std::uint64_t kept_frames = 8;

// Tiles per batch; limits the memory for vertices that are not yet uploaded.
constexpr std::size_t batch_tiles = 8;

// The outermost texel centres are the outermost vertices.
glm::vec4 lit_from_samples(const scene::TileBuilder& maker, const scene::StreamedTile& tile) {
    const glm::dvec2 texels(tile.albedo.cols(), tile.albedo.rows());
    const glm::dvec2 samples = glm::dvec2(tile.cells) * maker.step(tile.id);
    return {glm::vec2((texels - 1.0) / (samples * texels)), glm::vec2(0.5 / texels)};
}

// A tile's ground map with the albedo's size and the overview's shadows.
GroundMap streamed_ground(const scene::TileBuilder& maker, const scene::StreamedTile& tile,
                          const scene::TerrainIrradiance* irradiance) {
    const Grid<float>& overview = maker.overview().heightfield().heights;
    const glm::dvec2 last(overview.cols() - 1, overview.rows() - 1);
    const glm::dvec2 first = maker.first(tile.id);
    const double step = maker.step(tile.id);
    GroundMap map{tile.albedo, Grid<glm::vec4>(tile.albedo.cols(), tile.albedo.rows())};
    for (int row = 0; row < map.surface.rows(); ++row) {
        for (int col = 0; col < map.surface.cols(); ++col) {
            const glm::dvec2 vertex = tile.vertex_of({col, row});
            const glm::dvec2 sample = maker.on_overview(first + step * vertex);
            const glm::dvec2 inside = glm::clamp(sample, glm::dvec2(0.0), last);
            const float sun = irradiance != nullptr ? irradiance->visibility(inside) : 1.0F;
            map.surface(col, row) = glm::vec4(tile.normal_at(vertex), sun);
        }
    }
    return map;
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

} // namespace

view::GridMesh streamed_mesh(const view::StreamedDraw& draw,
                             const std::vector<terrain::EdgeMove>& moves,
                             const StreamedByTile& drawn) {
    const scene::StreamedTile& tile = *draw.tile;
    const scene::TileBuilder& maker = draw.terrain->stream->maker();
    const glm::dvec2 first = maker.first(tile.id);
    view::GridMesh mesh{tile.cells.x, tile.cells.y, {}};
    const auto vertex_of = [&](const view::StreamedDraw& from, glm::ivec2 vertex, glm::ivec2 own) {
        const PlacedVertex at = placed(from, vertex);
        const glm::dvec2 sample =
            nearest_turn(maker, maker.sample(from.tile->id, vertex), maker.sample(tile.id, own));
        return view::grid_vertex(at.place, at.height, sample - first);
    };
    mesh.vertices.reserve(tile.positions.size());
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

void StreamedTiles::forget_unused(const view::DrawList& list) {
    ++frame_;
    for (const view::StreamedDraw& draw : list.streamed_tiles) {
        entry_of(draw).drawn = frame_;
    }
    std::erase_if(entries_, [&](const auto& entry) {
        return entry.second.owner.expired() || entry.second.drawn + kept_frames < frame_;
    });
    std::erase_if(lights_, [](const auto& entry) { return entry.second.owner.expired(); });
    std::erase_if(covers_, [](const auto& entry) { return entry.second.owner.expired(); });
}

Result<void> StreamedTiles::prepare(const view::DrawList& list, bool with_maps,
                                    view::FrameStats& stats) {
    forget_unused(list);
    for (const auto& streamed : draws_by_stream(list)) {
        const StreamedByTile& drawn = streamed.second;
        Cover& cover = cover_of(drawn);
        if (auto done = prepare_meshes(cover.tiles, drawn, stats); !done) {
            return done;
        }
        if (auto done = prepare_cuts(list, cover, drawn, stats); !done) {
            return done;
        }
    }
    for (const view::StreamedDraw& draw : list.streamed_tiles) {
        if (auto done = with_maps ? prepare_light(list, draw, stats) : Result<void>(); !done) {
            return done;
        }
        if (auto done = with_maps ? prepare_ground(draw, stats) : Result<void>(); !done) {
            return done;
        }
    }
    return {};
}

StreamedTiles::Cover& StreamedTiles::cover_of(const StreamedByTile& drawn) {
    const auto& stream = drawn.begin()->second->terrain->stream;
    std::set<terrain::TreeTile> ids;
    for (const auto& [id, draw] : drawn) {
        if (!draw->is_hidden) {
            ids.insert(id);
        }
    }
    const auto found = covers_.find(stream.get());
    if (found != covers_.end() && found->second.tiles.tiles() == ids) {
        return found->second;
    }
    Cover made{stream, terrain::DrawnTiles(stream->tree(), std::move(ids))};
    return covers_.insert_or_assign(stream.get(), std::move(made)).first->second;
}

Result<void> StreamedTiles::prepare_meshes(const terrain::DrawnTiles& cover,
                                           const StreamedByTile& drawn, view::FrameStats& stats) {
    static const std::vector<terrain::EdgeMove> none;
    std::vector<ChangedMesh> changed;
    for (const auto& [id, draw] : drawn) {
        const std::vector<terrain::EdgeMove>& moves = draw->is_hidden ? none : cover.moves(id);
        const Entry& entry = entry_of(*draw);
        const bool is_there = view::is_cut(*draw) ? !entry.vertices.empty() : entry.is_whole;
        if (is_there && entry.flat == draw->flat && is_moved_as(*draw, moves)) {
            ++stats.skipped.uploads_unchanged;
        } else {
            changed.push_back({draw, &moves});
        }
    }
    for (std::size_t i = 0; i < changed.size(); i += batch_tiles) {
        const auto part = std::span(changed).subspan(i);
        const std::size_t count = std::min(part.size(), batch_tiles);
        if (auto done = upload_all(part.first(count), drawn, stats); !done) {
            return done;
        }
    }
    return {};
}

Result<void> StreamedTiles::upload_all(std::span<const ChangedMesh> changed,
                                       const StreamedByTile& drawn, view::FrameStats& stats) {
    std::vector<view::GridMesh> meshes(changed.size());
    parallel_for(static_cast<int>(changed.size()), [&](int i) {
        const auto& [draw, moves] = changed[static_cast<std::size_t>(i)];
        meshes[static_cast<std::size_t>(i)] = streamed_mesh(*draw, *moves, drawn);
    });
    for (std::size_t i = 0; i < changed.size(); ++i) {
        const auto& [draw, moves] = changed[i];
        Entry& entry = entry_of(*draw);
        entry.cut.view.reset();
        if (view::is_cut(*draw)) {
            entry.vertices = std::move(meshes[i].vertices);
        } else if (auto done = upload(*draw, meshes[i], stats); !done) {
            return done;
        }
        entry.moves = *moves;
        entry.moved_to = tiles_of(*moves);
        entry.flat = draw->flat;
        entry.uploaded = frame_;
    }
    return {};
}

// To the same vertices, whose tiles are not newer than the upload.
bool StreamedTiles::is_moved_as(const view::StreamedDraw& draw,
                                const std::vector<terrain::EdgeMove>& moves) const {
    const Entry& entry = entries_.at(key_of(draw));
    const auto is_newer = [&](terrain::TreeTile tile) {
        return entries_.at({key_of(draw).first, tile}).since > entry.uploaded;
    };
    return entry.moves == moves &&
           std::none_of(entry.moved_to.begin(), entry.moved_to.end(), is_newer);
}

StreamedTiles::Entry& StreamedTiles::entry_of(const view::StreamedDraw& draw) {
    Entry& entry = entries_[key_of(draw)];
    if (entry.owner.lock() != draw.tile) {
        entry = {};
        entry.owner = draw.tile;
        entry.since = frame_;
    }
    return entry;
}

Result<void> StreamedTiles::upload(const view::StreamedDraw& draw, const view::GridMesh& mesh,
                                   view::FrameStats& stats) {
    auto made = grids_.upload(mesh, stats);
    if (!made) {
        return made.error();
    }
    set_mesh(draw, std::move(*made));
    Entry& entry = entry_of(draw);
    entry.is_whole = true;
    entry.vertices = {};
    return {};
}

void StreamedTiles::set_mesh(const view::StreamedDraw& draw, ResidentMesh mesh) {
    Entry& entry = entry_of(draw);
    if (entry.resident) {
        entry.resident->mesh = std::move(mesh);
    } else {
        entry.resident.emplace(
            ResidentStreamed{std::move(mesh),
                             std::nullopt,
                             lit_from_samples(draw.terrain->stream->maker(), *draw.tile),
                             {}});
    }
}

Result<void> StreamedTiles::prepare_cuts(const view::DrawList& list, Cover& cover,
                                         const StreamedByTile& drawn, view::FrameStats& stats) {
    std::vector<view::TileToCut> tiles;
    for (const auto& by_tile : drawn) {
        const view::StreamedDraw& draw = *by_tile.second;
        if (view::is_cut(draw)) {
            tiles.push_back({&draw, &entry_of(draw).cut});
        }
    }
    view::cut_together(list, cover.tiles, std::exchange(cover.is_new, false), tiles);
    for (const view::TileToCut& tile : tiles) {
        if (!tile.triangles) {
            ++stats.skipped.cuts_unchanged;
            continue;
        }
        if (auto done = set_triangles(*tile.draw, *tile.triangles, stats); !done) {
            return done;
        }
        tile.cut->view = tile.view;
    }
    return {};
}

Result<void> StreamedTiles::set_triangles(const view::StreamedDraw& draw,
                                          const view::CutTriangles& triangles,
                                          view::FrameStats& stats) {
    Entry& entry = entry_of(draw);
    std::vector<view::GridVertex> used;
    used.reserve(triangles.vertices.size());
    for (const std::uint16_t vertex : triangles.vertices) {
        used.push_back(entry.vertices[vertex]);
    }
    auto mesh = with_indices(upload_vertices(used, stats), triangles.indices, stats);
    if (!mesh) {
        return mesh.error();
    }
    ++stats.tiles_cut;
    set_mesh(draw, std::move(*mesh));
    entry.is_whole = false;
    return {};
}

Result<void> StreamedTiles::prepare_light(const view::DrawList& list,
                                          const view::StreamedDraw& draw, view::FrameStats& stats) {
    const auto light = view::light_on(list, draw.world_from_local);
    Entry& entry = entry_of(draw);
    if (entry.resident->lit && entry.light == light) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const Image map = light ? scene::lit_tile(draw.terrain->stream->maker(), *draw.tile,
                                              irradiance_of(draw, *light))
                            : draw.tile->albedo;
    auto texture = upload_mipmapped(map, gl::Format::rgba8_srgb, stats);
    if (!texture) {
        return texture.error();
    }
    entry.resident->lit = std::move(*texture);
    entry.resident->ground.reset();
    entry.light = light;
    return {};
}

Result<void> StreamedTiles::prepare_ground(const view::StreamedDraw& draw,
                                           view::FrameStats& stats) {
    Entry& entry = entry_of(draw);
    if (draw.detail == view::DetailLevel::none) {
        entry.resident->ground.reset(); // no budget counts it: keep it only near the eye
        return {};
    }
    if (entry.resident->ground) {
        return {};
    }
    const scene::TerrainIrradiance* const irradiance =
        entry.light ? &irradiance_of(draw, *entry.light) : nullptr;
    auto ground =
        resident_ground(streamed_ground(draw.terrain->stream->maker(), *draw.tile, irradiance),
                        entry.resident->lit_from_sample, stats);
    if (!ground) {
        return ground.error();
    }
    entry.resident->ground = std::move(*ground);
    return {};
}

void StreamedTiles::add_light(const std::shared_ptr<scene::TileStream>& stream,
                              const scene::TerrainLight& light,
                              std::shared_ptr<const scene::TerrainIrradiance> irradiance) {
    lights_[stream.get()] = {stream, light, std::move(irradiance)};
}

const scene::TerrainIrradiance& StreamedTiles::irradiance_of(const view::StreamedDraw& draw,
                                                             const scene::TerrainLight& light) {
    SharedLight& shared = lights_[draw.terrain->stream.get()];
    if (shared.irradiance == nullptr || shared.light != light) {
        shared = {draw.terrain->stream, light,
                  std::make_shared<const scene::TerrainIrradiance>(
                      draw.terrain->stream->maker().overview(), light)};
    }
    return *shared.irradiance;
}

const ResidentStreamed& StreamedTiles::tile(const view::StreamedDraw& draw) const {
    return *entries_.at(key_of(draw)).resident;
}

} // namespace reljef::render
