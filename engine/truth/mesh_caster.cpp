#include "engine/truth/mesh_caster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>

#include "engine/core/color.h"
#include "engine/scene/graph/picture_detail.h"
#include "engine/truth/eye.h"

namespace reljef::truth {
namespace {

constexpr std::size_t leaf_triangles = 4;

enum class Sides { outside, both };

// The other side of a triangle.
scene::TriangleEdges turned(scene::TriangleEdges edges) {
    std::swap(edges.p, edges.q);
    std::swap(edges.s, edges.t);
    return edges;
}

// Möller and Trumbore 1997; only from outside.
std::optional<MeshHit> triangle_hit(const scene::TriangleEdges& edges, const Ray& ray,
                                    Interval range) {
    const glm::dvec3 across = glm::cross(ray.direction, edges.q);
    const double facing = glm::dot(edges.p, across);
    if (!(facing > 0.0)) {
        return std::nullopt;
    }
    const glm::dvec3 from_corner = ray.origin - edges.corner;
    const double first = glm::dot(from_corner, across);
    const glm::dvec3 aside = glm::cross(from_corner, edges.p);
    const double second = glm::dot(ray.direction, aside);
    if (first < 0.0 || second < 0.0 || first + second > facing) {
        return std::nullopt;
    }
    const double t = glm::dot(edges.q, aside) / facing;
    if (!(t >= range.begin && t <= range.end)) {
        return std::nullopt;
    }
    return MeshHit{t, 0, 0, glm::dvec2(first, second) / facing};
}

int widest_axis(glm::dvec3 size) {
    const int widest = size.x >= size.y ? 0 : 1;
    return size[widest] >= size.z ? widest : 2;
}

template <class Vector>
Vector mixed(const std::vector<Vector>& values, const scene::Mesh& mesh, const MeshHit& hit) {
    const auto value = [&](std::size_t corner) {
        return values[mesh.indices[hit.triangle + corner]];
    };
    const auto second = static_cast<float>(hit.shares.x);
    const auto third = static_cast<float>(hit.shares.y);
    return (1.0F - second - third) * value(0) + second * value(1) + third * value(2);
}

// Bilinear between texel centres of a picture that repeats.
glm::vec3 texel_color(const Image& picture, glm::dvec2 coordinate) {
    const glm::dvec2 size(picture.cols(), picture.rows());
    const glm::dvec2 place = (coordinate - glm::floor(coordinate)) * size - 0.5;
    const glm::dvec2 near = glm::floor(place);
    const glm::vec2 part(place - near);
    const auto color = [&](int col, int row) {
        const auto around = [](int i, int n) { return (i % n + n) % n; };
        return linear_from_rgba8(picture(around(static_cast<int>(near.x) + col, picture.cols()),
                                         around(static_cast<int>(near.y) + row, picture.rows())));
    };
    return glm::mix(glm::mix(color(0, 0), color(1, 0), part.x),
                    glm::mix(color(0, 1), color(1, 1), part.x), part.y);
}

} // namespace

// A binary tree: halves of the triangles by their middles along the widest axis.
struct MeshCaster::Tree {
    struct Branch {
        Box bounds;
        std::uint32_t first = 0; // of `order`
        std::uint32_t count = 0; // 0: two branches follow, the next one and `second`
        std::uint32_t second = 0;
    };

    explicit Tree(const scene::Mesh& mesh) : mesh_(mesh), order_(mesh.indices.size() / 3) {
        std::iota(order_.begin(), order_.end(), 0U);
        if (!order_.empty()) {
            grow(0, order_.size());
        }
    }

    [[nodiscard]] std::optional<MeshHit> first_hit(const Ray& ray, Interval range,
                                                   Sides sides) const {
        std::optional<MeshHit> nearest;
        std::vector<std::uint32_t> open;
        if (!branches_.empty()) {
            open.push_back(0);
        }
        while (!open.empty()) {
            const std::uint32_t index = open.back();
            const Branch& branch = branches_[index];
            open.pop_back();
            if (!intersect(ray, branch.bounds, range)) {
                continue;
            }
            if (branch.count == 0) {
                open.push_back(branch.second);
                open.push_back(index + 1);
            }
            for (std::uint32_t i = 0; i < branch.count; ++i) {
                const std::size_t triangle = std::size_t{3} * order_[branch.first + i];
                const scene::TriangleEdges edges = scene::triangle_edges(mesh_, triangle);
                auto hit = triangle_hit(edges, ray, range);
                if (!hit && sides == Sides::both) {
                    hit = triangle_hit(turned(edges), ray, range);
                }
                if (hit) {
                    hit->triangle = triangle;
                    range.end = hit->t;
                    nearest = hit;
                }
            }
        }
        return nearest;
    }

private:
    [[nodiscard]] Box bounds_of(std::uint32_t triangle) const {
        Box box;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = mesh_.indices[std::size_t{3} * triangle + corner];
            box.add(glm::dvec3(mesh_.positions[vertex]));
        }
        return box;
    }

    // The depth is the logarithm of the number of triangles: halves are equal.
    void grow(std::size_t begin, std::size_t end) {
        const std::size_t index = branches_.size();
        Branch branch;
        Box middles;
        for (std::size_t i = begin; i < end; ++i) {
            const Box box = bounds_of(order_[i]);
            branch.bounds.add(box);
            middles.add(box.center());
        }
        branch.first = static_cast<std::uint32_t>(begin);
        branch.count = static_cast<std::uint32_t>(end - begin);
        branches_.push_back(branch);
        if (end - begin <= leaf_triangles) {
            return;
        }
        const int axis = widest_axis(middles.size());
        const std::size_t middle = (begin + end) / 2;
        const auto at = [&](std::size_t i) {
            return order_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            return bounds_of(a).center()[axis] < bounds_of(b).center()[axis];
        });
        branches_[index].count = 0;
        grow(begin, middle);
        branches_[index].second = static_cast<std::uint32_t>(branches_.size());
        grow(middle, end);
    }

    const scene::Mesh& mesh_; // the instances own it
    std::vector<std::uint32_t> order_;
    std::vector<Branch> branches_;
};

Result<MeshCaster> MeshCaster::create(const scene::Scene& scene) {
    MeshCaster caster;
    const scene::Camera camera = scene.camera();
    std::optional<Error> error;
    std::map<const scene::Mesh*, std::shared_ptr<const Tree>> trees;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& transform) {
        const auto* const mesh = node.get<scene::MeshNode>();
        if (mesh == nullptr || error) {
            return;
        }
        const glm::dmat4 world_from_local = scene::faced(mesh->facing, transform, camera);
        const scene::SurfaceDetail& detail = mesh->material.detail;
        if (detail.set != nullptr && !scene::is_picture(detail)) {
            error = Error{fmt::format("node '{}': is a mesh with relief, of which there is no "
                                      "exact picture; terrain and plain meshes were expected",
                                      node.name())};
            return;
        }
        auto& tree = trees[mesh->mesh.get()];
        if (tree == nullptr) {
            tree = std::make_shared<const Tree>(*mesh->mesh);
        }
        const Box bounds = reljef::transformed(world_from_local, node.local_bounds());
        caster.instances_.push_back({tree, *mesh, glm::inverse(world_from_local),
                                     glm::inverseTranspose(glm::dmat3(world_from_local)), bounds});
        caster.bounds_.add(bounds);
    });
    return error ? Result<MeshCaster>(*error) : Result<MeshCaster>(std::move(caster));
}

std::optional<MeshHit> MeshCaster::first_hit(const Ray& world_ray, Interval range) const {
    std::optional<MeshHit> nearest;
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        const Instance& instance = instances_[i];
        if (!intersect(world_ray, instance.bounds, range)) {
            continue;
        }
        auto hit = instance.tree->first_hit(transformed(instance.local_from_world, world_ray),
                                            range, Sides::outside);
        if (hit) {
            hit->mesh = i;
            range.end = hit->t;
            nearest = hit;
        }
    }
    return nearest;
}

bool MeshCaster::hides(const Ray& world_ray) const {
    constexpr Interval onward{0.0, std::numeric_limits<double>::infinity()};
    return std::any_of(instances_.begin(), instances_.end(), [&](const Instance& instance) {
        return intersect(world_ray, instance.bounds, onward) &&
               instance.tree->first_hit(transformed(instance.local_from_world, world_ray), onward,
                                        Sides::both);
    });
}

glm::dvec3 MeshCaster::face_at(const MeshHit& hit) const {
    const Instance& instance = instances_[hit.mesh];
    const scene::TriangleEdges edges = scene::triangle_edges(*instance.node.mesh, hit.triangle);
    return glm::normalize(instance.world_from_normal * glm::cross(edges.p, edges.q));
}

glm::vec3 MeshCaster::albedo_at(const MeshHit& hit) const {
    const scene::Mesh& mesh = *instances_[hit.mesh].node.mesh;
    const scene::Material& material = instances_[hit.mesh].node.material;
    return material.detail.set == nullptr
               ? material.color
               : texel_color(material.detail.set->color,
                             glm::dvec2(mixed(mesh.texture_coordinates, mesh, hit)) *
                                 glm::dvec2(material.detail.repeats));
}

glm::vec3 MeshCaster::normal_at(const MeshHit& hit) const {
    const Instance& instance = instances_[hit.mesh];
    const scene::Mesh& mesh = *instance.node.mesh;
    return glm::vec3(
        glm::normalize(instance.world_from_normal * glm::dvec3(mixed(mesh.normals, mesh, hit))));
}

glm::vec3 MeshCaster::from_points(const MeshHit& hit, glm::dvec3 place,
                                  std::span<const scene::PlacedPointLight> lights) const {
    return lights.empty() ? glm::vec3(0.0F)
                          : albedo_at(hit) * scene::radiance_from(lights, place, normal_at(hit));
}

glm::vec3 MeshCaster::color_at(const MeshHit& hit, const std::optional<scene::Light>& sun,
                               bool sees_sun) const {
    const glm::vec3 albedo = albedo_at(hit);
    if (!sun) {
        return albedo;
    }
    const glm::vec3 normal = normal_at(hit);
    const float facing =
        sees_sun ? std::max(glm::dot(normal, glm::vec3(scene::to_light(*sun))), 0.0F) : 0.0F;
    return albedo * (sun->color * facing + sun->ambient * (0.5F + 0.5F * normal.z));
}

Hit MeshCaster::as_shown(const MeshHit& hit) {
    Hit shown;
    shown.depth = static_cast<float>(hit.t);
    return shown;
}

} // namespace reljef::truth
