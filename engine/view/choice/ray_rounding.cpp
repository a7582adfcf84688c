#include "engine/view/choice/ray_rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/scene/streaming/tile_stream.h"
#include "engine/terrain/mesh/tile_layout.h"

// The shader computes a hit as start + part * span, all in floats. A ray has the direction of
// its pixel, computed in a few steps. It starts at the eye, whose place is rounded to 2^-24 of a
// cell and of the heights: the origin of the search is the sample next to the eye. From outside
// of the box around the terrain it starts where it enters, which is computed from where it
// leaves: both are off by the rounding of the box's diagonal. The hit's height on the surface
// differs from that on the ray by the rounding of the heights, and of the hit's place along the
// ray, times the steepness of the ground. The place is rounded to 2^-24 of its distance from the
// start, and from the origin: from outside of the box, the diagonal. What is off by m metres at
// a distance d is seen under an angle of m / d, which is at most focal / cos^2 of the corner's
// angle times as many pixels.
//
// On the CPU, places are relative to where a ray may first meet the surface, and so are heights.
// What is rounded is at most as long as the ray from there, or as a cell: over the box around the
// surface, which a view axis crosses within its diagonal, and the other rays within twice that. Of
// what is as long as a cell, or as high, four operations are: the cell at the base, the ray's t at
// its lines, its place there, and its height. On the ellipsoid, each piece of a ray is such a ray.
//
// A node that is scaled maps rays to rays. What is off by an angle beside one is off by at most
// that times the longest over the shortest scale in the picture.
//
// Without perspective, what is off by m metres is off by m times the pixels per metre, and rays are
// as long as the scene is deep, or as far from the eye as the scene. On the ellipsoid, the shader's
// polynomials take about three times as many operations.

namespace reljef::view {
namespace {

constexpr double operations = 16.0;        // that round, one after the other
constexpr double operations_along = 8.0;   // of these for the place along the ray
constexpr double operations_in_cell = 4.0; // on the CPU, of places and heights in a cell
constexpr double unit = 0x1p-24;
constexpr double more_on_ellipsoid = 3.0;
// Pixels: tiles with smaller bounds are not looked at closely.
constexpr double worth_a_look = 0.02;

struct Extent {
    glm::dvec2 first{0.0};
    glm::dvec2 last{0.0};
    Box box;
    double distance = 0.0;
};

std::span<const float> part_of_row(GridView<const float> heights, int row, int first_col,
                                   int last_col) {
    return heights.row(row).subspan(static_cast<std::size_t>(first_col),
                                    static_cast<std::size_t>(last_col - first_col) + 1);
}

// Finds the smallest distance of an eye from what it sees of a surface: at most a fifth too small,
// never too large.
class NearestPlace {
public:
    struct Surface {
        GridView<const float> heights;
        const terrain::Placement& placement;
    };
    struct Eye {
        glm::dvec3 place; // local metres
        const Frustum& frustum;
    };
    NearestPlace(const Surface& surface, const Eye& eye)
        : surface_(surface), eye_(eye.place), frustum_(eye.frustum) {}

    /// Infinite if nothing is seen.
    [[nodiscard]] double distance(glm::dvec2 first, glm::dvec2 last) const {
        return (1.0 - precision) *
               nearest(extent(first, last), std::numeric_limits<double>::infinity());
    }

private:
    struct Parts {
        std::array<Extent, 4> extents;
        std::size_t count = 0;
    };

    static constexpr double precision = 0.1;

    // Bilinear cells are extreme at the corners of their parts.
    [[nodiscard]] terrain::HeightRange range(glm::dvec2 first, glm::dvec2 last) const {
        if (first == glm::floor(first) && last == glm::floor(last)) {
            return range_of_samples(glm::ivec2(first), glm::ivec2(last));
        }
        terrain::HeightRange range{std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity()};
        const glm::ivec2 corners = glm::ivec2(glm::ceil(last)) - glm::ivec2(glm::floor(first)) + 1;
        for (int row = 0; row < corners.y; ++row) {
            for (int col = 0; col < corners.x; ++col) {
                const glm::dvec2 corner =
                    glm::clamp(glm::floor(first) + glm::dvec2(col, row), first, last);
                const double height = terrain::bilinear_height(surface_.heights, corner);
                range = {std::min(range.low, height), std::max(range.high, height)};
            }
        }
        return range;
    }

    [[nodiscard]] terrain::HeightRange range_of_samples(glm::ivec2 first, glm::ivec2 last) const {
        const auto lower = [](float a, float b) { return std::min(a, b); };
        const auto higher = [](float a, float b) { return std::max(a, b); };
        float low = std::numeric_limits<float>::infinity();
        float high = -low;
        for (int row = first.y; row <= last.y; ++row) {
            const auto heights = part_of_row(surface_.heights, row, first.x, last.x);
            low = std::reduce(heights.begin(), heights.end(), low, lower);
            high = std::reduce(heights.begin(), heights.end(), high, higher);
        }
        return {low, high};
    }

    [[nodiscard]] Extent extent(glm::dvec2 first, glm::dvec2 last) const {
        Extent made{first, last, {}, 0.0};
        made.box = terrain::placed_bounds(surface_.placement, first, last, range(first, last));
        made.distance = glm::distance(eye_, glm::clamp(eye_, made.box.low, made.box.high));
        return made;
    }

    [[nodiscard]] static double middle(double first, double last) {
        const double half = 0.5 * (last - first);
        return first + (half >= 1.0 ? std::floor(half) : half);
    }

    [[nodiscard]] double nearest(const Extent& part, double limit) const {
        constexpr double smallest = 1.0 / 1024.0; // cells
        const glm::dvec2 size = part.last - part.first;
        if (part.distance >= (1.0 - precision) * limit || !frustum_.may_see(part.box)) {
            return limit;
        }
        const glm::dvec2 sides = metres_of(part);
        const glm::dvec2 spacing = surface_.placement.spacing();
        if (glm::length(part.box.size()) <= precision * part.distance ||
            std::max(size.x, size.y) < smallest ||
            std::max(sides.x, sides.y) < smallest * std::max(spacing.x, spacing.y)) {
            return part.distance;
        }
        Parts parts = divided(part, sides);
        const std::span<Extent> made(parts.extents.data(), parts.count);
        std::sort(made.begin(), made.end(),
                  [](const Extent& a, const Extent& b) { return a.distance < b.distance; });
        for (const Extent& one : made) {
            limit = nearest(one, limit);
        }
        return limit;
    }

    // Along its rows (the longer of both ends) and its columns.
    [[nodiscard]] glm::dvec2 metres_of(const Extent& part) const {
        const auto place = [&](double col, double row) {
            return surface_.placement.world_from_sample({col, row, 0.0});
        };
        const glm::dvec3 corner = place(part.first.x, part.first.y);
        const glm::dvec3 below = place(part.first.x, part.last.y);
        return {std::max(glm::distance(corner, place(part.last.x, part.first.y)),
                         glm::distance(below, place(part.last.x, part.last.y))),
                glm::distance(corner, below)};
    }

    // Halves along the side that is twice as long, or quarters: columns meet at a pole.
    [[nodiscard]] Parts divided(const Extent& part, glm::dvec2 sides) const {
        const glm::dvec2 low = part.first;
        const glm::dvec2 high = part.last;
        const glm::dvec2 mid(middle(low.x, high.x), middle(low.y, high.y));
        if (sides.x > 2.0 * sides.y) {
            return {{extent(low, {mid.x, high.y}), extent({mid.x, low.y}, high)}, 2};
        }
        if (sides.y > 2.0 * sides.x) {
            return {{extent(low, {high.x, mid.y}), extent({low.x, mid.y}, high)}, 2};
        }
        return {{extent(low, mid), extent({mid.x, low.y}, {high.x, mid.y}),
                 extent({low.x, mid.y}, {mid.x, high.y}), extent(mid, high)},
                4};
    }

    Surface surface_;
    glm::dvec3 eye_;
    const Frustum& frustum_;
};

// Along rows and columns, in metres between neighbours.
Slopes slopes_from(glm::dvec2 rises, glm::dvec2 cell, double exaggeration) {
    return {exaggeration * glm::length(rises / cell), exaggeration * (rises.x + rises.y)};
}

// Metres between neighbours of two rows, or of one.
double largest_rise(std::span<const float> from, std::span<const float> to) {
    return std::transform_reduce(
        from.begin(), from.end(), to.begin(), 0.0,
        [](double a, double b) { return std::max(a, b); },
        [](double a, double b) { return std::abs(a - b); });
}

Slopes slopes_in(GridView<const float> heights, glm::ivec2 first, glm::ivec2 last, glm::dvec2 cell,
                 double exaggeration) {
    glm::dvec2 rises(0.0);
    for (int row = first.y; row <= last.y; ++row) {
        const auto here = part_of_row(heights, row, first.x, last.x);
        const auto below = part_of_row(heights, std::min(row + 1, last.y), first.x, last.x);
        rises.x = std::max(rises.x, largest_rise(here.first(here.size() - 1), here.subspan(1)));
        rises.y = std::max(rises.y, largest_rise(here, below));
    }
    return slopes_from(rises, cell, exaggeration);
}

// At most, of a tile with samples of its own.
Slopes slopes_by_blocks(const scene::TerrainTile& tile, glm::dvec2 cell) {
    float highest = 0.0F; // metres in a block
    for (const terrain::MinMax& block : tile.blocks.samples()) {
        highest = std::max(highest, block.high - block.low);
    }
    return slopes_from(glm::dvec2(highest), cell, tile.placement->exaggeration());
}

glm::dvec2 cell_of(const scene::TerrainNode& terrain, const scene::TerrainTile& tile) {
    if (tile.borrows) {
        return terrain.surface->placement().spacing();
    }
    const scene::TileBuilder& builder = terrain.stream->maker();
    return terrain.surface->placement().spacing() *
           (builder.spacing(tile.id.level) / std::max(terrain.surface->placement().spacing().x,
                                                      terrain.surface->placement().spacing().y));
}

// The samples of a tile.
struct TileHeights {
    GridView<const float> heights;
    const terrain::Placement& placement;
    glm::ivec2 first;
    glm::ivec2 last;

    TileHeights(const scene::TerrainNode& terrain, const scene::TerrainTile& tile)
        : heights(tile.borrows ? terrain.surface->heightfield().heights.view()
                               : tile.heightfield.heights.view()),
          placement(tile.borrows ? terrain.surface->placement() : *tile.placement),
          first(tile.borrows ? tile.first : glm::ivec2(0)), last(first + tile.cells) {}
};

} // namespace

Slopes slopes_of(const scene::TerrainSurface& surface) {
    const Grid<float>& heights = surface.heightfield().heights;
    return slopes_in(heights.view(), glm::ivec2(0), glm::ivec2(heights.cols(), heights.rows()) - 1,
                     surface.placement().spacing(), surface.placement().exaggeration());
}

RayRounding::RayRounding(const scene::Camera& camera, glm::ivec2 size, const Box& bounds,
                         glm::dvec3 eye, RayFloats floats)
    : by_shader_(floats == RayFloats::opengl) {
    const bool is_outside = glm::clamp(eye, bounds.low, bounds.high) != eye;
    share_ = operations_along / operations * (by_shader_ && is_outside ? 2.0 : 1.0);
    lengths_ = by_shader_ ? bounds.size().z + std::abs(eye.z - bounds.low.z) +
                                (is_outside ? 2.0 * glm::length(bounds.size()) : 0.0)
                          : 0.0;
    longest_ray_ =
        by_shader_ ? std::numeric_limits<double>::infinity() : 2.0 * glm::length(bounds.size());
    if (camera.projection == scene::ProjectionKind::orthographic) {
        per_metre_ = operations * unit * size.y / camera.view_height;
        depth_ = by_shader_ ? std::max(std::abs(camera.orthographic_near),
                                       std::abs(camera.orthographic_far))
                            : camera.orthographic_far - camera.orthographic_near;
        return;
    }
    const double half_height = std::tan(0.5 * glm::radians(camera.vertical_fov));
    const double focal = 0.5 * size.y / half_height;
    const double to_corner =
        half_height * glm::length(glm::dvec2(scene::whole_picture(camera, size))) / size.y;
    rounding_ = operations * unit * focal * (1.0 + to_corner * to_corner);
}

void RayRounding::stretch(double world_metres, double local_metres) {
    rounding_ *= world_metres * local_metres;
    per_metre_ *= world_metres;
    depth_ *= local_metres;
}

double RayRounding::along_ray(double steepness) const {
    return share_ * steepness;
}

double RayRounding::lengths(const Part& part) const {
    return by_shader_ ? (1.0 + along_ray(part.slopes.steepness)) * 2.0 * part.cell + lengths_
                      : operations_in_cell / operations * (part.cell + part.slopes.rise);
}

double RayRounding::at(const Part& part) const {
    const double steep = 1.0 + along_ray(part.slopes.steepness);
    if (per_metre_ > 0.0) {
        return per_metre_ * (depth_ * steep + lengths(part));
    }
    const double near = lengths(part);
    if (part.distance <= 0.0) {
        return near > 0.0 ? std::numeric_limits<double>::infinity() : rounding_ * steep;
    }
    const double of_ray = std::min(1.0, longest_ray_ / part.distance); // 1 at the eye
    return rounding_ * (steep * of_ray + near / part.distance);
}

double RayRounding::from_afar(double steepness) const {
    const double steep = 1.0 + along_ray(steepness);
    return per_metre_ > 0.0 ? per_metre_ * depth_ * steep : rounding_ * steep;
}

std::optional<double> RayRounding::distance_for(double error, const Part& part) const {
    const double left = error / rounding_ - 1.0 - along_ray(part.slopes.steepness);
    return left > 0.0 ? std::optional(lengths(part) / left) : std::nullopt;
}

PictureRounding::Found
PictureRounding::of(const DrawList& list, const TerrainDraw& draw,
                    std::span<const std::shared_ptr<const scene::TerrainTile>> tiles,
                    RayFloats floats) {
    const scene::TerrainNode& terrain = *draw.terrain;
    const glm::dmat4 local_from_world = glm::inverse(draw.world_from_local);
    const glm::dvec3 eye(local_from_world * glm::dvec4(list.camera.eye, 1.0));
    const Frustum frustum =
        Frustum(scene::clip_from_world(list.camera, list.size)).in_local(draw.world_from_local);
    RayRounding rounding(list.camera, list.size, terrain.surface->bounds(), eye, floats);
    const double world_metres = max_stretch(glm::dmat3(draw.world_from_local)); // a local one
    const double local_metres = max_stretch(glm::dmat3(local_from_world));
    rounding.stretch(world_metres, local_metres);
    Found found;
    for (const auto& tile : tiles) {
        if (!frustum.may_see(tile->bounds)) {
            continue;
        }
        RayRounding::Part part = part_of(terrain, *tile, eye);
        double error = rounding.at(part);
        if (error > std::max(found.error, worth_a_look)) {
            const TileHeights samples(terrain, *tile);
            const NearestPlace place({samples.heights, samples.placement}, {eye, frustum});
            part.distance = place.distance(glm::dvec2(samples.first), glm::dvec2(samples.last));
            part.slopes = slopes_in_tile(terrain, tile);
            error = rounding.at(part);
        }
        if (!(error <= found.error)) {
            found = {std::isnan(error) ? std::numeric_limits<double>::infinity() : error,
                     2.0 * rounding.from_afar(part.slopes.steepness) > error};
        }
    }
    if (floats == RayFloats::opengl && draw.search && draw.search->course) {
        const RayCourse& course = *draw.search->course;
        const glm::dvec2 metres(scene::metres_a_pixel(list.camera, list.size));
        const double pixel = metres.x + metres.y; // of parallel rays metres, else radians
        const double chords = course.degrees ? max_degree_chord_error : max_chord_error;
        found.error = more_on_ellipsoid * found.error +
                      world_metres * (local_metres * course.error / pixel + chords);
    }
    return found;
}

// As far as the tile's box tells.
RayRounding::Part PictureRounding::part_of(const scene::TerrainNode& terrain,
                                           const scene::TerrainTile& tile, glm::dvec3 eye) {
    const double distance = glm::distance(eye, glm::clamp(eye, tile.bounds.low, tile.bounds.high));
    const glm::dvec2 cell = cell_of(terrain, tile);
    return {distance, tile.borrows ? slopes_over(terrain.surface) : slopes_by_blocks(tile, cell),
            std::max(cell.x, cell.y)};
}

Slopes PictureRounding::slopes_in_tile(const scene::TerrainNode& terrain,
                                       const std::shared_ptr<const scene::TerrainTile>& tile) {
    const auto known = tile_slopes_.find(tile.get());
    if (known != tile_slopes_.end() && known->second.tile.lock() == tile) {
        return known->second.slopes;
    }
    constexpr std::size_t max_kept = 1 << 12; // tiles
    if (tile_slopes_.size() >= max_kept) {
        std::erase_if(tile_slopes_, [](const auto& entry) { return entry.second.tile.expired(); });
        if (tile_slopes_.size() >= max_kept) {
            tile_slopes_.clear();
        }
    }
    const TileHeights samples(terrain, *tile);
    const Slopes slopes = slopes_in(samples.heights, samples.first, samples.last,
                                    cell_of(terrain, *tile), samples.placement.exaggeration());
    tile_slopes_[tile.get()] = {tile, slopes};
    return slopes;
}

Slopes PictureRounding::slopes_over(const std::shared_ptr<const scene::TerrainSurface>& surface) {
    if (surface_.lock() != surface) {
        slopes_ = slopes_of(*surface);
        surface_ = surface;
    }
    return slopes_;
}

} // namespace reljef::view
