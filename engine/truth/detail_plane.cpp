#include "engine/truth/detail_plane.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::truth {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
// Start of a shadow ray, in texels: above the rounding error of a hit, below any visible shadow
// edge.
constexpr double shadow_start = 1e-4;

ReliefOptions relief_options(const DetailSquare& square, double width) {
    return {width, square.scale, square.offset, Border::wrap};
}

// Bilinear between texel centres; wraps.
template <class T, class Value>
auto tile_value(const Grid<T>& map, glm::dvec2 coordinate, const Value& value) {
    const glm::dvec2 place = coordinate * glm::dvec2(map.cols(), map.rows()) - 0.5;
    const glm::ivec2 cell(glm::floor(place));
    const glm::vec2 part(place - glm::dvec2(cell));
    const auto at = [&](int right, int down) {
        return value(map(material::index_beyond(cell.x + right, map.cols(), Border::wrap),
                         material::index_beyond(cell.y + down, map.rows(), Border::wrap)));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), part.x), glm::mix(at(0, 1), at(1, 1), part.x),
                    part.y);
}

// The shorter way between two places of a repeated tile, texels.
glm::dvec2 shortest_way(glm::dvec2 way, glm::dvec2 texels) {
    return way - texels * glm::round(way / texels);
}

Interval depth_range(const scene::Camera& camera) {
    return camera.projection == scene::ProjectionKind::orthographic
               ? Interval{camera.orthographic_near, camera.orthographic_far}
               : Interval{camera.near, infinite};
}

} // namespace

Result<DetailPlane> DetailPlane::create(DetailSquare square) {
    DetailPlane plane;
    plane.square_ = std::move(square);
    const DetailSquare& made = plane.square_;
    plane.texels_ = {made.set->heights.cols(), made.set->heights.rows()};
    plane.width_ = made.side / made.repeats;
    plane.center_ = {0.5 * (plane.width_ - made.side), 0.5 * (made.side - plane.width_), 0.0};
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

std::optional<ReliefHit> DetailPlane::first_hit(const Ray& ray, Interval range) const {
    const Ray moved{ray.origin - center_, ray.direction};
    if (const auto* const relief = std::get_if<ReliefPlane>(&surface_)) {
        return relief->first_hit(moved, range);
    }
    return std::get_if<LayeredPlane>(&surface_)->first_hit(moved, range);
}

// The square is a window; a surface without layers is invisible from behind.
std::optional<ReliefHit> DetailPlane::seen(const scene::Camera& camera, const Ray& ray) const {
    const glm::dvec3 entry = ray.at(-ray.origin.z / ray.direction.z);
    const bool crosses = std::max(std::abs(entry.x), std::abs(entry.y)) <= 0.5 * square_.side;
    return crosses && (ray.direction.z < 0.0 || square_.layers)
               ? first_hit(ray, depth_range(camera))
               : std::nullopt;
}

// v and the normals' second component grow against y.
glm::dvec3 DetailPlane::normal_at(const ReliefHit& hit) const {
    if (!square_.layers) {
        const glm::vec3 leaning =
            tile_value(square_.set->normals, hit.texture_coordinate, std::identity());
        const double steeper = square_.scale / square_.set->scale;
        return glm::normalize(glm::dvec3(steeper * leaning.x, -steeper * leaning.y, leaning.z));
    }
    const float u =
        tile_value(layer_normals_.along_u, hit.texture_coordinate, std::identity())[hit.layer];
    const float v =
        tile_value(layer_normals_.along_v, hit.texture_coordinate, std::identity())[hit.layer];
    const double upright = std::sqrt(std::max(1.0 - static_cast<double>(u * u + v * v), 1e-4));
    return glm::normalize(glm::dvec3(u, -v, hit.layer % 2 == 0 ? upright : -upright));
}

bool DetailPlane::sees_sun(const Ray& ray, double t) const {
    const double start = shadow_start * width_ / std::max(texels_.x, texels_.y);
    return !first_hit({ray.at(t), scene::to_light(square_.light)}, {start, infinite});
}

// Blinn 1977.
glm::vec3 DetailPlane::color_at(const ReliefHit& hit, const Ray& ray) const {
    const scene::Light& light = square_.light;
    const glm::dvec3 to_sun = scene::to_light(light);
    const glm::dvec3 normal = normal_at(hit);
    const double facing = square_.layers ? 8.0 * glm::dot(normal, to_sun) : 8.0 * to_sun.z;
    const double visible =
        glm::dot(normal, to_sun) > 0.0 && sees_sun(ray, hit.t) ? std::clamp(facing, 0.0, 1.0) : 0.0;
    const double sun = std::max(glm::dot(normal, to_sun), 0.0) * visible;
    const glm::dvec3 half = glm::normalize(to_sun - glm::normalize(ray.direction));
    const double mirrored = std::pow(std::max(glm::dot(normal, half), 0.0),
                                     static_cast<double>(square_.set->shininess));
    const double added = square_.set->specular * visible * mirrored;
    const glm::vec3 albedo =
        tile_value(square_.set->color, hit.texture_coordinate, linear_from_rgba8);
    return albedo * (light.color * static_cast<float>(sun) +
                     light.ambient * static_cast<float>(0.5 + 0.5 * normal.z)) +
           light.color * static_cast<float>(added);
}

Hit DetailPlane::hit_of(const ReliefHit& hit) const {
    const glm::vec2 texel(hit.texture_coordinate * texels_ - 0.5);
    return {texel.x, texel.y, static_cast<float>(hit.height), static_cast<float>(hit.t)};
}

Result<Picture> DetailPlane::draw(const scene::Camera& camera, glm::ivec2 size,
                                  const DrawOptions& options) const {
    check(options.rays_per_side >= 1, "at least one ray a pixel was expected");
    Picture picture{HitBuffer(size.x, size.y), Image(size.x, size.y)};
    const auto color = [&](glm::dvec2 place) {
        const Ray ray = scene::view_ray(camera, size, place);
        const auto hit = seen(camera, ray);
        return hit ? color_at(*hit, ray) : glm::vec3(0.0F);
    };
    const auto done = for_each_pixel(size, options.parallel, [&](glm::ivec2 pixel) {
        const auto hit = seen(camera, scene::view_ray(camera, size, glm::dvec2(pixel) + 0.5));
        picture.hits(pixel.x, pixel.y) = hit ? hit_of(*hit) : Hit{};
        picture.image(pixel.x, pixel.y) =
            rgba8_from_linear(mean_color(pixel, options.rays_per_side, color));
    });
    return done ? Result<Picture>(std::move(picture)) : done.error();
}

double DetailPlane::true_height(glm::dvec2 coordinate, double hit_height) const {
    if (!square_.layers) {
        return tile_value(square_.set->heights, coordinate, std::identity());
    }
    const glm::dvec4 heights(tile_value(layers_.heights(), coordinate, std::identity()));
    double nearest = heights.x;
    for (int layer = 1; layer < 4; ++layer) {
        const bool nearer = std::abs(heights[layer] - hit_height) < std::abs(nearest - hit_height);
        nearest = nearer ? heights[layer] : nearest;
    }
    return nearest;
}

double DetailPlane::reprojection(const scene::Camera& camera, glm::ivec2 size, glm::ivec2 pixel,
                                 const Hit& hit) const {
    const glm::dvec2 center = glm::dvec2(pixel) + 0.5;
    const glm::dvec2 coordinate = (glm::dvec2(hit.col, hit.row) + 0.5) / texels_;
    const double height = true_height(coordinate, static_cast<double>(hit.height));
    const glm::dvec3 place = center_ + glm::dvec3(coordinate.x - 0.5, 0.5 - coordinate.y,
                                                  (height + square_.offset) * square_.scale) *
                                           width_;
    const Ray ray = scene::view_ray(camera, size, center);
    const glm::dvec3 crossing = ray.at((place.z - ray.origin.z) / ray.direction.z);
    const glm::dvec2 copy = glm::round((glm::dvec2(crossing) - glm::dvec2(place)) / width_);
    double min_distance = infinite;
    for (int i = 0; i < 9; ++i) {
        const glm::dvec2 moved = copy + glm::dvec2(i % 3 - 1, i / 3 - 1);
        const auto projected =
            scene::project(camera, size, place + glm::dvec3(moved * width_, 0.0));
        const bool is_seen =
            camera.projection == scene::ProjectionKind::orthographic || projected.depth > 0.0;
        const double distance = glm::length(projected.pixel - center);
        min_distance = is_seen ? std::min(min_distance, distance) : min_distance;
    }
    return min_distance;
}

Result<GeometricErrors> DetailPlane::errors(const scene::Camera& camera, const HitBuffer& shown,
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
