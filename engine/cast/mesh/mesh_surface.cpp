#include "engine/cast/mesh/mesh_surface.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "engine/scene/graph/mesh.h"
#include "engine/scene/graph/picture_detail.h"

namespace reljef::cast {
namespace {

glm::dvec2 coordinate_at(const scene::TriangleEdges& edges, glm::dvec2 shares) {
    return shares.x * edges.s + shares.y * edges.t;
}

glm::vec3 unit(glm::dvec3 vector, glm::dvec3 otherwise) {
    const double length = glm::length(vector);
    return glm::vec3(length > 0.0 ? vector / length : otherwise);
}

// Changes of the texture coordinate from pixel to pixel in the plane of a triangle.
class Footprint {
public:
    Footprint(const scene::TriangleEdges& edges, glm::dvec3 direction)
        : edges_(edges), direction_(direction), normal_(glm::cross(edges.p, edges.q)),
          facing_(glm::dot(normal_, direction)), square_(glm::dot(normal_, normal_)) {}

    // `shift`: of the ray, local metres.
    [[nodiscard]] glm::dvec2 of(glm::dvec3 shift) const {
        const glm::dvec3 moved = shift - direction_ * (glm::dot(normal_, shift) / facing_);
        return coordinate_at(edges_, {glm::dot(glm::cross(moved, edges_.q), normal_) / square_,
                                      glm::dot(glm::cross(edges_.p, moved), normal_) / square_});
    }

private:
    const scene::TriangleEdges& edges_;
    glm::dvec3 direction_;
    glm::dvec3 normal_;
    double facing_;
    double square_;
};

glm::dvec2 repeated(const scene::MeshNode& node, glm::dvec2 coordinate) {
    return coordinate * glm::dvec2(node.material.detail.repeats);
}

glm::dvec2 tile_coordinate(const scene::MeshNode& node, const scene::TriangleEdges& edges,
                           const MeshHit& hit) {
    return repeated(node, edges.coordinate + coordinate_at(edges, hit.shares));
}

} // namespace

void MeshPictures::prepare(const PlacedMeshes& meshes) {
    std::erase_if(pictures_, [](const auto& entry) { return entry.second.owner.expired(); });
    for (const PlacedMesh& mesh : meshes.meshes()) {
        const auto& set = mesh.node.material.detail.set;
        if (set == nullptr) {
            continue;
        }
        Picture& picture = pictures_[set.get()];
        if (picture.owner.lock() != set) {
            picture = {set, std::make_shared<const PictureLevels>(set->color)};
        }
    }
}

MeshSurface MeshPictures::at(const PlacedMeshes& meshes, const MeshHit& hit,
                             const PixelRay& ray) const {
    const PlacedMesh& placed = meshes.meshes()[hit.mesh];
    const scene::MeshNode& node = placed.node;
    const scene::Mesh& mesh = *node.mesh;
    const scene::TriangleEdges edges = scene::triangle_edges(mesh, hit.triangle);
    const auto normal_of = [&](std::size_t corner) {
        return glm::dvec3(mesh.normals[mesh.indices[hit.triangle + corner]]);
    };
    const glm::dvec3 normal = (1.0 - hit.shares.x - hit.shares.y) * normal_of(0) +
                              hit.shares.x * normal_of(1) + hit.shares.y * normal_of(2);
    const glm::dvec3 up(0.0, 0.0, 1.0);
    MeshSurface surface;
    surface.face = unit(placed.world_from_normal * glm::cross(edges.p, edges.q), up);
    surface.normal = unit(placed.world_from_normal * normal, glm::dvec3(surface.face));
    surface.albedo = node.material.color;
    if (node.material.detail.set != nullptr) {
        const glm::dmat3 local(placed.local_from_relative);
        const Footprint footprint(edges, local * ray.ray.direction);
        surface.albedo = pictures_.at(node.material.detail.set.get())
                             .levels->at(tile_coordinate(node, edges, hit),
                                         repeated(node, footprint.of(local * ray.right)),
                                         repeated(node, footprint.of(local * ray.down)));
    }
    return surface;
}

Hit shown_hit(const PlacedMesh& mesh, const MeshHit& hit) {
    Hit shown;
    shown.depth = static_cast<float>(hit.t);
    const scene::SurfaceDetail& detail = mesh.node.material.detail;
    if (detail.set == nullptr || scene::is_picture(detail)) {
        return shown;
    }
    const scene::TriangleEdges edges = scene::triangle_edges(*mesh.node.mesh, hit.triangle);
    const glm::dvec2 coordinate = tile_coordinate(mesh.node, edges, hit);
    const Grid<float>& heights = detail.set->heights;
    const glm::dvec2 place =
        (coordinate - glm::floor(coordinate)) * glm::dvec2(heights.cols(), heights.rows()) - 0.5;
    shown.col = static_cast<float>(place.x);
    shown.row = static_cast<float>(place.y);
    shown.height = static_cast<float>(scene::tile_height(*detail.set, coordinate, detail.border));
    return shown;
}

} // namespace reljef::cast
