#include "app/gallery.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "app/message.h"
#include "engine/io/texture_files.h"
#include "terrains/detail_tiles.h"
#include "terrains/gallery.h"

namespace reljef::app {
namespace {

using Set = std::shared_ptr<const terrain::TextureSet>;

// As the models show it: more of a tile than a fine material needs.
constexpr double file_tile_width = 1.5; // metres

scene::Mesh mesh_of(const terrains::GalleryModel& model) {
    const glm::vec3 size = model.size;
    switch (model.shape) {
    case terrains::GalleryShape::plane:
        return scene::plane_mesh({size.x, size.y});
    case terrains::GalleryShape::box:
        return scene::box_mesh(size);
    case terrains::GalleryShape::sphere:
        return scene::sphere_mesh(size.x, 96);
    case terrains::GalleryShape::torus:
        return scene::torus_mesh(size.x, size.y, 96);
    case terrains::GalleryShape::cylinder:
        return scene::cylinder_mesh(size.x, size.y, 96);
    }
    abort_with("a model without a shape");
}

// The plane stands as a wall that looks south.
glm::dmat4 place_of(const terrains::GalleryModel& model) {
    glm::dmat4 place = glm::translate(glm::dmat4(1.0), model.center);
    place = glm::rotate(place, glm::radians(-model.heading), {0.0, 0.0, 1.0});
    return model.shape == terrains::GalleryShape::plane
               ? glm::rotate(place, glm::radians(90.0), {1.0, 0.0, 0.0})
               : place;
}

// The texture sets that were asked for, each made or read once.
class Sets {
public:
    Sets(std::string asked_for, const io::SceneDescription& description,
         const TerrainChoice& terrain)
        : asked_for_(std::move(asked_for)), description_(description), terrain_(terrain) {}

    Result<Set> of(const terrains::GalleryModel& model) {
        const std::string name = asked_for_ == "mixed" ? std::string(model.textures) : asked_for_;
        if (const auto found = sets_.find(name); found != sets_.end()) {
            return found->second;
        }
        auto set = open(name);
        if (!set) {
            return set.error();
        }
        tell_notes(*set);
        return sets_.emplace(name, std::make_shared<const terrain::TextureSet>(std::move(*set)))
            .first->second;
    }

private:
    [[nodiscard]] Result<terrain::TextureSet> open(const std::string& name) const {
        const auto names = terrains::detail_names();
        if (std::find(names.begin(), names.end(), name) != names.end()) {
            return terrains::generate_detail(
                name,
                {.seed = description_.seed, .threads = static_cast<unsigned>(terrain_.threads)});
        }
        std::error_code ignored;
        if (!std::filesystem::is_directory(name, ignored)) {
            return Error{fmt::format("texture set '{}' found, one of mixed, {} or a folder of "
                                     "pictures was expected",
                                     name, fmt::join(names, ", "))};
        }
        const auto files = io::find_texture_files(name);
        if (!files) {
            return files.error();
        }
        return io::read_texture_set(*files, {.width = file_tile_width});
    }

    void tell_notes(const terrain::TextureSet& set) const {
        for (const std::string& note : set.notes) {
            if (!terrain_.quiet) {
                tell(fmt::format("reljef: note: {}\n", note));
            }
        }
    }

    std::string asked_for_;
    const io::SceneDescription& description_;
    const TerrainChoice& terrain_;
    std::map<std::string, Set> sets_;
};

Result<scene::Technique> chosen_technique(const io::SceneDescription& description,
                                          const ViewChoice& view) {
    if (view.max_error) {
        return Error{fmt::format("--max-error: {} found, a terrain was expected: its models are "
                                 "drawn as they are",
                                 description.name)};
    }
    if (view.technique) {
        return *view.technique;
    }
    auto technique = scene::parse_technique(description.gallery_technique);
    return technique ? technique
                     : Error{fmt::format("{}: [gallery] {}", description.name,
                                         technique.error().message)};
}

scene::Material material_of(const terrains::GalleryModel& model, Set set,
                            const scene::Technique& technique, bool wireframe) {
    scene::Material material;
    material.technique = technique;
    material.wireframe = wireframe;
    material.detail.scale = set->scale;
    material.detail.repeats = model.repeats;
    material.detail.set = std::move(set);
    return material;
}

} // namespace

Result<std::vector<scene::Node*>> add_gallery(scene::Scene& scene,
                                              const io::SceneDescription& description,
                                              const TerrainChoice& terrain,
                                              const ViewChoice& view) {
    const auto technique = chosen_technique(description, view);
    if (!technique) {
        return technique.error();
    }
    Sets sets(terrain.textures.value_or(description.gallery_textures), description, terrain);
    std::vector<scene::Node*> nodes;
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

} // namespace reljef::app
