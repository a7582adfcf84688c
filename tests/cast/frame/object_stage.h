#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/cast/frame/driver.h"
#include "engine/scene/graph/picture_detail.h"
#include "engine/scene/graph/text_mesh.h"
#include "engine/truth/draw.h"
#include "tests/cast/made_rays.h"

namespace reljef::cast {

inline constexpr glm::ivec2 mesh_picture{320, 240};

inline scene::Material picture_on_mesh() {
    Image picture(32, 32);
    for (int row = 0; row < 32; ++row) {
        for (int col = 0; col < 32; ++col) {
            const bool is_red = (col / 4 + row / 4) % 2 == 0;
            picture(col, row) = is_red ? Rgba8{200, 40, 30, 255} : Rgba8{240, 220, 180, 255};
        }
    }
    scene::Material material;
    material.detail.set = scene::picture_material(picture, "checks").value();
    material.detail.repeats = glm::vec2(2.0F, 1.0F);
    material.technique = scene::make_technique(scene::TechniqueId::texture);
    return material;
}

inline scene::Material colored(glm::vec3 color) {
    scene::Material material;
    material.color = color;
    return material;
}

// Hills with objects on them, some half in the ground, in the afternoon.
struct ObjectStage : Stage {
    scene::Light sun;
    scene::Node* light = nullptr;

    explicit ObjectStage(bool has_shadows = true, Grid<float> heights = test::hills(301, 257, 14.0))
        : Stage(std::move(heights)) {
        sun.azimuth = 250.0;
        sun.altitude = 20.0;
        light = &scene.add_light(sun);
        scene.set_sky({.visibility = 4000.0, .plane = {}});
        set_shadow(has_shadows);
        add(scene::box_mesh({14.0F, 10.0F, 40.0F}), {0.0, -40.0}, colored({0.7F, 0.2F, 0.1F}));
        add(scene::sphere_mesh(12.0F), {-30.0, -20.0}, picture_on_mesh());
        add(scene::torus_mesh(14.0F, 4.0F), {35.0, -30.0}, colored({0.1F, 0.3F, 0.8F}));
        add(scene::cylinder_mesh(3.0F, 60.0F), {10.0, 20.0}, picture_on_mesh());
    }
    void set_sun(double altitude) {
        sun.altitude = altitude;
        *light->get<scene::Light>() = sun;
    }
    void set_shadow(bool has_shadows) {
        scene::Technique technique{scene::Exact{}};
        if (has_shadows) {
            technique.options.shadow = scene::Shadow{.depth = 0.0};
        }
        terrain->get<scene::TerrainNode>()->material.technique = technique;
    }
    void set_technique(std::string_view text) {
        terrain->get<scene::TerrainNode>()->material.technique =
            test::must(scene::parse_technique(text));
    }
    // All meshes get a picture.
    void set_textures(std::string_view technique) {
        for (const auto& node : scene.root().children()) {
            auto* const mesh = node->get<scene::MeshNode>();
            if (mesh != nullptr) {
                mesh->material = picture_on_mesh();
                mesh->material.technique = test::must(scene::parse_technique(technique));
            }
        }
    }
    void add(scene::Mesh mesh, glm::dvec2 at, const scene::Material& material) {
        const double ground = surface().height_at(at.x, at.y).value();
        scene.add_mesh(std::move(mesh), material).set_position({at, ground + 3.0});
    }
    // Signs and labels that face the camera, one of them upright, and a tilted one on a node.
    void add_billboards() {
        add(scene::billboard_mesh({14.0F, 18.0F}), {-12.0, -60.0}, picture_on_mesh());
        add(scene::billboard_mesh({9.0F, 30.0F}), {22.0, -65.0}, colored({0.2F, 0.6F, 0.3F}));
        add(scene::text_mesh("Grad 14 m", 7.0F), {5.0, -75.0}, colored({0.9F, 0.8F, 0.2F}));
        std::size_t count = 0;
        for (const auto& node : scene.root().children()) {
            auto* const mesh = node->get<scene::MeshNode>();
            if (mesh != nullptr && ++count > 4) {
                mesh->facing = count == 6 ? scene::Facing::upright : scene::Facing::camera;
                node->set_parent_from_local(
                    glm::rotate(glm::translate(node->parent_from_local(), {0.0, 0.0, 9.0}), 0.1,
                                glm::dvec3(0.0, 1.0, 0.0)));
            }
        }
    }
    void look_near() {
        look(test::camera_at({10.0, -120.0, surface().bounds().high.z + 20.0}, {0.0, -10.0, 5.0}));
    }
    void look_from_above() {
        scene::Camera map = test::camera_at({0.0, -10.0, 500.0}, {0.0, -10.0, 0.0});
        map.projection = scene::ProjectionKind::orthographic;
        map.view_height = 120.0;
        look(map);
    }
    [[nodiscard]] Image drawn(const DriverOptions& options = {.size = mesh_picture}) const {
        Driver driver = test::must(Driver::create(options));
        test::must(driver.draw(view::select(scene, options.size)));
        return driver.read_color();
    }
    [[nodiscard]] Image true_picture(truth::SunShadow shadow) const {
        return test::must(truth::draw(scene, mesh_picture, {.rays_per_side = 1, .shadow = shadow}))
            .image;
    }
    void remove_meshes() {
        std::vector<const scene::Node*> meshes;
        for (const auto& node : scene.root().children()) {
            if (node->get<scene::MeshNode>() != nullptr) {
                meshes.push_back(node.get());
            }
        }
        for (const scene::Node* const mesh : meshes) {
            scene.root().remove(*mesh);
        }
    }
};

// The same hills, and a wall between the objects and the sun.
inline Grid<float> hills_and_wall() {
    Grid<float> heights = test::hills(301, 257, 14.0);
    for (int row = 100; row < 240; ++row) {
        for (int col = 84; col < 90; ++col) {
            heights(col, row) += 35.0F;
        }
    }
    return heights;
}

} // namespace reljef::cast
