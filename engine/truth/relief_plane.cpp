#include "engine/truth/relief_plane.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "engine/terrain/field/ray_cast.h"

namespace reljef::truth {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// A ray along the plane stays in the slab without end: past the tile nothing changes any more.
constexpr double farthest = 1e300;

std::optional<Error> error_of(const ReliefOptions& options) {
    if (!(std::isfinite(options.width) && options.width > 0.0)) {
        return Error{
            fmt::format("relief width {}: a finite number above 0 was expected", options.width)};
    }
    if (!(std::isfinite(options.scale) && options.scale > 0.0)) {
        return Error{
            fmt::format("relief scale {}: a finite number above 0 was expected", options.scale)};
    }
    if (!(options.offset >= -1.0 && options.offset <= 0.0)) {
        return Error{
            fmt::format("relief offset {}: a number in [-1, 0] was expected", options.offset)};
    }
    return std::nullopt;
}

std::optional<Error> error_of(GridView<const float> tile) {
    if (tile.empty()) {
        return Error{"relief tile: it has no texels, at least one was expected"};
    }
    for (int row = 0; row < tile.rows(); ++row) {
        for (const float height : tile.row(row)) {
            if (!(height >= 0.0F && height <= 1.0F)) {
                return Error{fmt::format(
                    "relief tile: has a height of {}, heights in [0, 1] were expected", height)};
            }
        }
    }
    return std::nullopt;
}

// Wrapped, with the first texels again behind the last; else as it is, but at least 2×2.
Grid<float> with_border(GridView<const float> tile, Border border) {
    const bool wraps = border == Border::wrap;
    Grid<float> heights(wraps ? tile.cols() + 1 : std::max(tile.cols(), 2),
                        wraps ? tile.rows() + 1 : std::max(tile.rows(), 2));
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            heights(col, row) =
                wraps ? tile(col % tile.cols(), row % tile.rows()) : tile.clamped(col, row);
        }
    }
    return heights;
}

// A little more than the heights 0 … 1: what lies on its faces is met.
Box slab() {
    constexpr double room = 0.01;
    return {{-infinity, -infinity, -room}, {infinity, infinity, 1.0 + room}};
}

// The part of a coordinate in its own copy, [0, 1).
glm::dvec2 wrapped(glm::dvec2 coordinate) {
    const glm::dvec2 part = glm::fract(coordinate);
    return {part.x < 1.0 ? part.x : 0.0, part.y < 1.0 ? part.y : 0.0};
}

// Follows a ray, given in texels from the first one's centre and height, over tile after tile.
class TileRay {
public:
    TileRay(const Grid<float>& heights, const terrain::MinMaxPyramid& pyramid, glm::ivec2 texels,
            const Ray& ray, terrain::Side side)
        : heights_(heights), pyramid_(pyramid), texels_(texels), ray_(ray), side_(side) {}

    // The relief repeated: from copy to copy, each met by the ray moved back over the tile.
    std::optional<double> first_hit_wrapped(Interval range) {
        glm::dvec2 copy = glm::floor(glm::dvec2(ray_.at(range.begin)) / glm::dvec2(texels_));
        double t = range.begin;
        for (int count = 0; count < ReliefPlane::max_copies && t < range.end; ++count) {
            const glm::dvec2 leaving{leaving_time(copy, 0), leaving_time(copy, 1)};
            const double end = std::min({leaving.x, leaving.y, range.end});
            if (end == infinity) {
                return std::nullopt; // no direction at all
            }
            Ray moved = ray_;
            moved.origin -= glm::dvec3(copy * glm::dvec2(texels_), 0.0);
            if (const auto hit = followed(moved, {t, end})) {
                return hit;
            }
            copy.x += leaving.x <= end ? std::copysign(1.0, ray_.direction.x) : 0.0;
            copy.y += leaving.y <= end ? std::copysign(1.0, ray_.direction.y) : 0.0;
            t = std::max(t, end);
        }
        return std::nullopt;
    }

    // The relief goes on beyond its outermost texels as they are: there a ray sees it as if it did
    // not move that way at all.
    std::optional<double> first_hit_clamped(Interval range) {
        const glm::dvec2 last = glm::dvec2(texels_) - 1.0;
        std::array<double, 6> breaks{range.begin,     time_at(0, 0.0),    time_at(0, last.x),
                                     time_at(1, 0.0), time_at(1, last.y), range.end};
        for (double& t : breaks) {
            t = std::clamp(t, range.begin, range.end);
        }
        std::sort(breaks.begin(), breaks.end());
        for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
            const Interval part{breaks[i], std::min(breaks[i + 1], farthest)};
            if (const auto hit = followed(clamped(0.5 * (part.begin + part.end)), part)) {
                return hit;
            }
        }
        return std::nullopt;
    }

private:
    std::optional<double> followed(const Ray& ray, Interval range) {
        const terrain::Stretch stretch =
            terrain::follow(heights_.view(), pyramid_, ray, range, side_);
        side_ = stretch.side;
        return stretch.hit ? std::optional(stretch.hit->t) : std::nullopt;
    }

    // When the ray passes a place of an axis; never where it does not move along it.
    [[nodiscard]] double time_at(int axis, double place) const {
        const double time = (place - ray_.origin[axis]) / ray_.direction[axis];
        return ray_.direction[axis] == 0.0 || std::isnan(time) ? infinity : time;
    }

    [[nodiscard]] double leaving_time(glm::dvec2 copy, int axis) const {
        return time_at(axis,
                       (copy[axis] + (ray_.direction[axis] > 0.0 ? 1.0 : 0.0)) * texels_[axis]);
    }

    // The ray without its way along the axes on which it is beyond the texels at t.
    [[nodiscard]] Ray clamped(double t) const {
        Ray ray = ray_;
        for (int axis = 0; axis < 2; ++axis) {
            const double place = ray_.at(t)[axis];
            const double last = texels_[axis] - 1.0;
            if (place < 0.0 || place > last) {
                ray.origin[axis] = std::clamp(place, 0.0, last);
                ray.direction[axis] = 0.0;
            }
        }
        return ray;
    }

    const Grid<float>& heights_;
    const terrain::MinMaxPyramid& pyramid_;
    glm::ivec2 texels_;
    Ray ray_;
    terrain::Side side_;
};

} // namespace

Result<ReliefPlane> ReliefPlane::create(GridView<const float> tile, const ReliefOptions& options) {
    if (auto fault = error_of(options)) {
        return *fault;
    }
    if (auto fault = error_of(tile)) {
        return *fault;
    }
    ReliefPlane plane;
    plane.options_ = options;
    plane.texels_ = {tile.cols(), tile.rows()};
    plane.heights_ = with_border(tile, options.border);
    plane.pyramid_ = terrain::MinMaxPyramid(plane.heights_.view());
    return plane;
}

std::optional<ReliefHit> ReliefPlane::first_hit(const Ray& ray, Interval range) const {
    const Ray tile_ray = on_tile(ray);
    if (!is_finite(tile_ray)) {
        return std::nullopt;
    }
    Box reach{glm::dvec3(-infinity), glm::dvec3(infinity)};
    if (options_.border == Border::discard) {
        reach = {{-0.5, -0.5, -infinity}, {texels_.x - 0.5, texels_.y - 0.5, infinity}};
    }
    const auto over_plane = intersect(tile_ray, reach, range);
    const auto inside = over_plane ? intersect(tile_ray, slab(), *over_plane) : std::nullopt;
    if (!inside) {
        return std::nullopt;
    }
    const auto side =
        tile_ray.at(over_plane->begin).z > 1.0 ? terrain::Side::above : terrain::Side::unknown;
    TileRay walk(heights_, pyramid_, texels_, tile_ray, side);
    const auto t = options_.border == Border::wrap ? walk.first_hit_wrapped(*inside)
                                                   : walk.first_hit_clamped(*inside);
    return t ? std::optional(met(tile_ray, *t)) : std::nullopt;
}

// In texels from the centre of the first one, and height of the tile.
Ray ReliefPlane::on_tile(const Ray& ray) const {
    const glm::dvec3 per_metre(texels_.x / options_.width, -texels_.y / options_.width,
                               1.0 / (options_.scale * options_.width));
    const glm::dvec3 middle(0.5 * glm::dvec2(texels_) - 0.5, -options_.offset);
    return {middle + ray.origin * per_metre, ray.direction * per_metre};
}

ReliefHit ReliefPlane::met(const Ray& tile_ray, double t) const {
    const glm::dvec3 place = tile_ray.at(t);
    const glm::dvec2 coordinate = (glm::dvec2(place) + 0.5) / glm::dvec2(texels_);
    return {options_.border == Border::wrap ? wrapped(coordinate)
                                            : glm::clamp(coordinate, 0.0, 1.0),
            std::clamp(place.z, 0.0, 1.0), t};
}

} // namespace reljef::truth
