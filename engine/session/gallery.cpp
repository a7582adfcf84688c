#include "engine/session/gallery.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "engine/session/material_source.h"
#include "engine/session/objects/whole_mesh.h"
#include "engine/session/prepared_maps.h"
#include "terrains/gallery/gallery.h"

namespace reljef::session {
namespace {

using Set = std::shared_ptr<const material::ReliefMaterial>;

constexpr double file_tile_width = 1.5; // metres

scene::Mesh mesh_of(const terrains::GalleryModel& model) {
    const glm::vec3 size = model.size;
    switch (model.shape) {
    case terrains::GalleryShape::plane:
    case terrains::GalleryShape::sheet:
        return scene::plane_mesh({size.x, size.y});
    case terrains::GalleryShape::box:
        return scene::box_mesh(size);
    case terrains::GalleryShape::sphere:
        return scene::sphere_mesh(size.x, 96);
    case terrains::GalleryShape::torus:
        return scene::torus_mesh(size.x, size.y, 96);
    case terrains::GalleryShape::cylinder:
        return scene::cylinder_mesh(size.x, size.y, 96);
    case terrains::GalleryShape::bowl:
        return scene::bowl_mesh(size.x, 96);
    }
    abort_with("a model without a shape");
}

// A mesh of the user in the gallery.
struct OwnModel {
    std::shared_ptr<const scene::Mesh> mesh;
    terrains::GalleryModel model; ///< its name is its technique's; without a shape
};

constexpr double own_side = 1.1;       // metres
constexpr float own_tile_width = 0.3F; // metres
constexpr int own_columns = 6;

// In rows from the front to the back.
glm::dvec3 own_place(int index) {
    const glm::dvec2 front(-3.75, -3.0);
    const glm::dvec2 distance(1.5, 2.8);
    const glm::dvec2 cell(index % own_columns, index / own_columns);
    return {front + cell * distance, 0.0};
}

Result<std::vector<OwnModel>> own_models(const SceneOptions& view, const std::stop_token& stop) {
    std::vector<OwnModel> models;
    for (const io::ObjectDescription& object : view.objects) {
        if (object.at) {
            continue;
        }
        auto mesh = read_whole_mesh(object.file, own_side, stop);
        if (!mesh) {
            return mesh.error();
        }
        const auto width = static_cast<float>(scene::tile_width(*mesh, glm::vec2(1.0F)));
        const auto shared = std::make_shared<const scene::Mesh>(std::move(*mesh));
        for (const scene::TechniqueInfo& technique : scene::technique_catalogue()) {
            if (scene::draws_any_mesh(technique.id)) {
                terrains::GalleryModel model{terrains::GalleryShape::box,
                                             technique.name,
                                             "brick",
                                             own_place(static_cast<int>(models.size())),
                                             0.0,
                                             {},
                                             glm::vec2(width / own_tile_width),
                                             technique.name};
                models.push_back({shared, model});
            }
        }
    }
    return models;
}

// Planes are upright and face south.
glm::dmat4 place_of(const terrains::GalleryModel& model) {
    glm::dmat4 place = glm::translate(glm::dmat4(1.0), model.center);
    place = glm::rotate(place, glm::radians(-model.heading), {0.0, 0.0, 1.0});
    const bool stands = model.shape == terrains::GalleryShape::plane ||
                        model.shape == terrains::GalleryShape::sheet;
    return stands ? glm::rotate(place, glm::radians(90.0), {1.0, 0.0, 0.0}) : place;
}

// The materials of the models, each generated or read once.
struct Sets {
    std::string requested; // or "mixed"
    const io::SceneDescription& description;
    const SourceOptions& terrain;
    std::optional<scene::Technique> technique; // of all models; empty: their own, without cones
    Log& log;
    std::stop_token stop;
    std::map<std::string, Set> by_name = {};

    Result<Set> of(const terrains::GalleryModel& model) {
        const std::string name = requested == "mixed" ? std::string(model.textures) : requested;
        if (const auto found = by_name.find(name); found != by_name.end()) {
            return found->second;
        }
        auto set = open_material(
            {name, terrain.textures ? std::filesystem::path(name) : description.gallery_folder,
             terrain.textures ? "--textures" : terrain.terrain, description.seed, file_tile_width,
             std::nullopt, "mixed, "},
            terrain);
        if (!set) {
            return set.error();
        }
        if (technique) {
            if (auto made = add_cones(*set, *technique, terrain.threads, log, stop); !made) {
                return made.error();
            }
        }
        log_material_notes(*set, log);
        return by_name
            .emplace(name, std::make_shared<const material::ReliefMaterial>(std::move(*set)))
            .first->second;
    }
};

// Empty: each model has its own.
Result<std::optional<scene::Technique>> chosen_technique(const io::SceneDescription& description,
                                                         const std::string& file,
                                                         const SceneOptions& view) {
    using Choice = std::optional<scene::Technique>;
    if (view.max_error.value_or(0.0) > 0.0) {
        return usage_error(
            fmt::format("--max-error: {} found, a terrain was expected: its models are drawn as "
                        "they are",
                        file));
    }
    if (view.technique && scene::error_bound(*view.technique) > 0.0) {
        return usage_error(fmt::format("--technique: {} found, one without an error bound was "
                                       "expected: the models of {} are drawn as they are",
                                       scene::to_string(*view.technique), file));
    }
    if (view.technique || view.mixed || description.gallery_technique == "mixed") {
        return Choice(view.technique);
    }
    auto technique = scene::parse_technique(description.gallery_technique);
    if (!technique) {
        return Error{fmt::format("{}: [gallery] {}", file, technique.error().message)};
    }
    if (scene::error_bound(*technique) > 0.0) {
        return Error{fmt::format("{}: [gallery] technique {} found, one without an error bound was "
                                 "expected: models are drawn as they are",
                                 file, scene::to_string(*technique))};
    }
    return Choice(*technique);
}

scene::Material material_of(const terrains::GalleryModel& model, Set set,
                            const std::optional<scene::Technique>& technique, bool wireframe) {
    scene::Material material;
    material.technique = technique ? *technique : scene::parse_technique(model.technique).value();
    material.wireframe = wireframe;
    material.detail.scale = set->scale;
    material.detail.offset = model.offset;
    material.detail.repeats = model.repeats;
    material.detail.set = std::move(set);
    return material;
}

} // namespace

Result<std::vector<scene::Node*>> add_gallery(scene::Scene& scene,
                                              const io::SceneDescription& description,
                                              const SourceOptions& terrain,
                                              const SceneOptions& view, Log& log,
                                              const std::stop_token& stop) {
    const auto technique = chosen_technique(description, terrain.terrain, view);
    if (!technique) {
        return technique.error();
    }
    Sets sets{terrain.textures.value_or(description.gallery_textures),
              description,
              terrain,
              *technique,
              log,
              stop};
    std::vector<scene::Node*> nodes;
    const auto own = own_models(view, stop);
    if (!own) {
        return own.error();
    }
    for (const OwnModel& shown : *own) {
        const auto set = sets.of(shown.model);
        if (!set) {
            return set.error();
        }
        scene::Node& node =
            scene.root().add(std::string(shown.model.name),
                             scene::MeshNode{shown.mesh, material_of(shown.model, *set, *technique,
                                                                     view.wireframe)});
        node.set_position(shown.model.center);
        nodes.push_back(&node);
    }
    if (!nodes.empty()) {
        return nodes;
    }
    for (const terrains::GalleryModel& model : terrains::gallery_models()) {
        const auto set = sets.of(model);
        if (!set) {
            return set.error();
        }
        const scene::MeshNode mesh{std::make_shared<const scene::Mesh>(mesh_of(model)),
                                   material_of(model, *set, *technique, view.wireframe)};
        scene::Node& node = scene.root().add(std::string(model.name), mesh);
        node.set_parent_from_local(place_of(model));
        nodes.push_back(&node);
    }
    return nodes;
}

void shadow_floor(scene::TerrainNode& floor, std::span<scene::Node* const> models) {
    const auto technique_of = [](const scene::Node* model) -> const scene::Technique& {
        return model->get<scene::MeshNode>()->material.technique;
    };
    const auto found = std::ranges::find_if(models, [&](const scene::Node* model) {
        return technique_of(model).options.shadow.has_value();
    });
    floor.material.technique.options.shadow =
        found == models.end() ? std::nullopt : technique_of(*found).options.shadow;
}

} // namespace reljef::session
