#include "engine/view/triangles/slivers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/core/check.h"
#include "engine/view/triangles/tile_cut.h"

// A rasterizer interpolates a value over a triangle as a0 + x gx + y gy from the picture's corner,
// in floats. Across a triangle w pixels wide, places change by its size c, in samples: the gradient
// is c / w, and at x pixels floats round the sum by a few times 2^-24 x c / w samples, differently
// for column and row. Along the triangle, of length l, a place that is c samples off is l pixels
// off, because a wall turns columns into heights. So pixels are off by a few times
// 2^-24 x l / w.
// Depth is interpolated like that, too: it is that of a point as many pixels away. It only decides
// what is in front, so silhouettes move.
// Floats also round the place itself, of p samples from the tile's first or from the eye, by a few
// times 2^-24 p, which are l / c times as many pixels.

namespace reljef::view {
namespace {

// Roundings one after the other: of the gradient (2), of the sum at the picture's corner (3), of
// the sum at the pixel (3).
constexpr double rounded_gradient = 8.0 * 0x1p-24;
// Of the place relative to the eye (1), of the division by w (2), of the hit (1).
constexpr double rounded_place = 4.0 * 0x1p-24;

// Errors of depth are allowed so many times those of places (view::error_view): silhouettes may
// move by a quarter of the bound.
constexpr double of_depth = 16.0;

double cross(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

double max_part(glm::dvec2 v) {
    return std::max(std::abs(v.x), std::abs(v.y));
}

} // namespace

std::vector<std::uint32_t> Slivers::all() const {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(mild.size() + narrow.size());
    std::merge(mild.begin(), mild.end(), narrow.begin(), narrow.end(), std::back_inserter(numbers));
    return numbers;
}

SliverView::SliverView(const DrawList& list, const TileDraw& draw)
    : size_(list.size), near_(list.camera.near) {
    const TerrainDraw& terrain = list.terrains[draw.node];
    const auto* const view =
        terrain.coarseness ? std::get_if<terrain::ErrorView>(&*terrain.coarseness) : nullptr;
    check(view != nullptr, "slivers without an error bound");
    max_error_ = view->interpolation;
    clip_from_offset_ = scene::clip_from_view(list.camera, list.size) *
                        scene::view_from_world_rotation(list.camera) *
                        glm::dmat4(glm::dmat3(terrain.world_from_local));
    eye_ = glm::dvec3(glm::inverse(terrain.world_from_local) * glm::dvec4(list.camera.eye, 1.0));
    const TileSurface surface = surface_of(draw);
    const glm::dvec2 first = surface.placement.on_terrain(glm::dvec2(surface.samples.first));
    const auto place = surface.placement.sample_from_world(eye_);
    eye_place_ = place ? surface.placement.on_terrain(glm::dvec2(*place)) - first : glm::dvec2(0.0);
}

SliverView::Corner SliverView::corner(const GridVertex& vertex) const {
    const glm::dvec3 offset = (glm::dvec3(vertex.position) - eye_) + glm::dvec3(vertex.rest);
    const glm::dvec4 clip = clip_from_offset_ * glm::dvec4(offset, 1.0);
    return {0.5 * size_ * (glm::dvec2(clip) / clip.w + 1.0), clip.w, glm::dvec2(vertex.place)};
}

SliverView::Shape SliverView::shape_of(const Corner& a, const Corner& b, const Corner& c) const {
    if (std::max({a.depth, b.depth, c.depth}) < near_) {
        return Shape::wide;
    }
    if (std::min({a.depth, b.depth, c.depth}) < near_) {
        return Shape::narrow;
    }
    const glm::dvec2 low = glm::min(glm::min(a.pixel, b.pixel), c.pixel);
    const glm::dvec2 high = glm::max(glm::max(a.pixel, b.pixel), c.pixel);
    if (high.x < 0.0 || high.y < 0.0 || low.x > size_.x || low.y > size_.y) {
        return Shape::wide;
    }
    const glm::dvec2 ab = b.pixel - a.pixel;
    const glm::dvec2 ac = c.pixel - a.pixel;
    const glm::dvec2 bc = c.pixel - b.pixel;
    const double length2 = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    const double farthest = std::max({max_part(size_), max_part(low), max_part(high)});
    const double error = rounded_gradient * farthest * length2; // times the area
    const double area = std::abs(cross(ab, ac));
    if (error > max_error_ * area) {
        return error > of_depth * max_error_ * area ? Shape::narrow : Shape::mild;
    }
    const auto rounded = [&](glm::dvec2 origin) {
        return std::max(
            {max_part(a.place - origin), max_part(b.place - origin), max_part(c.place - origin)});
    };
    const double place = std::min(rounded(glm::dvec2(0.0)), rounded(eye_place_));
    const double samples = std::max(max_part(b.place - a.place), max_part(c.place - a.place));
    return rounded_place * place * std::sqrt(length2) > max_error_ * samples ? Shape::mild
                                                                             : Shape::wide;
}

Slivers SliverView::slivers(std::span<const GridVertex> vertices,
                            std::span<const std::uint16_t> indices) const {
    std::vector<Corner> corners;
    corners.reserve(vertices.size());
    std::transform(vertices.begin(), vertices.end(), std::back_inserter(corners),
                   [&](const GridVertex& vertex) { return corner(vertex); });
    Slivers found;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const Shape shape =
            shape_of(corners[indices[i]], corners[indices[i + 1]], corners[indices[i + 2]]);
        if (shape != Shape::wide) {
            auto& numbers = shape == Shape::narrow ? found.narrow : found.mild;
            numbers.push_back(static_cast<std::uint32_t>(i / 3));
        }
    }
    return found;
}

std::vector<GridVertex> corners_of(std::span<const GridVertex> vertices,
                                   std::span<const std::uint16_t> indices,
                                   std::span<const std::uint32_t> triangles) {
    std::vector<GridVertex> corners;
    corners.reserve(3 * triangles.size());
    for (const std::uint32_t triangle : triangles) {
        for (const std::uint16_t index : indices.subspan(std::size_t{3} * triangle, 3)) {
            corners.push_back(vertices[index]);
        }
    }
    return corners;
}

std::vector<std::uint16_t> without(std::span<const std::uint16_t> indices,
                                   std::span<const std::uint32_t> triangles) {
    std::vector<std::uint16_t> others;
    others.reserve(indices.size() - 3 * triangles.size());
    auto next = triangles.begin();
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        if (next != triangles.end() && *next == i / 3) {
            ++next;
            continue;
        }
        const auto three = indices.subspan(i, 3);
        others.insert(others.end(), three.begin(), three.end());
    }
    return others;
}

} // namespace reljef::view
