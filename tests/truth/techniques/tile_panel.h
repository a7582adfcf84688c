#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "engine/render/driver.h"
#include "engine/truth/relief_plane.h"
#include "tests/gl/gl_fixture.h"
#include "tests/render/made_scene.h"
#include "tests/session/made_session.h"
#include "tests/terrain/chance.h"

namespace reljef::truth {

using material::WrapMode;

inline constexpr glm::ivec2 mesh_picture{240, 180};
inline constexpr float plane_side = 6.0F; // metres

inline Grid<float> noise_tile(int cols, int rows, unsigned seed) {
    test::Chance chance(seed);
    Grid<float> heights(cols, rows);
    for (float& height : heights.samples()) {
        height = static_cast<float>(chance.between(0.0, 1.0));
    }
    return heights;
}

// Smooth, and it fits together at its borders.
inline Grid<float> wave_tile(int side) {
    Grid<float> heights(side, side);
    const double step = 2.0 * std::acos(-1.0) / side;
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            heights(col, row) = static_cast<float>(0.5 + 0.3 * std::sin(step * col) +
                                                   0.2 * std::cos(step * (2 * row + col)));
        }
    }
    return heights;
}

struct MadeTile {
    std::string name;
    Grid<float> heights;
};

// Where a search goes wrong: one thing to find, steps, points, any size, no neighbours.
inline std::vector<MadeTile> hard_tiles() {
    std::vector<MadeTile> tiles;
    tiles.push_back({"waves", wave_tile(32)});
    tiles.push_back({"noise", noise_tile(16, 16, 3)});
    tiles.push_back({"odd noise", noise_tile(13, 7, 4)});
    Grid<float> spike(17, 33, 0.0F);
    spike(16, 0) = 1.0F;
    tiles.push_back({"spike", std::move(spike)});
    Grid<float> cliffs(24, 20, 0.0F);
    for (int row = 0; row < 20; ++row) {
        for (int col = 0; col < 24; ++col) {
            cliffs(col, row) = (col / 5 + row / 7) % 2 == 0 ? 1.0F : 0.1F;
        }
    }
    tiles.push_back({"cliffs", std::move(cliffs)});
    Grid<float> post(13, 7, 0.0F); // just behind the border, whose block reaches beyond it
    post(1, 3) = 1.0F;
    tiles.push_back({"post", std::move(post)});
    tiles.push_back({"one", Grid<float>(1, 1, 0.7F)});
    tiles.push_back({"row", noise_tile(9, 1, 5)});
    tiles.push_back({"lowest", Grid<float>(5, 5, 0.0F)});
    tiles.push_back({"highest", Grid<float>(5, 5, 1.0F)});
    return tiles;
}

inline std::shared_ptr<const material::ReliefMaterial>
made_set(Grid<float> heights, float scale = 0.1F, float specular = 0.0F) {
    material::ReliefMaterial set;
    set.name = "made";
    set.heights = std::move(heights);
    set.color = Image(4, 4, Rgba8{128, 128, 128, 255});
    set.scale = scale;
    set.specular = specular;
    return std::make_shared<const material::ReliefMaterial>(
        material::completed(std::move(set), WrapMode::wrap).value());
}

// Four layers that fall; here and there one of the solids is a hole.
inline Grid<glm::vec4> layered_noise(int cols, int rows, unsigned seed) {
    test::Chance chance(seed);
    Grid<glm::vec4> layers(cols, rows);
    for (glm::vec4& heights : layers.samples()) {
        const auto between = [&](double low, double high) {
            return static_cast<float>(chance.between(low, high));
        };
        heights = {between(0.75, 1.0), between(0.55, 0.7), between(0.3, 0.45), between(0.0, 0.2)};
        heights.y = chance.one_in(4) ? heights.x : heights.y;
        heights.z = chance.one_in(4) ? heights.w : heights.z;
    }
    return layers;
}

// Bilinear between texel centres, as GL samples.
inline glm::dvec4 layers_at(const Grid<glm::vec4>& layers, glm::dvec2 coordinate, WrapMode border) {
    const glm::ivec2 size(layers.cols(), layers.rows());
    const glm::dvec2 place = coordinate * glm::dvec2(size) - 0.5;
    const glm::ivec2 cell(glm::floor(place));
    const glm::dvec2 part = place - glm::dvec2(cell);
    const auto at = [&](int right, int down) {
        glm::ivec2 texel = cell + glm::ivec2(right, down);
        texel = border == WrapMode::wrap ? ((texel % size) + size) % size
                                         : glm::clamp(texel, glm::ivec2(0), size - 1);
        return glm::dvec4(layers(texel.x, texel.y));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), part.x), glm::mix(at(0, 1), at(1, 1), part.x),
                    part.y);
}

// Panels that share one compile each program once.
inline std::shared_ptr<session::SceneRenderer> panel_driver() {
    return std::make_shared<session::SceneRenderer>(test::must(test::make_renderer(mesh_picture)));
}

// A level square with a tile on it, and the exact relief of that tile.
struct Panel {
    scene::Scene scene;
    scene::Node* node = nullptr;
    scene::Node* camera = nullptr;
    glm::ivec2 texels{0};
    std::shared_ptr<session::SceneRenderer> driver;

    explicit Panel(Grid<float> heights, float repeats = 3.0F,
                   std::shared_ptr<session::SceneRenderer> shared = panel_driver())
        : driver(std::move(shared)) {
        texels = {heights.cols(), heights.rows()};
        scene::Material material;
        material.detail.set = made_set(std::move(heights));
        material.detail.scale = 0.1F;
        material.detail.repeats = glm::vec2(repeats);
        node = &scene.add_mesh(scene::plane_mesh(glm::vec2(plane_side)), material);
        camera = &scene.add_camera({});
        look({0.3, -4.0, 3.0}, {0.1, 0.0, 0.0});
    }
    void look(glm::dvec3 eye, glm::dvec3 at) {
        *camera->get<scene::Camera>() = test::camera_at(eye, at);
    }
    scene::Material& material() const { return node->get<scene::MeshNode>()->material; }
    scene::SurfaceDetail& detail() const { return material().detail; }

    HitBuffer hits(const std::string& technique) const {
        material().technique = scene::parse_technique(technique).value();
        return test::must(driver->draw_hits(scene));
    }
    Image picture(const std::string& technique) const {
        material().technique = scene::parse_technique(technique).value();
        test::must(driver->draw(scene));
        return driver->read_color();
    }
};

// How far two places on a tile lie apart, texels; over the border where it wraps.
inline double apart(glm::dvec2 one, glm::dvec2 other, glm::ivec2 texels, WrapMode border) {
    glm::dvec2 way = one - other;
    if (border == WrapMode::wrap) {
        way -= glm::dvec2(texels) * glm::round(way / glm::dvec2(texels));
    }
    return glm::length(way);
}

struct TileErrors {
    int pixels = 0;
    int wrong = 0;
    int compared = 0;     // where both show a place
    double squares = 0.0; // of their distances, texels
    double depth = 0.0;   // the farthest off, as a share
    [[nodiscard]] double wrong_percent() const { return 100.0 * wrong / pixels; }
    [[nodiscard]] double rms() const { return std::sqrt(squares / std::max(compared, 1)); }
};

// The exact relief of what a panel shows.
struct PanelTruth {
    ReliefPlane relief;
    glm::dmat4 local_from_world;
    glm::dvec3 middle; // of the tile with texture coordinates 0 … 1, local

    explicit PanelTruth(const Panel& panel)
        : relief(relief_of(panel)), local_from_world(glm::inverse(panel.node->world_from_local())) {
        const double width = width_of(panel.detail());
        middle = {0.5 * (width - plane_side), 0.5 * (plane_side - width), 0.0};
    }
    static double width_of(const scene::SurfaceDetail& detail) {
        return static_cast<double>(plane_side) / detail.repeats.x;
    }
    static ReliefPlane relief_of(const Panel& panel) {
        const scene::SurfaceDetail& detail = panel.detail();
        return ReliefPlane::create(detail.set->heights.view(),
                                   {width_of(detail), detail.scale, detail.offset, detail.border})
            .value();
    }
    [[nodiscard]] Ray local(const Ray& world) const {
        return {glm::dvec3(local_from_world * glm::dvec4(world.origin, 1.0)),
                glm::dvec3(local_from_world * glm::dvec4(world.direction, 0.0))};
    }
    [[nodiscard]] std::optional<ReliefHit> first_hit(Ray ray) const {
        ray.origin -= middle;
        return relief.first_hit(ray);
    }
};

// Whether a local ray meets the square from above, a pixel's breadth inside: there it is drawn.
inline bool meets_square(const Ray& ray) {
    const glm::dvec3 entry = ray.at(-ray.origin.z / ray.direction.z);
    return ray.direction.z < 0.0 &&
           std::max(std::abs(entry.x), std::abs(entry.y)) <= 0.5 * plane_side - 0.02;
}

inline void judge(const Hit& hit, const std::optional<ReliefHit>& truth, const Panel& panel,
                  TileErrors& errors) {
    ++errors.pixels;
    if (!truth || hit.is_sky()) {
        errors.wrong += truth.has_value() == hit.is_sky() ? 1 : 0;
        return;
    }
    const glm::dvec2 place = truth->texture_coordinate * glm::dvec2(panel.texels) - 0.5;
    const double off = apart({hit.col, hit.row}, place, panel.texels, panel.detail().border);
    errors.wrong += off > 1.0 ? 1 : 0;
    errors.squares += off * off;
    ++errors.compared;
    if (off <= 0.1) {
        errors.depth = std::max(errors.depth, std::abs(hit.depth / truth->t - 1.0));
    }
}

// Every pixel whose ray meets the square.
inline TileErrors tile_errors(const Panel& panel, const HitBuffer& hits) {
    const PanelTruth truth(panel);
    TileErrors errors;
    for (int y = 0; y < hits.rows(); ++y) {
        for (int x = 0; x < hits.cols(); ++x) {
            const Ray ray = truth.local(
                scene::view_ray(panel.scene.camera(), mesh_picture, {x + 0.5, y + 0.5}));
            if (meets_square(ray)) {
                judge(hits(x, y), truth.first_hit(ray), panel, errors);
            }
        }
    }
    return errors;
}

} // namespace reljef::truth
