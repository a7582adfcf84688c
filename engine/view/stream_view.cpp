#include "engine/view/stream_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/view/draw_list.h"
#include "engine/view/tile_selection.h"

namespace reljef::view {
namespace {

// Of unproven tiles: estimated margin of the finer tiles' heights beyond a tile's own (averages are
// lower than peaks): a share of its range, plus a number of its errors. The margin for hiding is
// larger: a tower where four averages meet is 16 times as high in the next level.
constexpr double margin_of_range = 0.25;
constexpr double errors_seen = 1.0;
constexpr double errors_hidden = 16.0;

// Pixels, if the technique has no bound.
constexpr double default_error = scene::max_expected_error_of_rays;

// Error bounds by which an occluder may appear lower, and a hidden tile higher, than the heights of
// its tile: fewer triangles take up to a whole bound of each. The heights of unproven tiles that
// were not read are estimates.
constexpr double errors_of_horizon = 2.0;
constexpr double errors_of_unproven_horizon = 3.0;

// Parts of a tile that are wider than this share of their distance are divided, until they are so
// many cells wide: a step at the eye would be endless work.
constexpr double near_parts = 0.5;
constexpr double smallest_part = 1.0 / 64.0;

// Tiles whose true places may be at the eye come before all others, those with larger estimates of
// their errors first: so many times the estimate.
constexpr double unbounded = 1e9;

constexpr double max_texel = 1.0; // pixels between texels, if there are finer images

BoundLeft left_of_bound_of(const scene::TerrainNode& terrain, const scene::Camera& camera,
                           glm::ivec2 size) {
    const double error = scene::error_bound(terrain.material.technique);
    return error > 0.0 ? left_of_bound(camera, size, std::max(error, min_error))
                       : BoundLeft{default_error, 0.0, false};
}

// Rays also need the tiles above the drawn ones: at most a third as many if all are in the view.
std::size_t max_drawn_of(const scene::TerrainNode& terrain) {
    constexpr std::size_t max_searched = max_relief_tiles / 4 * 3;
    const std::size_t fit = terrain.stream->max_drawn();
    return scene::searches_surface(terrain.material.technique.id()) ? std::min(fit, max_searched)
                                                                    : fit;
}

// The largest share of a tile's error between two places in cells, which one block contains.
double share_between(const scene::TerrainTile& tile, glm::dvec2 first, glm::dvec2 last) {
    if (!tile.parts) {
        return terrain::share_of(tile.block_shares, terrain::block_at(glm::ivec2(first)));
    }
    const glm::ivec2 low = glm::ivec2(first) / terrain::cells_per_error_part;
    const glm::ivec2 high = (glm::ivec2(glm::ceil(last)) - 1) / terrain::cells_per_error_part;
    std::uint8_t share = 0;
    for (int row = low.y; row <= high.y; ++row) {
        for (int col = low.x; col <= high.x; ++col) {
            const auto part = static_cast<std::size_t>(row) * terrain::error_parts +
                              static_cast<std::size_t>(col);
            share = std::max(share, tile.parts->at(part));
        }
    }
    return share / 255.0;
}

// Heights of the finer tiles below a tile: of all samples, or expected.
terrain::HeightRange range_below(const scene::TileSummary& tile, double errors) {
    if (tile.is_proven) {
        return tile.range;
    }
    const double margin =
        margin_of_range * (tile.range.high - tile.range.low) + errors * tile.error;
    return {tile.range.low - margin, tile.range.high + margin};
}

} // namespace

StreamView::StreamView(const scene::TerrainNode& terrain, const scene::Camera& camera,
                       glm::ivec2 size, const glm::dmat4& world_from_local)
    : terrain_(terrain), stream_(*terrain.stream), camera_(camera),
      world_from_local_(world_from_local), max_drawn_(max_drawn_of(terrain)),
      max_error_(left_of_bound_of(terrain, camera, size).error),
      max_shift_(max_error_ + left_of_bound_of(terrain, camera, size).vertex_rounding),
      frustum_(scene::clip_from_world(camera, size)),
      wider_(wider_picture(camera, size, max_shift_)),
      wider_frustum_(scene::clip_from_world(wider_.camera, wider_.size)),
      picture_error_(wider_.camera, wider_.size, world_from_local),
      eye_(glm::inverse(world_from_local) * glm::dvec4(camera.eye, 1.0)),
      is_perspective_(camera.projection == scene::ProjectionKind::perspective) {
    pixels_per_metre_ = is_perspective_
                            ? 0.5 * size.y / std::tan(0.5 * glm::radians(camera.vertical_fov))
                            : size.y / camera.view_height;
    const bool is_solid =
        scene::draws_triangles(terrain.material.technique.id()) && !terrain.material.wireframe;
    if (is_solid) {
        find_horizon(size);
    }
}

void StreamView::find_horizon(glm::ivec2 size) {
    const auto root = stream_.recall(stream_.tree().root());
    const double errors = root && root->is_proven ? errors_of_horizon : errors_of_unproven_horizon;
    horizon_ = horizon_view(camera_, size, world_from_local_, errors * max_shift_);
    const scene::TerrainSurface& overview = builder().overview();
    if (horizon_ && root && overview.placement().kind() == terrain::PlacementKind::ellipsoid) {
        const terrain::HeightRange range = range_below(*root, errors_hidden);
        const double exaggeration = overview.placement().exaggeration();
        const double cell =
            builder().spacing(root->id.level) /
            std::max(overview.heightfield().spacing.x, overview.heightfield().spacing.y);
        earth_horizon_ = terrain::EarthHorizon::create(
            overview.placement(),
            {overview.heightfield().heights.cols(), overview.heightfield().heights.rows()},
            {exaggeration * range.low - root->error, exaggeration * range.high + root->error}, cell,
            *horizon_);
    }
}

std::optional<KnownTile> StreamView::known(terrain::TreeTile id) const {
    if (auto tile = stream_.find(id); tile != nullptr && is_ready(terrain_, *tile)) {
        return KnownTile{*tile, std::move(tile)};
    }
    const auto summary = stream_.recall(id);
    return summary ? std::optional(KnownTile{*summary, nullptr}) : std::nullopt;
}

bool StreamView::may_see(const Box& local) const {
    return frustum_.may_see(transformed(world_from_local_, local));
}

bool StreamView::may_show(const Box& local) const {
    return wider_frustum_.may_see(transformed(world_from_local_, local));
}

bool StreamView::may_see_child(const scene::TileSummary& parent, terrain::TreeTile child) const {
    return may_see(child_bounds(parent, child, errors_seen));
}

Box StreamView::hiding_bounds(const scene::TileSummary& tile) const {
    return tile.is_proven ? tile.bounds
                          : builder().bounds(tile.id, range_below(tile, errors_hidden));
}

Box StreamView::hiding_bounds(const scene::TileSummary& parent, terrain::TreeTile child) const {
    return child_bounds(parent, child, errors_hidden);
}

Box StreamView::child_bounds(const scene::TileSummary& parent, terrain::TreeTile child,
                             double errors) const {
    const auto summary = parent.is_proven ? stream_.recall(child) : std::nullopt;
    return summary && summary->is_proven ? summary->bounds
                                         : builder().bounds(child, range_below(parent, errors));
}

double StreamView::along(const Box& local) const {
    const glm::dvec2 eye(eye_);
    return glm::distance(eye, glm::clamp(eye, glm::dvec2(local.low), glm::dvec2(local.high)));
}

double StreamView::distance_to(const Box& local) const {
    const Box bounds = transformed(world_from_local_, local);
    return glm::distance(camera_.eye, glm::clamp(camera_.eye, bounds.low, bounds.high));
}

double StreamView::pixels_per_metre(double distance) const {
    return pixels_per_metre_ / (is_perspective_ ? std::max(distance, camera_.near) : 1.0);
}

bool StreamView::is_over_share(double error) const {
    return error > share_of_tiles * max_error_;
}

double StreamView::error_of(const scene::TileSummary& tile) const {
    if (!tile.is_proven) {
        return builder().has_all_samples(tile.id)
                   ? 0.0
                   : tile.error * pixels_per_metre(distance_to(tile.bounds));
    }
    const auto known = errors_.find(tile.id);
    return known != errors_.end() ? known->second
                                  : errors_.emplace(tile.id, error_of_proven(tile)).first->second;
}

double StreamView::error_of_proven(const scene::TileSummary& tile) const {
    const double error = error_in(tile.bounds, tile.error);
    return is_over_share(error) ? error_of_blocks(tile) : error;
}

double StreamView::error_of_blocks(const scene::TileSummary& tile) const {
    const double true_error = tile.error / builder().overview().placement().exaggeration();
    const terrain::HeightRange drawn{tile.range.low - true_error, tile.range.high + true_error};
    const glm::ivec2 cells = stream_.tree().cells(tile.id);
    double largest = 0.0;
    for (int row = 0; row < cells.y; row += terrain::cells_per_error_block) {
        for (int col = 0; col < cells.x; col += terrain::cells_per_error_block) {
            const glm::ivec2 first(col, row);
            const glm::ivec2 last = glm::min(first + terrain::cells_per_error_block, cells);
            const Box box = builder().bounds(tile.id, first, last, drawn);
            if (may_show(box)) {
                const double share = terrain::share_of(tile.block_shares, terrain::block_at(first));
                largest = std::max(largest, error_in(box, share * tile.error));
            }
        }
    }
    return largest;
}

std::optional<double> StreamView::error_beside(const scene::TerrainTile& tile,
                                               const std::set<terrain::TreeTile>& known) const {
    const auto is_hidden = [](const Box& /*box*/) { return false; };
    std::optional<double> largest;
    for (int row = 0; row < tile.blocks.rows(); ++row) {
        for (int col = 0; col < tile.blocks.cols(); ++col) {
            const glm::ivec2 half =
                glm::ivec2(col, row) * scene::cells_per_block / (terrain::tree_tile_cells / 2);
            const Part block = block_of(tile, {col, row});
            if (!known.contains(
                    {tile.id.level - 1, 2 * tile.id.col + half.x, 2 * tile.id.row + half.y}) &&
                may_see(block.box)) {
                largest = largest_error_in(tile, block, largest.value_or(0.0), is_hidden);
            }
        }
    }
    return largest;
}

StreamView::Part StreamView::block_of(const scene::TerrainTile& tile, glm::ivec2 block) {
    const glm::dvec2 first(block * scene::cells_per_block);
    const glm::dvec2 last =
        glm::min(first + static_cast<double>(scene::cells_per_block), glm::dvec2(tile.cells));
    const terrain::MinMax heights = tile.blocks(block.x, block.y);
    return with_box(tile, first, last, {heights.low, heights.high});
}

StreamView::Part StreamView::part_of(const scene::TerrainTile& tile, glm::dvec2 first,
                                     glm::dvec2 last) {
    return with_box(tile, first, last,
                    terrain::surface_range(tile.heightfield.heights.view(), first, last));
}

// A seam shows points between the tile's border and the true one.
StreamView::Part StreamView::with_box(const scene::TerrainTile& tile, glm::dvec2 first,
                                      glm::dvec2 last, terrain::HeightRange drawn) {
    const glm::dvec2 end(tile.cells);
    const bool is_at_border =
        first.x <= 0.0 || first.y <= 0.0 || last.x >= end.x || last.y >= end.y;
    const double share = share_between(tile, first, last);
    const double error = is_at_border ? share * tile.error / tile.placement->exaggeration() : 0.0;
    return {first, last,
            terrain::placed_bounds(*tile.placement, first, last,
                                   {drawn.low - error, drawn.high + error})};
}

double StreamView::error_of_part(const scene::TerrainTile& tile, const Part& part) const {
    return error_in(part.box, share_between(tile, part.first, part.last) * tile.error);
}

// Parts that have shares of their own, and those that are wide for their distance.
bool StreamView::is_divided(const Part& part) const {
    const glm::dvec2 size = part.last - part.first;
    const double cells = std::max(size.x, size.y);
    const bool is_near = glm::length(part.box.size()) > near_parts * distance_to(part.box);
    return cells > terrain::cells_per_error_part || (is_near && cells > smallest_part);
}

std::array<StreamView::Part, 4> StreamView::quarters_of(const scene::TerrainTile& tile,
                                                        const Part& part) {
    const glm::dvec2 middle = part.first + 0.5 * (part.last - part.first);
    const auto quarter = [&](glm::dvec2 corner) {
        return part_of(tile, glm::min(corner, middle), glm::max(corner, middle));
    };
    return {quarter(part.first), quarter({part.last.x, part.first.y}),
            quarter({part.first.x, part.last.y}), quarter(part.last)};
}

double StreamView::error_in(const Box& box, double error) const {
    const terrain::Placement& placement = builder().overview().placement();
    const bool is_plane = placement.kind() == terrain::PlacementKind::plane;
    const double turn = is_plane ? 0.0
                                 : 0.5 * std::numbers::pi * 0.5 * glm::length(box.size()) /
                                       geo::smallest_radius_of_earth();
    return picture_error_.of({box, error, placement.up(box.center()), turn});
}

double StreamView::relative_error_of(const scene::TileSummary& tile, double of_parent) const {
    constexpr double less = 1.0 - 0x1p-20; // 1000 levels take a thousandth
    return tile.id.level == 0 || tile.is_finest ? 0.0
                                                : std::min(relative_error(tile), less * of_parent);
}

double StreamView::relative_error(const scene::TileSummary& tile) const {
    const double pixels = pixels_per_metre(distance_to(tile.bounds));
    const double texels = tile.coarse_texel * pixels / max_texel;
    if (builder().has_all_samples(tile.id)) {
        return texels;
    }
    const double bound = error_of(tile);
    const double error =
        (std::isinf(bound) ? unbounded * tile.error * pixels : bound) / share_of_tiles;
    const double apart =
        tile.is_proven ? 0.0 : builder().spacing(tile.id.level) * pixels / samples_apart_in_errors;
    return std::max({error / max_error_, apart / max_error_, texels});
}

} // namespace reljef::view
