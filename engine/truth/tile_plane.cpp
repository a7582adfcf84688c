#include "engine/truth/tile_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::truth {
namespace {

constexpr double forever = std::numeric_limits<double>::infinity();
// A shadow ray begins so far off its surface, of a texel's width: more than rounding moves a hit,
// less than any shadow's edge that a pixel could show.
constexpr double shadow_start = 1e-4;

ReliefOptions relief_options(const TileSquare& square, double width) {
    return {width, square.scale, square.offset, Border::wrap};
}

int wrapped_texel(int index, int count) {
    return ((index % count) + count) % count;
}

// Bilinear between texel centres, over the border into the next copy.
template <class T, class Value>
auto tile_value(const Grid<T>& map, glm::dvec2 coordinate, const Value& value) {
    const glm::dvec2 place = coordinate * glm::dvec2(map.cols(), map.rows()) - 0.5;
    const glm::ivec2 cell(glm::floor(place));
    const glm::vec2 part(place - glm::dvec2(cell));
    const auto at = [&](int right, int down) {
        return value(map(wrapped_texel(cell.x + right, map.cols()),
                         wrapped_texel(cell.y + down, map.rows())));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), part.x), glm::mix(at(0, 1), at(1, 1), part.x),
                    part.y);
}

glm::vec4 as_it_is(const glm::vec4& heights) {
    return heights;
}

// The shorter way round from one place of a tile to another, texels.
glm::dvec2 shortest_way(glm::dvec2 way, glm::dvec2 texels) {
    return way - texels * glm::round(way / texels);
}

Interval depth_range(const scene::Camera& camera) {
    return camera.projection == scene::ProjectionKind::orthographic
               ? Interval{camera.orthographic_near, camera.orthographic_far}
               : Interval{camera.near, forever};
}

} // namespace

Result<TilePlane> TilePlane::create(TileSquare square) {
    TilePlane plane;
    plane.square_ = std::move(square);
    const TileSquare& made = plane.square_;
    plane.texels_ = {made.set->heights.cols(), made.set->heights.rows()};
    plane.width_ = made.side / made.repeats;
    plane.middle_ = {0.5 * (plane.width_ - made.side), 0.5 * (made.side - plane.width_), 0.0};
    if (!made.layers) {
        auto relief =
            ReliefPlane::create(made.set->heights.view(), relief_options(made, plane.width_));
        if (!relief) {
            return relief.error();
        }
        plane.surface_ = std::move(*relief);
        return plane;
    }
    plane.layers_ = material::layers_of(*made.set, *made.layers);
    plane.layer_normals_ = material::layer_normals(plane.layers_, static_cast<float>(made.scale),
                                                   material::WrapMode::wrap);
    auto layered =
        LayeredPlane::create(plane.layers_.heights().view(), relief_options(made, plane.width_));
    if (!layered) {
        return layered.error();
    }
    plane.surface_ = std::move(*layered);
    return plane;
}

std::optional<TilePlane::Place> TilePlane::first_hit(const Ray& ray, Interval range) const {
    const Ray moved{ray.origin - middle_, ray.direction};
    if (const auto* const relief = std::get_if<ReliefPlane>(&surface_)) {
        const auto hit = relief->first_hit(moved, range);
        return hit ? std::optional(Place{hit->texture_coordinate, hit->height, 0, hit->t})
                   : std::nullopt;
    }
    const auto hit = std::get_if<LayeredPlane>(&surface_)->first_hit(moved, range);
    return hit ? std::optional(Place{hit->texture_coordinate, hit->height, hit->layer, hit->t})
               : std::nullopt;
}

// Through the square as through a window; the back of a surface is not seen.
std::optional<TilePlane::Place> TilePlane::seen(const scene::Camera& camera, const Ray& ray) const {
    const glm::dvec3 entry = ray.at(-ray.origin.z / ray.direction.z);
    const bool crosses = std::max(std::abs(entry.x), std::abs(entry.y)) <= 0.5 * square_.side;
    return crosses && (ray.direction.z < 0.0 || square_.layers)
               ? first_hit(ray, depth_range(camera))
               : std::nullopt;
}

// v grows against y, and so do the normals' second numbers.
glm::dvec3 TilePlane::normal_at(const Place& place) const {
    if (!square_.layers) {
        const glm::vec3 leaning = tile_value(square_.set->normals, place.coordinate,
                                             [](const glm::vec3& normal) { return normal; });
        const double steeper = square_.scale / square_.set->scale;
        return glm::normalize(glm::dvec3(steeper * leaning.x, -steeper * leaning.y, leaning.z));
    }
    const float u = tile_value(layer_normals_.along_u, place.coordinate, as_it_is)[place.layer];
    const float v = tile_value(layer_normals_.along_v, place.coordinate, as_it_is)[place.layer];
    const double upright = std::sqrt(std::max(1.0 - static_cast<double>(u * u + v * v), 1e-4));
    return glm::normalize(glm::dvec3(u, -v, place.layer % 2 == 0 ? upright : -upright));
}

bool TilePlane::sees_sun(const Ray& ray, double t) const {
    const double start = shadow_start * width_ / std::max(texels_.x, texels_.y);
    return !first_hit({ray.at(t), scene::to_light(square_.light)}, {start, forever});
}

// Blinn 1977.
glm::vec3 TilePlane::color_at(const Place& place, const Ray& ray) const {
    const scene::Light& light = square_.light;
    const glm::dvec3 to_sun = scene::to_light(light);
    const glm::dvec3 normal = normal_at(place);
    const double facing = square_.layers ? 8.0 * glm::dot(normal, to_sun) : 8.0 * to_sun.z;
    const double visible = glm::dot(normal, to_sun) > 0.0 && sees_sun(ray, place.t)
                               ? std::clamp(facing, 0.0, 1.0)
                               : 0.0;
    const double sun = std::max(glm::dot(normal, to_sun), 0.0) * visible;
    const glm::dvec3 half = glm::normalize(to_sun - glm::normalize(ray.direction));
    const double mirrored = std::pow(std::max(glm::dot(normal, half), 0.0),
                                     static_cast<double>(square_.set->shininess));
    const double added = square_.set->specular * visible * mirrored;
    const glm::vec3 albedo = tile_value(square_.set->color, place.coordinate, linear_from_rgba8);
    return albedo * (light.color * static_cast<float>(sun) +
                     light.ambient * static_cast<float>(0.5 + 0.5 * normal.z)) +
           light.color * static_cast<float>(added);
}

Hit TilePlane::hit_of(const Place& place) const {
    const glm::vec2 texel(place.coordinate * texels_ - 0.5);
    return {texel.x, texel.y, static_cast<float>(place.height), static_cast<float>(place.t)};
}

Result<Picture> TilePlane::draw(const scene::Camera& camera, glm::ivec2 size,
                                const DrawOptions& options) const {
    check(size.x >= 1 && size.y >= 1, "a picture of at least 1x1 pixels was expected");
    check(options.rays_per_side >= 1, "at least one ray a pixel was expected");
    Picture picture{HitBuffer(size.x, size.y), Image(size.x, size.y)};
    const int n = options.rays_per_side;
    const auto mean_color = [&](glm::dvec2 pixel) {
        glm::vec3 sum(0.0F);
        for (int i = 0; i < n * n; ++i) {
            const glm::dvec2 part = (glm::dvec2(i % n, i / n) + 0.5) / static_cast<double>(n);
            const Ray ray = scene::view_ray(camera, size, pixel + part);
            const auto place = seen(camera, ray);
            sum += place ? color_at(*place, ray) : glm::vec3(0.0F);
        }
        return sum / static_cast<float>(n * n);
    };
    const auto draw_row = [&](int row) {
        for (int col = 0; col < size.x; ++col) {
            const glm::dvec2 pixel(col, row);
            const auto place = seen(camera, scene::view_ray(camera, size, pixel + 0.5));
            picture.hits(col, row) = place ? hit_of(*place) : Hit{};
            picture.image(col, row) = rgba8_from_linear(mean_color(pixel));
        }
    };
    if (!parallel_for(size.y, draw_row, options.parallel)) {
        return Error{"the exact picture: drawing was stopped"};
    }
    return picture;
}

double TilePlane::true_height(glm::dvec2 coordinate, double claimed) const {
    if (!square_.layers) {
        return tile_value(square_.set->heights, coordinate, [](float height) { return height; });
    }
    const glm::dvec4 heights(tile_value(layers_.heights(), coordinate, as_it_is));
    double nearest = heights.x;
    for (int layer = 1; layer < 4; ++layer) {
        const bool nearer = std::abs(heights[layer] - claimed) < std::abs(nearest - claimed);
        nearest = nearer ? heights[layer] : nearest;
    }
    return nearest;
}

double TilePlane::reprojection(const scene::Camera& camera, glm::ivec2 size, glm::ivec2 pixel,
                               const Hit& hit) const {
    const glm::dvec2 center = glm::dvec2(pixel) + 0.5;
    const glm::dvec2 coordinate = (glm::dvec2(hit.col, hit.row) + 0.5) / texels_;
    const double height = true_height(coordinate, static_cast<double>(hit.height));
    const glm::dvec3 place = middle_ + glm::dvec3(coordinate.x - 0.5, 0.5 - coordinate.y,
                                                  (height + square_.offset) * square_.scale) *
                                           width_;
    const Ray ray = scene::view_ray(camera, size, center);
    const glm::dvec3 crossing = ray.at((place.z - ray.origin.z) / ray.direction.z);
    const glm::dvec2 copy = glm::round((glm::dvec2(crossing) - glm::dvec2(place)) / width_);
    double least = forever;
    for (int i = 0; i < 9; ++i) {
        const glm::dvec2 moved = copy + glm::dvec2(i % 3 - 1, i / 3 - 1);
        const auto projected =
            scene::project(camera, size, place + glm::dvec3(moved * width_, 0.0));
        const bool is_seen =
            camera.projection == scene::ProjectionKind::orthographic || projected.depth > 0.0;
        const double off = glm::length(projected.pixel - center);
        least = is_seen && off < least ? off : least;
    }
    return least;
}

Result<GeometricErrors> TilePlane::errors(const scene::Camera& camera, const HitBuffer& shown,
                                          const HitBuffer& truth, unsigned threads) const {
    const glm::ivec2 size(shown.cols(), shown.rows());
    const PixelMeasure measure{[&, size](glm::ivec2 pixel, const Hit& hit) {
                                   return reprojection(camera, size, pixel, hit);
                               },
                               [&](const Hit& one, const Hit& other) {
                                   const glm::dvec2 way(static_cast<double>(one.col) - other.col,
                                                        static_cast<double>(one.row) - other.row);
                                   return glm::length(shortest_way(way, texels_));
                               }};
    return geometric_errors(measure, shown, truth, threads);
}

} // namespace reljef::truth
