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
// A ray along the plane never leaves the slab.
constexpr double max_time = 1e300;

Result<void> check_tile(GridView<const float> tile) {
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
    return {};
}

// wrap: repeats the first texels behind the last; else the tile, at least 2×2.
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

// The heights 0 … 1 with a margin for rays on its faces.
Box slab() {
    constexpr double margin = 0.01;
    return {{-infinity, -infinity, -margin}, {infinity, infinity, 1.0 + margin}};
}

class TileWalk {
public:
    TileWalk(const Grid<float>& heights, const terrain::MinMaxPyramid& pyramid, glm::ivec2 texels,
             const Ray& ray, terrain::Side side)
        : heights_(heights), pyramid_(pyramid), texels_(texels), ray_(ray), side_(side) {}

    std::optional<double> first_hit_wrapped(Interval range) {
        const glm::dvec2 size(texels_);
        return first_in_squares(ray_, size, range, ReliefPlane::max_copies,
                                [&](glm::dvec2 copy, Interval part) {
                                    Ray moved = ray_;
                                    moved.origin -= glm::dvec3(copy * size, 0.0);
                                    return followed(moved, part);
                                });
    }

    // Beyond the outermost texels the relief does not change: the ray's way is clamped there.
    std::optional<double> first_hit_clamped(Interval range) {
        const glm::dvec2 last = glm::dvec2(texels_) - 1.0;
        std::array<double, 6> breaks{range.begin,     time_at(0, 0.0),    time_at(0, last.x),
                                     time_at(1, 0.0), time_at(1, last.y), range.end};
        for (double& t : breaks) {
            t = std::clamp(t, range.begin, range.end);
        }
        std::sort(breaks.begin(), breaks.end());
        for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
            const Interval part{breaks[i], std::min(breaks[i + 1], max_time)};
            if (const auto hit = followed(clamped(0.5 * (part.begin + part.end)), part)) {
                return hit;
            }
        }
        return std::nullopt;
    }

private:
    std::optional<double> followed(const Ray& ray, Interval range) {
        const terrain::Stretch stretch =
            terrain::follow({heights_.view(), &pyramid_}, ray, range, side_);
        side_ = stretch.side;
        return stretch.hit ? std::optional(stretch.hit->t) : std::nullopt;
    }

    // Infinite if the ray does not move along the axis.
    [[nodiscard]] double time_at(int axis, double place) const {
        if (ray_.direction[axis] == 0.0) {
            return infinity;
        }
        const double time = (place - ray_.origin[axis]) / ray_.direction[axis];
        return std::isnan(time) ? infinity : time;
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

Result<void> check_options(const ReliefOptions& options) {
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
    return {};
}

Ray tile_ray(const Ray& ray, glm::ivec2 texels, const ReliefOptions& options) {
    const glm::dvec3 per_metre(texels.x / options.width, -texels.y / options.width,
                               1.0 / (options.scale * options.width));
    const glm::dvec3 middle(0.5 * glm::dvec2(texels) - 0.5, -options.offset);
    return {middle + ray.origin * per_metre, ray.direction * per_metre};
}

ReliefHit hit_at(const Ray& tile_ray, double t, glm::ivec2 texels, Border border) {
    const glm::dvec3 place = tile_ray.at(t);
    const glm::dvec2 coordinate = (glm::dvec2(place) + 0.5) / glm::dvec2(texels);
    const glm::dvec2 part = glm::fract(coordinate); // 1 for tiny negative coordinates
    const glm::dvec2 wrapped{part.x < 1.0 ? part.x : 0.0, part.y < 1.0 ? part.y : 0.0};
    return {border == Border::wrap ? wrapped : glm::clamp(coordinate, 0.0, 1.0),
            std::clamp(place.z, 0.0, 1.0), t};
}

Result<ReliefPlane> ReliefPlane::create(GridView<const float> tile, const ReliefOptions& options) {
    if (const auto good = check_options(options); !good) {
        return good.error();
    }
    if (const auto good = check_tile(tile); !good) {
        return good.error();
    }
    ReliefPlane plane;
    plane.options_ = options;
    plane.texels_ = {tile.cols(), tile.rows()};
    plane.heights_ = with_border(tile, options.border);
    plane.pyramid_ = terrain::MinMaxPyramid(plane.heights_.view());
    return plane;
}

std::optional<ReliefHit> ReliefPlane::first_hit(const Ray& ray, Interval range) const {
    const Ray on_tile = tile_ray(ray, texels_, options_);
    if (!is_finite(on_tile)) {
        return std::nullopt;
    }
    Box reach{glm::dvec3(-infinity), glm::dvec3(infinity)};
    if (options_.border == Border::discard) {
        reach = {{-0.5, -0.5, -infinity}, {texels_.x - 0.5, texels_.y - 0.5, infinity}};
    }
    const auto over_plane = intersect(on_tile, reach, range);
    const auto inside = over_plane ? intersect(on_tile, slab(), *over_plane) : std::nullopt;
    if (!inside) {
        return std::nullopt;
    }
    const auto side =
        on_tile.at(over_plane->begin).z > 1.0 ? terrain::Side::above : terrain::Side::unknown;
    TileWalk walk(heights_, pyramid_, texels_, on_tile, side);
    const auto t = options_.border == Border::wrap ? walk.first_hit_wrapped(*inside)
                                                   : walk.first_hit_clamped(*inside);
    return t ? std::optional(hit_at(on_tile, *t, texels_, options_.border)) : std::nullopt;
}

} // namespace reljef::truth
