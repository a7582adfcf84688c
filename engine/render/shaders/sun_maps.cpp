#include "engine/render/shaders/sun_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/core/check.h"
#include "engine/render/shaders/uniform_blocks.h"
#include "engine/render/shaders/view_values.h"

namespace reljef::render {
namespace {

// Each map reaches so many times farther than the one before: at its near end a texel of 2048 is
// then as wide as four pixels of a picture as wide.
constexpr double reach_of_map = 8.0;

constexpr double border_texels = 2.0; // around what is seen: their comparison reads four texels
constexpr double min_sine = 1e-6;     // of the height of a sun that lights level ground
constexpr double min_volume = 1e-12;  // of three unit vectors: flatter ones have no common point

// Everything here is relative to the eye, along the axes of the sun: x and y across, z to it.

// dot(normal, p) + offset >= 0
struct Plane {
    glm::dvec3 normal{0.0};
    double offset = 0.0;

    [[nodiscard]] double above(glm::dvec3 p) const { return glm::dot(normal, p) + offset; }
};

// The space that casters may shade: from them along the rays of the sun, and not higher or lower
// than what there is.
struct Shaded {
    Box box;
    std::array<Plane, 2> heights;
};

struct View {
    std::vector<Plane> sides; // of the whole picture
    glm::dvec3 forward{0.0};
};

glm::dmat3 sun_from_world(glm::dvec3 to_sun) {
    const glm::dvec3 beside =
        std::abs(to_sun.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 x = glm::normalize(glm::cross(beside, to_sun));
    return glm::transpose(glm::dmat3(x, glm::cross(to_sun, x), to_sun));
}

View view_of(const view::DrawList& list, const glm::dmat3& turn) {
    const scene::Camera camera = scene::camera_of_whole(list.camera, list.size);
    const glm::ivec2 size = scene::whole_picture(list.camera, list.size);
    View view;
    const glm::dvec2 extent(size);
    const std::array corners{glm::dvec2(0.0), glm::dvec2(0.0, extent.y), extent,
                             glm::dvec2(extent.x, 0.0)}; // counter-clockwise
    std::array<Ray, 4> edges;
    std::transform(corners.begin(), corners.end(), edges.begin(), [&](glm::dvec2 corner) {
        const Ray ray = scene::view_ray(camera, size, corner);
        return Ray{turn * (ray.origin - camera.eye), turn * ray.direction};
    });
    view.forward = turn * scene::view_axes(camera).forward;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Ray& one = edges.at(i);
        const Ray& next = edges.at((i + 1) % edges.size());
        const glm::dvec3 across = (next.origin + next.direction) - one.origin;
        const glm::dvec3 normal = glm::normalize(glm::cross(across, one.direction));
        view.sides.push_back({normal, -glm::dot(normal, one.origin)});
    }
    return view;
}

Box turned(const Box& world, const glm::dmat3& turn, glm::dvec3 eye) {
    return world.empty() ? Box()
                         : transformed(glm::dmat4(turn), {world.low - eye, world.high - eye});
}

using Corners = std::vector<glm::dvec3>;

void add_sides(const Box& box, std::vector<Plane>& planes) {
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 normal(0.0);
        normal[axis] = 1.0;
        planes.push_back({normal, -box.low[axis]});
        planes.push_back({-normal, box.high[axis]});
    }
}

std::optional<glm::dvec3> common_point(const Plane& a, const Plane& b, const Plane& c) {
    const glm::dvec3 across = glm::cross(b.normal, c.normal);
    const double volume = glm::dot(a.normal, across);
    if (!(std::abs(volume) > min_volume)) {
        return std::nullopt;
    }
    return -(a.offset * across + b.offset * glm::cross(c.normal, a.normal) +
             c.offset * glm::cross(a.normal, b.normal)) /
           volume;
}

// Of the solid above all planes, which is no larger than `size`.
Corners corners_of(const std::vector<Plane>& planes, double size) {
    constexpr double rounding = 1e-9;
    Corners corners;
    const auto add_if_inside = [&](const std::optional<glm::dvec3>& point) {
        if (point && std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
                return plane.above(*point) >= -rounding * size;
            })) {
            corners.push_back(*point);
        }
    };
    for (std::size_t i = 0; i < planes.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            for (std::size_t k = 0; k < j; ++k) {
                add_if_inside(common_point(planes[i], planes[j], planes[k]));
            }
        }
    }
    return corners;
}

// Of the part of the shaded space that is seen between two depths.
Corners seen_corners(const Shaded& shaded, const View& view, Interval depths) {
    std::vector<Plane> planes = view.sides;
    add_sides(shaded.box, planes);
    planes.insert(planes.end(), shaded.heights.begin(), shaded.heights.end());
    if (std::isfinite(depths.begin)) {
        planes.push_back({view.forward, -depths.begin});
    }
    if (std::isfinite(depths.end)) {
        planes.push_back({-view.forward, depths.end});
    }
    return corners_of(planes, glm::length(shaded.box.size()) + glm::length(shaded.box.center()));
}

Interval depths_of(const Corners& corners, glm::dvec3 forward) {
    Interval depths{std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity()};
    for (const glm::dvec3 corner : corners) {
        const double depth = glm::dot(corner, forward);
        depths = {std::min(depths.begin, depth), std::max(depths.end, depth)};
    }
    return depths;
}

// Widths of texels and their places in the world change in steps, so that edges of shadows do not
// crawl while the view moves.
struct MapAxis {
    double low = 0.0;
    double texel = 1.0;
};
MapAxis map_axis(double low, double high, double eye, int side) {
    constexpr double steps = 4.0; // from a width to twice of it
    const double needed = std::max((high - low) / (side - 2.0 * border_texels - 1.0), 1e-6);
    const double texel = std::exp2(std::ceil(std::log2(needed) * steps) / steps);
    const double first = std::floor((low + eye) / texel) - border_texels;
    return {first * texel - eye, texel};
}

SunMap map_over(const Corners& corners, const Box& casters, glm::dvec3 eye, int side) {
    Box box;
    for (const glm::dvec3 corner : corners) {
        box.add(corner);
    }
    const MapAxis x = map_axis(box.low.x, box.high.x, eye.x, side);
    const MapAxis y = map_axis(box.low.y, box.high.y, eye.y, side);
    SunMap map;
    map.texel = std::hypot(x.texel, y.texel);
    // A texel's depth of margin, so that no caster is cut off by what rounds.
    const double low = casters.low.z - map.texel;
    map.metres = casters.high.z + map.texel - low;
    const glm::dvec3 scale(1.0 / (side * x.texel), 1.0 / (side * y.texel), 1.0 / map.metres);
    map.map_from_relative =
        glm::dmat4(glm::dvec4(scale.x, 0.0, 0.0, 0.0), glm::dvec4(0.0, scale.y, 0.0, 0.0),
                   glm::dvec4(0.0, 0.0, scale.z, 0.0),
                   glm::dvec4(-scale * glm::dvec3(x.low, y.low, low), 1.0));
    return map;
}

Box world_bounds(const view::MeshDraw& draw) {
    return transformed(draw.world_from_local, draw.local_bounds);
}

Shaded shaded_by(const Box& casters, const view::DrawList& list, const glm::dmat3& turn) {
    Box world;
    for (const view::MeshDraw& draw : shadow_casters(list)) {
        world.add(world_bounds(draw));
    }
    Shaded shaded{casters, {}};
    for (const view::TerrainDraw& draw : list.terrains) {
        const Box bounds = transformed(draw.world_from_local, draw.terrain->surface->bounds());
        world.add(bounds);
        shaded.box.low.z = std::min(shaded.box.low.z, turned(bounds, turn, list.camera.eye).low.z);
    }
    const glm::dvec3 up = turn * glm::dvec3(0.0, 0.0, 1.0);
    shaded.heights = {Plane{up, list.camera.eye.z - world.low.z},
                      Plane{-up, world.high.z - list.camera.eye.z}};
    return shaded;
}

} // namespace

bool casts_shadows(const view::TerrainDraw& draw) {
    return draw.terrain->material.technique.options.shadow.has_value();
}

bool casts_mesh_shadows(const view::DrawList& list) {
    const bool is_requested =
        std::any_of(list.terrains.begin(), list.terrains.end(), casts_shadows);
    return is_requested && list.sun && scene::to_light(*list.sun).z > min_sine;
}

bool is_shadow_caster(const view::MeshDraw& draw) {
    const scene::Material& material = draw.mesh->material;
    const bool has_own_outline =
        material.detail.set != nullptr && (material.technique.options.true_silhouettes ||
                                           scene::searches_layers(material.technique.id()));
    return !draw.from_behind && !has_own_outline && !view::drawn_mesh(draw)->indices.empty();
}

std::vector<view::MeshDraw> shadow_casters(const view::DrawList& list) {
    std::vector<view::MeshDraw> casters;
    for (const auto* const draws : {&list.meshes, &list.meshes_beside}) {
        std::ranges::copy_if(*draws, std::back_inserter(casters), is_shadow_caster);
    }
    return casters;
}

std::vector<SunMap> sun_maps(const view::DrawList& list, int side) {
    if (!casts_mesh_shadows(list)) {
        return {};
    }
    const glm::dmat3 turn = sun_from_world(scene::to_light(*list.sun));
    const glm::dvec3 eye = list.camera.eye;
    Box casters;
    for (const view::MeshDraw& draw : shadow_casters(list)) {
        casters.add(turned(world_bounds(draw), turn, eye));
    }
    if (casters.empty()) {
        return {};
    }
    const View view = view_of(list, turn);
    const Shaded shaded = shaded_by(casters, list, turn);
    const bool is_map = !is_perspective(list.camera);
    const double infinity = std::numeric_limits<double>::infinity();
    const Corners seen =
        seen_corners(shaded, view, {is_map ? -infinity : list.camera.near, infinity});
    if (seen.empty()) {
        return {};
    }
    const Interval depths = depths_of(seen, view.forward);
    std::vector<SunMap> maps;
    double end = depths.end;
    std::vector<Interval> parts;
    while (parts.size() + 1 < max_sun_maps && !is_map && end > reach_of_map * depths.begin) {
        parts.push_back({end / reach_of_map, end});
        end /= reach_of_map;
    }
    parts.push_back({depths.begin, end});
    for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
        const Corners corners = seen_corners(shaded, view, *part);
        if (!corners.empty()) {
            maps.push_back(map_over(corners, casters, turn * eye, side));
            maps.back().map_from_relative = maps.back().map_from_relative * glm::dmat4(turn);
        }
    }
    return maps;
}

MeshShadowBlock mesh_shadow_block(const std::vector<SunMap>& maps) {
    check(maps.size() <= max_sun_maps, "at most four maps");
    MeshShadowBlock block{};
    block.mesh_shadow_numbers = glm::vec4(static_cast<float>(maps.size()), 0.0F, 0.0F, 0.0F);
    for (std::size_t i = 0; i < maps.size(); ++i) {
        block.mesh_shadow_maps[i] = glm::mat4(maps[i].map_from_relative);
        block.mesh_shadow_texels[i] = glm::vec4(static_cast<float>(maps[i].texel),
                                                static_cast<float>(maps[i].metres), 0.0F, 0.0F);
    }
    return block;
}

} // namespace reljef::render
