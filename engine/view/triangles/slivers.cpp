#include "engine/view/triangles/slivers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/core/check.h"
#include "engine/view/triangles/tile_cut.h"

// A rasterizer interpolates a value, divided by the depth w, and 1 / w: each as a0 + x gx + y gy
// from the picture's corner, in floats. The gradients have rounding errors of a few times 2^-24
// (range of the value) (length of the triangle) / area, which count over the triangle's length; the
// products and the sum, of a few times 2^-24 x |g|. The quotient of both is a place, in samples
// from the tile's first; how far it is from there counts where the depth changes, and is rounded
// itself. In plan, a triangle of bisection has a right angle between equal sides, so a place that
// is off by one sample is seen off by at most its pixels per sample along both sides. Depth is
// interpolated like that, without the division. It only decides what is in front, so silhouettes
// move by as many pixels as it takes the triangle to get so much deeper.

namespace reljef::view {
namespace {

// Roundings one after the other: of the gradient (2), of the sum at the picture's corner (3), of
// the sum at the pixel (3).
constexpr double rounded_sum = 8.0 * 0x1p-24;
// Of the division by w at the corner (2), of that at the pixel (2), of the hit (1).
constexpr double rounded_place = 5.0 * 0x1p-24;

// Of the triangles' bound, by which silhouettes may move.
constexpr double share_of_depth = 0.25;

// A linear function over a triangle in the picture, by its values at the corners.
struct Linear {
    double gradient = 0.0; // length
    double range = 0.0;
};

double cross(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Of values relative to that at the first corner. `area`: twice the triangle's, not 0.
Linear linear(glm::dvec2 ab, glm::dvec2 ac, double area, glm::dvec2 values) {
    const glm::dvec2 gradient =
        (values.x * glm::dvec2(ac.y, -ac.x) - values.y * glm::dvec2(ab.y, -ab.x)) / area;
    return {glm::length(gradient), std::max(std::abs(values.x), std::abs(values.y))};
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

SliverView::SliverView(const DrawList& list, const TileDraw& draw, const CutOptions& cut)
    : size_(list.size), bisection_(cut.bisection) {
    const TerrainDraw& terrain = list.terrains[draw.node];
    const auto& view = checked_pointer(
        terrain.coarseness ? std::get_if<terrain::ErrorView>(&*terrain.coarseness) : nullptr,
        "slivers without an error bound");
    max_error_ = view.interpolation;
    max_depth_error_ = share_of_depth * view.max_error;
    near_ = view.perspective ? list.camera.near : 0.0;
    cut_view_ = triangle_view(view, cut);
    clip_from_offset_ = scene::clip_from_view(list.camera, list.size) *
                        scene::view_from_world_rotation(list.camera) *
                        glm::dmat4(glm::dmat3(terrain.world_from_local));
    eye_ = glm::dvec3(glm::inverse(terrain.world_from_local) * glm::dvec4(list.camera.eye, 1.0));
}

SliverView::Corner SliverView::corner(const GridVertex& vertex) const {
    const glm::dvec3 offset = (glm::dvec3(vertex.position) - eye_) + glm::dvec3(vertex.rest);
    const glm::dvec4 clip = clip_from_offset_ * glm::dvec4(offset, 1.0);
    const glm::dvec2 place(vertex.place);
    return clip.w > 0.0 ? Corner{0.5 * size_ * (glm::dvec2(clip) / clip.w + 1.0), clip.w, place}
                        : Corner{glm::dvec2(0.0), clip.w, place};
}

SliverView::Rounding SliverView::rounding_in(const Corner& a, const Corner& b,
                                             const Corner& c) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (std::max({a.depth, b.depth, c.depth}) < near_) {
        return {};
    }
    if (std::min({a.depth, b.depth, c.depth}) < near_) {
        return {infinity, infinity};
    }
    const glm::dvec2 low = glm::min(glm::min(a.pixel, b.pixel), c.pixel);
    const glm::dvec2 high = glm::max(glm::max(a.pixel, b.pixel), c.pixel);
    if (high.x < 0.0 || high.y < 0.0 || low.x > size_.x || low.y > size_.y) {
        return {};
    }
    const glm::dvec2 ab = b.pixel - a.pixel;
    const glm::dvec2 ac = c.pixel - a.pixel;
    const glm::dvec2 bc = c.pixel - b.pixel;
    const double area = cross(ab, ac);
    if (area == 0.0) {
        return {infinity, infinity};
    }
    const double length =
        std::sqrt(std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)}));
    const double farthest = std::max({max_part(size_), max_part(low), max_part(high)});
    const auto error_of = [&](double at_a, double at_b, double at_c) {
        const Linear value = linear(ab, ac, area, {at_b - at_a, at_c - at_a});
        return rounded_sum *
               (farthest * value.gradient + 2.0 * length * length * value.range / std::abs(area));
    };
    const double depth = std::max({a.depth, b.depth, c.depth});
    const double inverse = error_of(1.0 / a.depth, 1.0 / b.depth, 1.0 / c.depth);
    const auto error_along = [&](int axis) { // samples
        const glm::dvec3 places(a.place[axis], b.place[axis], c.place[axis]);
        const double place = std::max({std::abs(places.x), std::abs(places.y), std::abs(places.z)});
        const double divided = error_of(places.x / a.depth, places.y / b.depth, places.z / c.depth);
        return depth * (divided + place * inverse) + rounded_place * place;
    };
    const double error_of_depth =
        rounded_sum * 2.0 * (farthest + length) * length * length / std::abs(area);
    const double samples = std::max(max_part(b.place - a.place), max_part(c.place - a.place));
    if (samples == 0.0) {
        return {infinity, error_of_depth};
    }
    const double pixels_a_sample = std::sqrt(2.0) * length / samples;
    return {pixels_a_sample * glm::length(glm::dvec2(error_along(0), error_along(1))),
            error_of_depth};
}

// Of the triangle's bound by its own error, pixels. `first`: its first index.
double SliverView::unused_error(const Triangles& triangles, std::size_t first) const {
    if (triangles.part == nullptr || bisection_ == nullptr) {
        return 0.0;
    }
    std::array<terrain::Steps, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = triangles.part->vertices[triangles.indices[first + i]];
    }
    return std::max(0.0, cut_view_.max_error -
                             terrain::triangle_error_in(cut_view_, *bisection_, corners));
}

Slivers SliverView::slivers(const Triangles& triangles) const {
    std::vector<Corner> corners;
    corners.reserve(triangles.vertices.size());
    std::transform(triangles.vertices.begin(), triangles.vertices.end(),
                   std::back_inserter(corners),
                   [&](const GridVertex& vertex) { return corner(vertex); });
    const std::span<const std::uint16_t> indices = triangles.indices;
    Slivers found;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const Rounding rounding =
            rounding_in(corners[indices[i]], corners[indices[i + 1]], corners[indices[i + 2]]);
        const auto number = static_cast<std::uint32_t>(i / 3);
        if (!(rounding.depth <= max_depth_error_)) {
            found.narrow.push_back(number);
        } else if (rounding.place > max_error_ &&
                   !(rounding.place <= max_error_ + unused_error(triangles, i))) {
            found.mild.push_back(number);
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
