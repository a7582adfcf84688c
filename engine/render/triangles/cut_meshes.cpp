#include "engine/render/triangles/cut_meshes.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "engine/core/check.h"
#include "engine/core/parallel_for.h"

namespace reljef::render {
namespace {

// Tiles and their new triangles.
struct Cuts {
    std::vector<OutdatedTile> tiles;
    std::vector<view::CutMesh> meshes;
    std::vector<view::TileBorder> borders;
};

const view::Coarseness& coarseness_of(const DrawnGroup& drawn) {
    const auto& coarseness = drawn.list.terrains[drawn.draws.front()->node].coarseness;
    check(coarseness.has_value(), "a coarse terrain of the list was expected");
    return *coarseness;
}

std::size_t triangle_count(const view::CutMesh& mesh) {
    std::size_t indices = 0;
    for (const terrain::Triangulation& part : mesh.parts) {
        indices += part.indices.size();
    }
    return indices / 3;
}

// Forgets what fitted another view, or other errors of the tiles.
void note_errors(const DrawnGroup& drawn) {
    MeshGroup& group = drawn.group;
    std::vector<std::tuple<terrain::TreeTile, double, double>> errors;
    errors.reserve(drawn.draws.size());
    for (const view::TileDraw* const draw : drawn.draws) {
        errors.emplace_back(draw->tile->id, draw->error, draw->triangle_error);
    }
    const std::size_t max_triangles = drawn.draws.front()->terrain->max_triangles;
    if (group.errors != errors || group.max_triangles != max_triangles) {
        group.errors = std::move(errors);
        group.max_triangles = max_triangles;
        group.coarsening = {};
    }
    const view::Coarseness& coarseness = coarseness_of(drawn);
    if (group.version == 0 || group.coarseness != coarseness) {
        group.coarseness = coarseness;
        group.coarsening = {};
        ++group.version;
    }
}

// The tiles that need other triangles; counts those of the others.
std::vector<OutdatedTile> outdated_cuts(const DrawnGroup& drawn, terrain::TriangleBudget& budget) {
    std::vector<OutdatedTile> outdated;
    for (const view::TileDraw* const draw : drawn.draws) {
        ResidentTriangles& tile = drawn.triangles_of(*draw);
        if (tile.version == drawn.group.version && tile.error == draw->error &&
            tile.triangle_error == draw->triangle_error &&
            tile.coarsening == drawn.group.coarsening) {
            budget.add(tile.triangles);
        } else {
            outdated.push_back({draw, &tile});
        }
    }
    return outdated;
}

// The triangles of the tiles that need others. Empty if all tiles together have too many.
std::optional<Cuts> try_to_cut(const DrawnGroup& drawn, Bisections& bisections) {
    const MeshGroup& group = drawn.group;
    const bool by_error = std::holds_alternative<terrain::ErrorView>(group.coarseness);
    const bool is_limited = by_error && !view::is_coarsest(group.coarsening);
    terrain::TriangleBudget budget(group.max_triangles);
    Cuts cuts;
    cuts.tiles = outdated_cuts(drawn, budget);
    const terrain::Bisection* const shared =
        by_error && !cuts.tiles.empty() ? bisections.of(*drawn.draws.front()) : nullptr;
    cuts.meshes.resize(cuts.tiles.size());
    cuts.borders.resize(cuts.tiles.size());
    parallel_for(static_cast<int>(cuts.tiles.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const auto& [draw, tile] = cuts.tiles[at];
        const view::TileSurface surface = view::surface_of(*draw);
        view::CutOptions options = cut_options(group, cuts.tiles[at], shared);
        options.budget = is_limited ? &budget : nullptr;
        cuts.meshes[at] = view::cut_tile(group.coarseness, surface, options, tile->last);
        if (has_seams(*draw)) {
            cuts.borders[at] = view::border_of(surface, cuts.meshes[at]);
        }
    });
    return is_limited && budget.is_exceeded() ? std::nullopt : std::make_optional(std::move(cuts));
}

// The same with the least coarsening that fits the terrain's number of triangles.
Cuts cut_within_budget(const DrawnGroup& drawn, Bisections& bisections) {
    MeshGroup& group = drawn.group;
    auto cuts = try_to_cut(drawn, bisections);
    while (!cuts) {
        group.coarsening =
            view::coarser(std::get<terrain::ErrorView>(group.coarseness), group.coarsening);
        cuts = try_to_cut(drawn, bisections);
    }
    return std::move(*cuts);
}

Result<void> keep(Cuts cuts, MeshGroup& group, view::FrameStats& stats) {
    stats.tiles_cut += static_cast<int>(cuts.tiles.size());
    for (std::size_t i = 0; i < cuts.tiles.size(); ++i) {
        const auto& [draw, tile] = cuts.tiles[i];
        view::CutMesh& mesh = cuts.meshes[i];
        const double kept_error = mesh.error;
        if (mesh.parts.empty()) {
            ++stats.skipped.uploads_unchanged;
        } else {
            auto meshes = tile_meshes(mesh, stats);
            if (!meshes) {
                return meshes.error();
            }
            group.replace_meshes(*tile, std::move(*meshes));
            tile->border = std::move(cuts.borders[i]);
            tile->triangles = triangle_count(mesh);
            tile->last = std::move(mesh);
        }
        tile->version = group.version;
        tile->error = draw->error;
        tile->triangle_error = draw->triangle_error;
        tile->coarsening = group.coarsening;
        tile->kept_error = kept_error;
        tile->slivers_version = 0;
    }
    return {};
}

void add_kept_errors(const DrawnGroup& drawn, view::FrameStats& stats) {
    for (const view::TileDraw* const draw : drawn.draws) {
        if (draw->is_proven()) {
            const double error = drawn.triangles_of(*draw).kept_error;
            stats.kept_error = std::max(stats.kept_error.value_or(0.0), error);
        }
    }
}

} // namespace

Result<void> cut_meshes(const DrawnGroup& drawn, Bisections& bisections, view::FrameStats& stats) {
    MeshGroup& group = drawn.group;
    note_errors(drawn);
    Cuts cuts = cut_within_budget(drawn, bisections);
    const auto unchanged = static_cast<int>(drawn.draws.size() - cuts.tiles.size());
    stats.skipped.cuts_unchanged += unchanged;
    stats.skipped.uploads_unchanged += unchanged;
    if (auto done = keep(std::move(cuts), group, stats); !done) {
        return done;
    }
    stats.lacks_triangles = stats.lacks_triangles || group.coarsening != view::Coarsening{};
    if (const auto* const bound = std::get_if<terrain::ErrorView>(&group.coarseness)) {
        stats.exceeded_by_rounding = stats.exceeded_by_rounding || bound->exceeded_by_rounding;
        add_kept_errors(drawn, stats);
    }
    return {};
}

} // namespace reljef::render
