#include "engine/view/facade_view.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/terrain/field/gradient.h"
#include "engine/terrain/light/sun_visibility.h"
#include "engine/view/grain_view.h"

namespace reljef::view {
namespace {

constexpr double before_wall = 1.5; // samples: where the ground does not rise to the wall yet

// Away from the building, in samples: columns, rows; of length 1.
glm::dvec2 outward(const terrain::Facade& wall) {
    const glm::dvec2 way = glm::normalize(wall.end - wall.begin);
    return {way.y, -way.x};
}

class WallLooks {
public:
    WallLooks(const scene::TerrainSurface& surface, const glm::dmat4& world_from_local,
              const std::optional<scene::TerrainLight>& light)
        : spacing_(surface.placement().spacing()), directions_(world_from_local) {
        if (light) {
            to_sun_ = scene::to_light(light->sun);
        }
    }

    [[nodiscard]] FacadeTexels of(const terrain::Facade& wall) const {
        const glm::dvec2 way = wall.end - wall.begin;
        const double windows = wall.windows.y - wall.windows.x;
        const glm::dvec2 per_sample = way * (windows / glm::dot(way, way));
        const glm::dvec2 away = outward(wall) / spacing_;
        const glm::dvec3 normal =
            glm::normalize(directions_ * glm::dvec3(away.x, -away.y, 0.0)); // rows go south
        const double metres = glm::length(way * spacing_);
        const glm::dvec2 normal_turned(turned(normal));
        return {.along = {wall.begin, per_sample},
                .storeys = {wall.windows.x, wall.foot + wall.eaves, wall.storeys / wall.eaves,
                            metres / windows},
                .facing = {normal_turned, std::max(glm::dot(normal, to_sun_), 0.0),
                           wall.foot + wall.eaves + wall.rise},
                .plaster = {linear_from_rgba8(wall.plaster), wall.foot}};
    }

private:
    glm::dvec2 spacing_;
    glm::dmat3 directions_;
    glm::dvec3 to_sun_{0.0};
};

// The sample before a wall, beside another one near it.
glm::ivec2 sample_before(const terrain::Facade& wall, glm::ivec2 sample, glm::ivec2 last) {
    const glm::dvec2 normal = outward(wall);
    const double away = glm::dot(glm::dvec2(sample) - wall.begin, normal);
    const glm::dvec2 place = glm::dvec2(sample) + (before_wall - away) * normal;
    return glm::clamp(glm::ivec2(glm::round(place)), glm::ivec2(0), last);
}

// Along the axes of the grid.
glm::dvec3 local_to_sun(const scene::TerrainSurface& surface, const scene::TerrainLight& light) {
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::dvec2 middle = 0.5 * glm::dvec2(heights.cols() - 1, heights.rows() - 1);
    return glm::inverse(light.world_from_local) * scene::to_light(light.sun) *
           terrain::grid_axes(surface.heightfield(), surface.placement(), middle);
}

// Of the samples near walls.
void add_shadows(const terrain::Facades& facades, const Grid<float>& heights,
                 Grid<glm::vec2>& samples) {
    const glm::ivec2 last(samples.cols() - 1, samples.rows() - 1);
    for (int row = 0; row < samples.rows(); ++row) {
        for (int col = 0; col < samples.cols(); ++col) {
            if (const auto nearest = static_cast<std::size_t>(samples(col, row).x); nearest != 0) {
                const glm::ivec2 at = sample_before(facades.walls[nearest - 1], {col, row}, last);
                samples(col, row).y = heights(at.x, at.y);
            }
        }
    }
}

} // namespace

bool shows_facades(const scene::TerrainNode& terrain) {
    const terrain::Facades& facades = terrain.surface->terrain().facades;
    const Grid<float>& heights = terrain.surface->heightfield().heights;
    const bool has_facades = !facades.walls.empty() && facades.wall_at.cols() == heights.cols() &&
                             facades.wall_at.rows() == heights.rows();
    return has_facades && !terrain.hides_overlay &&
           terrain.surface->placement().kind() == terrain::PlacementKind::plane;
}

FacadeMap facade_map(const scene::TerrainSurface& surface, const glm::dmat4& world_from_local,
                     const std::optional<scene::TerrainLight>& light) {
    const terrain::Facades& facades = surface.terrain().facades;
    FacadeMap map;
    const WallLooks looks(surface, world_from_local, light);
    std::transform(facades.walls.begin(), facades.walls.end(), std::back_inserter(map.walls),
                   [&](const terrain::Facade& wall) { return looks.of(wall); });
    map.samples = Grid<glm::vec2>(facades.wall_at.cols(), facades.wall_at.rows());
    std::transform(facades.wall_at.samples().begin(), facades.wall_at.samples().end(),
                   map.samples.samples().begin(), [&](std::uint32_t number) {
                       return glm::vec2(number <= facades.walls.size() ? number : 0U, 0.0F);
                   });
    map.sky = glm::vec3(1.0F);
    if (light) {
        const glm::dvec3 to_sun = local_to_sun(surface, *light);
        map.sun = to_sun.z > 0.0 ? light->sun.color : glm::vec3(0.0F);
        map.sky = 0.5F * light->sun.ambient; // the half above the horizon
        const terrain::Heightfield& field = surface.heightfield();
        add_shadows(facades,
                    terrain::shadow_heights(field.heights.view(), field.spacing,
                                            surface.placement().exaggeration(), to_sun),
                    map.samples);
    }
    return map;
}

} // namespace reljef::view
