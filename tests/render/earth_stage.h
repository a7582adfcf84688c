#pragma once

#include <cmath>
#include <utility>

#include <glm/common.hpp>

#include "engine/core/bilinear.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "tests/render/made_scene.h"
#include "tests/terrain/made_heightfield.h"

namespace reljef::test {

/// Mountains and valleys, 2 to 70 samples wide.
inline Grid<float> mountains(int side) {
    return made_heights(side, side, [](int col, int row) {
        return 900.0 + 500.0 * std::sin(0.09 * col) * std::cos(0.07 * row) +
               120.0 * std::sin(0.5 * col + 0.3 * row) + 30.0 * std::sin(1.9 * col - 1.1 * row);
    });
}

/// Where a terrain of mountains lies on the Earth.
struct EarthPlace {
    double latitude = 45.0; ///< of its first sample
    double step = 0.001;    ///< degrees
    double turn = 0.0;      ///< degrees
    double exaggeration = 1.0;
    double longitude = 7.0;
    terrain::PlacementKind placement = terrain::PlacementKind::ellipsoid;
};

/// A terrain that is looked at on the ellipsoid.
struct EarthStage {
    static constexpr int side = 257; ///< samples

    scene::Scene scene;
    scene::Node* terrain = nullptr;
    scene::Node* camera = nullptr;

    explicit EarthStage(const EarthPlace& place) : EarthStage(place, mountains(side)) {}
    EarthStage(const EarthPlace& place, Grid<float> heights)
        : EarthStage(geographic_heightfield(std::move(heights), place.latitude, place.longitude,
                                            place.step, place.turn),
                     {.placement = place.placement, .exaggeration = place.exaggeration}) {}
    EarthStage(terrain::Heightfield heightfield, const scene::TerrainOptions& options) {
        terrain = &add_terrain(scene, std::move(heightfield), {}, options);
        camera = &scene.add_camera({});
    }

    [[nodiscard]] const scene::TerrainSurface& surface() const { return surface_of(*terrain); }
    [[nodiscard]] glm::dvec3 world(glm::dvec3 sample) const {
        return surface().placement().world_from_sample(sample);
    }
    void set(const scene::Technique& technique) {
        terrain->get<scene::TerrainNode>()->material.technique = technique;
    }
    void look(const scene::Camera& at) {
        *camera->get<scene::Camera>() = at;
        truth_ = {};
    }

    /// From `above` metres over a sample, to a place on the ground.
    void look(glm::dvec2 from, double above, glm::dvec2 to) {
        const auto height = [&](glm::dvec2 sample) {
            return terrain::bilinear_height(
                surface().heightfield().heights.view(),
                glm::clamp(sample, glm::dvec2(0.0), glm::dvec2(side - 1.0)));
        };
        scene::Camera at;
        at.eye = world({from, height(from) + above});
        at.target = world({to, height(to)});
        at.near = 0.01;
        look(at);
    }

    /// Degrees and metres, `down` from the horizontal.
    void look_from(geo::Geodetic place, double azimuth, double down) {
        const terrain::Placement& placement = surface().placement();
        scene::Camera at;
        at.eye = placement.world_from_geodetic(place).value();
        const scene::Compass compass{placement.up(at.eye), placement.north(at.eye)};
        const scene::Camera turned = scene::camera_from_angles(at.eye, azimuth, -down, compass);
        at.target = turned.target;
        at.up = turned.up;
        at.near = 0.01;
        look(at);
    }

    /// The exact picture of what is looked at. Techniques of the same view share it, so the terrain
    /// must not change before the next look().
    [[nodiscard]] const HitBuffer& true_hits(glm::ivec2 size) const {
        if (glm::ivec2(truth_.cols(), truth_.rows()) != size) {
            truth_ = must(truth::draw_hits(scene, size));
        }
        return truth_;
    }
    [[nodiscard]] truth::GeometricErrors errors(const HitBuffer& shown) const {
        const truth::SurfaceView view{surface().heightfield().heights.view(), surface().placement(),
                                      terrain->world_from_local(), scene.camera()};
        return must(truth::geometric_errors(view, shown,
                                            true_hits(glm::ivec2(shown.cols(), shown.rows()))));
    }

private:
    mutable HitBuffer truth_;
};

} // namespace reljef::test
