#include "engine/session/objects/placed_objects.h"

#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "engine/io/mesh/mesh_file.h"
#include "engine/scene/graph/picture_detail.h"
#include "engine/session/objects/ground_place.h"
#include "engine/session/objects/upright_axes.h"

namespace reljef::session {
namespace {

// What the nodes of one mesh file share.
struct SharedMesh {
    std::vector<scene::MeshNode> parts;
    double lowest = 0.0; // metres
};

GroundPlace place_of(const PlacedObject& object) {
    return {object.description.file.string(), object.description.at.value_or(glm::dvec2(0.0)),
            object.ground_height};
}

// Reads each file once, and makes each picture once.
class MeshFiles {
public:
    explicit MeshFiles(std::stop_token stop) : stop_(std::move(stop)) {}

    Result<const SharedMesh*> of(const std::filesystem::path& file) {
        if (const auto found = by_file_.find(file); found != by_file_.end()) {
            return &found->second;
        }
        auto read = io::read_mesh_file(file, {}, stop_);
        if (!read) {
            return read.error();
        }
        notes_.insert(notes_.end(), read->notes.begin(), read->notes.end());
        auto shared = shared_mesh(*read, file.string());
        if (!shared) {
            return shared.error();
        }
        return &by_file_.emplace(file, std::move(*shared)).first->second;
    }

    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

private:
    Result<SharedMesh> shared_mesh(const io::MeshFile& file, const std::string& name) {
        SharedMesh shared;
        shared.lowest = file.bounds.low.z;
        for (const io::ColoredMesh& part : file.parts) {
            scene::MeshNode node{part.mesh, {}};
            node.material.color = part.color;
            if (part.picture != nullptr) {
                auto material = textured(part.picture, name);
                if (!material) {
                    return material.error();
                }
                node.material.technique = scene::make_technique(scene::TechniqueId::texture);
                node.material.detail.set = std::move(*material);
            }
            shared.parts.push_back(std::move(node));
        }
        return shared;
    }

    Result<std::shared_ptr<const material::ReliefMaterial>>
    textured(const std::shared_ptr<const Image>& picture, const std::string& name) {
        if (const auto found = by_picture_.find(picture); found != by_picture_.end()) {
            return found->second;
        }
        auto made = scene::picture_material(*picture, name);
        if (made) {
            by_picture_.emplace(picture, *made);
        }
        return made;
    }

    std::stop_token stop_;
    std::map<std::filesystem::path, SharedMesh> by_file_;
    std::map<std::shared_ptr<const Image>, std::shared_ptr<const material::ReliefMaterial>>
        by_picture_;
    std::vector<std::string> notes_;
};

} // namespace

Result<glm::dmat4> scene_from_object(const scene::TerrainSurface& surface,
                                     const PlacedObject& object) {
    const io::ObjectDescription& described = object.description;
    const auto ground = ground_at(surface, place_of(object));
    if (!ground) {
        return ground.error();
    }
    const glm::dmat3 axes = upright_axes(surface.placement(), *ground, described.heading);
    const glm::dvec3 origin =
        *ground + axes[2] * (described.height - described.scale * object.lowest);
    glm::dmat4 placed(described.scale * axes);
    placed[3] = glm::dvec4(origin, 1.0);
    return placed;
}

Result<PlacedObjects> add_objects(scene::Scene& scene, const scene::TerrainSurface& surface,
                                  const std::vector<io::ObjectDescription>& objects,
                                  const SourceHeight& height, const std::stop_token& stop) {
    PlacedObjects placed;
    MeshFiles files(stop);
    for (const io::ObjectDescription& description : objects) {
        PlacedObject object{nullptr, description, 0.0, {}};
        if (!description.at) {
            return Error{fmt::format("{}: no place found, at=LAT,LON was expected on a terrain",
                                     description.file.string())};
        }
        if (height) {
            object.ground_height = height(*description.at);
            if (!object.ground_height) {
                return misplaced(place_of(object), "no height", "a place on the terrain with one");
            }
        }
        if (auto place = scene_from_object(surface, object); !place) {
            return place.error(); // before the file is read
        }
        const auto mesh = files.of(description.file);
        if (!mesh) {
            return mesh.error();
        }
        object.lowest = (*mesh)->lowest;
        object.node = &scene.root().add(description.file.stem().string());
        for (const scene::MeshNode& part : (*mesh)->parts) {
            object.node->add("part", part);
        }
        placed.objects.push_back(std::move(object));
    }
    placed.notes = files.notes();
    stand_on(surface, placed.objects);
    return placed;
}

void stand_on(const scene::TerrainSurface& surface, const std::vector<PlacedObject>& objects) {
    for (const PlacedObject& object : objects) {
        if (const auto place = scene_from_object(surface, object)) {
            object.node->set_parent_from_local(*place);
        }
    }
}

} // namespace reljef::session
