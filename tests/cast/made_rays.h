#pragma once

#include <string>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/cast/cast_hits.h"
#include "engine/core/hit.h"
#include "engine/scene/graph/scene.h"
#include "engine/truth/draw.h"
#include "engine/truth/geometric_error.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"

namespace reljef::cast {

/// A terrain on a plane, and a camera.
struct Stage {
    scene::Scene scene;
    scene::Node* terrain = nullptr;
    scene::Node* camera = nullptr;

    explicit Stage(Grid<float> heights, glm::dvec2 spacing = {1.0, 1.0}, double exaggeration = 1.0,
                   Image color = {}) {
        terrain = &test::add_terrain(
            scene, test::plane_heightfield(std::move(heights), spacing), std::move(color),
            {.placement = terrain::PlacementKind::plane, .exaggeration = exaggeration});
        camera = &scene.add_camera({});
    }

    void look(const scene::Camera& at) { *camera->get<scene::Camera>() = at; }
    [[nodiscard]] const scene::TerrainSurface& surface() const {
        return test::surface_of(*terrain);
    }

    [[nodiscard]] PictureRays rays(glm::ivec2 size) const {
        const terrain::MinMax total = surface().pyramid().total();
        const Grid<float>& heights = surface().heightfield().heights;
        Box bounds;
        bounds.add(glm::dvec3(0.0, 0.0, total.low));
        bounds.add(glm::dvec3(heights.cols() - 1.0, heights.rows() - 1.0, total.high));
        scene::Camera seen = scene.camera();
        if (seen.projection == scene::ProjectionKind::orthographic) {
            seen = scene::with_fitted_depth(seen, scene.root().world_bounds());
        }
        return picture_rays(seen, size, terrain->world_from_local(), surface().placement(), bounds);
    }

    [[nodiscard]] HitBuffer cast(glm::ivec2 size, const CastOptions& options = {}) const {
        const RayTile tile(surface().heightfield().heights.view());
        return test::must(cast_hits(tile, rays(size), options));
    }

    [[nodiscard]] HitBuffer truth(glm::ivec2 size) const {
        return test::must(truth::draw_hits(scene, size));
    }

    [[nodiscard]] truth::GeometricErrors errors(const HitBuffer& shown,
                                                const HitBuffer& true_hits) const {
        const truth::SurfaceView view{surface().heightfield().heights.view(), surface().placement(),
                                      terrain->world_from_local(), scene.camera()};
        return test::must(truth::geometric_errors(view, shown, true_hits));
    }
};

} // namespace reljef::cast
