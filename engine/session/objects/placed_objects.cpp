#include "engine/session/objects/placed_objects.h"

#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/io/mesh/mesh_file.h"
#include "engine/scene/graph/picture_detail.h"
#include "engine/session/objects/ground_place.h"
#include "engine/session/objects/upright_axes.h"

namespace reljef::session {
namespace {

// What the nodes of one mesh file share.
struct SharedMesh {
    std::vector<scene::MeshNode> parts;
    Box bounds; // metres of the file
    bool has_area = false;
};

bool has_area(const scene::Mesh& mesh) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const scene::TriangleEdges edges = scene::triangle_edges(mesh, i);
        if (glm::length(glm::cross(edges.p, edges.q)) > 0.0) {
            return true;
        }
    }
    return false;
}

// The columns and rows between which a box lies; empty if a corner has none.
std::optional<Box> samples_of(const scene::TerrainSurface& surface, const Box& bounds,
                              const glm::dmat4& scene_from_box) {
    Box samples;
    for (unsigned i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1U) != 0 ? bounds.high.x : bounds.low.x,
                                (i & 2U) != 0 ? bounds.high.y : bounds.low.y,
                                (i & 4U) != 0 ? bounds.high.z : bounds.low.z);
        const glm::dvec3 world(scene_from_box * glm::dvec4(corner, 1.0));
        const auto sample = surface.placement().sample_from_world(world);
        if (!sample) {
            return std::nullopt;
        }
        samples.add(*sample);
    }
    return samples;
}

bool is_beside(const scene::TerrainSurface& surface, const Box& samples) {
    const Grid<float>& heights = surface.heightfield().heights;
    return samples.high.x < 0.0 || samples.low.x > heights.cols() - 1 || samples.high.y < 0.0 ||
           samples.low.y > heights.rows() - 1;
}

// Why nothing of an object can be seen; empty if it can.
std::string unseen(const scene::TerrainSurface& surface, const PlacedObject& object,
                   const SharedMesh& mesh) {
    if (!mesh.has_area) {
        return "its triangles have no area";
    }
    const io::ObjectDescription& described = object.description;
    const double top = described.height + described.scale * mesh.bounds.size().z;
    if (top < 0.0) {
        return fmt::format("its top lies {:.3g} m below the ground at its place", -top);
    }
    const auto place = scene_from_object(surface, object);
    const auto samples = place ? samples_of(surface, mesh.bounds, *place) : std::nullopt;
    return samples && is_beside(surface, *samples) ? "all of it lies outside the terrain" : "";
}

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
        shared.bounds = file.bounds;
        for (const io::ColoredMesh& part : file.parts) {
            shared.has_area = shared.has_area || has_area(*part.mesh);
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

// An object of the description whose place is on the terrain.
Result<PlacedObject> object_on(const scene::TerrainSurface& surface,
                               const io::ObjectDescription& description,
                               const SourceHeight& height) {
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
        return place.error();
    }
    return object;
}

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
    std::vector<std::string> unseen_notes;
    for (const io::ObjectDescription& description : objects) {
        auto object = object_on(surface, description, height);
        if (!object) {
            return object.error(); // before the file is read
        }
        const auto mesh = files.of(description.file);
        if (!mesh) {
            return mesh.error();
        }
        object->lowest = (*mesh)->bounds.low.z;
        object->node = &scene.root().add(description.file.stem().string());
        for (const scene::MeshNode& part : (*mesh)->parts) {
            object->node->add("part", part);
        }
        if (const std::string why = unseen(surface, *object, **mesh); !why.empty()) {
            unseen_notes.push_back(
                fmt::format("{}: nothing of it can be seen: {}", description.file.string(), why));
        }
        placed.objects.push_back(std::move(*object));
    }
    placed.notes = files.notes();
    placed.notes.insert(placed.notes.end(), unseen_notes.begin(), unseen_notes.end());
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
