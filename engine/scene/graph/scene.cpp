#include "engine/scene/graph/scene.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace reljef::scene {
namespace {

void visit_below(const Node& node, const glm::dmat4& world_from_parent, const NodeVisitor& visit) {
    if (!node.visible()) {
        return;
    }
    const glm::dmat4 world_from_local = world_from_parent * node.parent_from_local();
    visit(node, world_from_local);
    for (const auto& child : node.children()) {
        visit_below(*child, world_from_local, visit);
    }
}

Ray transformed(const glm::dmat4& to_from_from, const Ray& ray) {
    return {glm::dvec3(to_from_from * glm::dvec4(ray.origin, 1.0)),
            glm::dvec3(to_from_from * glm::dvec4(ray.direction, 0.0))};
}

// z of a terrain straight below `above`, world metres. A rotated terrain needs a ray.
std::optional<double> height_of(const TerrainNode& terrain, const glm::dmat4& world_from_local,
                                glm::dvec3 above) {
    const glm::dvec3 origin(world_from_local[3]);
    if (glm::dmat3(world_from_local) == glm::dmat3(1.0)) {
        const auto z = reljef::scene::height_at(terrain, above.x - origin.x, above.y - origin.y);
        return z ? std::optional(*z + origin.z) : std::nullopt;
    }
    const auto hit = terrain.surface->pick(
        transformed(glm::inverse(world_from_local), {above, {0.0, 0.0, -1.0}}));
    return hit ? std::optional(above.z - hit->t) : std::nullopt;
}

// Also for a node that was removed from the tree and destroyed.
bool contains(const Node& root, const Node* node) {
    return &root == node || std::any_of(root.children().begin(), root.children().end(),
                                        [&](const auto& child) { return contains(*child, node); });
}

// The option that excludes silhouettes, and why; empty if there is none.
std::string_view reason_against_silhouettes(const TechniqueOptions& options) {
    if (!options.true_silhouettes) {
        return {};
    }
    if (options.fade) {
        return "fade, which was not expected: heights that change with the view have no outline";
    }
    if (options.smooth_edges) {
        return "edges, which was not expected: what a ray misses in one part of the hull it may "
               "meet in the next";
    }
    return options.two_sided ? "sides=two, which was not expected: a hull is seen from outside"
                             : std::string_view();
}

} // namespace

Result<void> check_technique(const Technique& technique, const MeshNode& mesh) {
    const std::string_view name = technique_info(technique.id()).name;
    if (mesh.material.detail.set == nullptr) {
        return {};
    }
    if (const auto reason = reason_against_silhouettes(technique.options); !reason.empty()) {
        return Error{fmt::format("technique {}: silhouettes=true found beside {}", name, reason)};
    }
    if (!draws_any_mesh(technique.id()) && !texture_plane(*mesh.mesh)) {
        return Error{fmt::format("technique {}: a mesh that is not flat found, one plane was "
                                 "expected; relief draws both",
                                 name)};
    }
    return {};
}

double extinction(const Sky& sky) {
    constexpr double contrast_left = 0.02;
    return sky.visibility > 0.0 ? -std::log(contrast_left) / sky.visibility : 0.0;
}

glm::vec3 SeenSky::color(glm::dvec3 direction) const {
    return picture->color(picture_from_world * direction, level);
}

glm::dmat3 ground_axes(const terrain::Placement& placement, const glm::dmat4& world_from_local,
                       glm::dvec3 eye) {
    const glm::dvec3 local_eye(glm::inverse(world_from_local) * glm::dvec4(eye, 1.0));
    const glm::dmat3 turn(world_from_local);
    const glm::dvec3 up = glm::normalize(turn * placement.up(local_eye));
    const glm::dvec3 east = glm::normalize(glm::cross(turn * placement.north(local_eye), up));
    return {east, glm::cross(up, east), up};
}

namespace {

// Radians: the geometric mean of those in the middle and in the corners, where pixels are narrower.
double angle_of_pixels(const Camera& camera, glm::ivec2 size) {
    if (camera.projection == ProjectionKind::orthographic) {
        return 0.0;
    }
    const glm::ivec2 whole = whole_picture(camera, size);
    const double half_height =
        std::tan(0.5 * glm::radians(camera_of_whole(camera, size).vertical_fov));
    const double corner = half_height * glm::length(glm::dvec2(whole)) / whole.y; // tangent
    return 2.0 * half_height / whole.y / std::sqrt(1.0 + corner * corner);
}

} // namespace

std::optional<SeenSky> seen_sky(const Sky& sky, const Camera& camera, glm::ivec2 size,
                                const glm::dmat3& axes) {
    if (sky.picture == nullptr) {
        return std::nullopt;
    }
    return SeenSky{sky.picture, glm::transpose(axes),
                   sky.picture->level_for(angle_of_pixels(camera, size))};
}

AirPlace air_place(const Sky& sky, glm::dvec3 place) {
    if (sky.radius <= 0.0) {
        return {place.z - sky.base, {0.0, 0.0, 1.0}};
    }
    const glm::dvec3 from_middle = place - glm::dvec3(0.0, 0.0, sky.base - sky.radius);
    const double distance = std::max(glm::length(from_middle), 1.0);
    return {distance - sky.radius, from_middle / distance};
}

namespace {

// AirSeen::bend. From a height, the sea at the Earth's horizon would stand out from that which
// fades above it, because little air lies before it; there the sea is level.
double bend_of(const Sky& sky, double above) {
    constexpr double bent_below = 500.0;   // metres
    constexpr double level_above = 3000.0; // metres
    return sky.radius > 0.0
               ? 0.5 / sky.radius * (1.0 - glm::smoothstep(bent_below, level_above, above))
               : 0.0;
}

} // namespace

AirSeen air_seen(const Sky& sky, const Camera& camera) {
    AirSeen seen;
    const auto [above, up] = air_place(sky, camera.eye);
    seen.up = glm::vec3(up);
    seen.bend = static_cast<float>(bend_of(sky, above));
    seen.extinction = static_cast<float>(extinction(sky)) * sky.fading;
    seen.eye_above = static_cast<float>(std::max(above, 0.0));
    if (sky.air_height > 0.0) {
        seen.per_height = static_cast<float>(1.0 / sky.air_height);
        seen.eye_density = static_cast<float>(std::exp(-std::max(above, 0.0) / sky.air_height));
    }
    if (sky.plane.has_value() && above > 0.0) {
        seen.plane_air = static_cast<float>(plane_air(sky, above));
    }
    return seen;
}

double plane_air(const Sky& sky, double above) {
    // So much thicker than the air at the base that no line shows where a plane of land ends.
    constexpr double mist = 8.0;
    if (!sky.is_plane_sea) {
        return mist * above;
    }
    return sky.air_height > 0.0 ? -sky.air_height * std::expm1(-above / sky.air_height) : above;
}

double steepness_to_plane(const Sky& sky, double above, double fall) {
    const double horizon = 4.0 * above * bend_of(sky, above); // squared sine
    return 0.5 * (fall + std::sqrt(std::max(fall * fall - horizon, 0.0)));
}

Node::Node(std::string name, Content content)
    : name_(std::move(name)), content_(std::move(content)) {}

Node& Node::add(std::unique_ptr<Node> child) {
    check(child != nullptr, "a node was expected");
    child->parent_ = this;
    children_.push_back(std::move(child));
    return *children_.back();
}

Node& Node::add(std::string name, Content content) {
    return add(std::make_unique<Node>(std::move(name), std::move(content)));
}

std::unique_ptr<Node> Node::remove(const Node& child) {
    const auto found = std::find_if(children_.begin(), children_.end(),
                                    [&](const auto& entry) { return entry.get() == &child; });
    if (found == children_.end()) {
        return nullptr;
    }
    std::unique_ptr<Node> taken = std::move(*found);
    children_.erase(found);
    taken->parent_ = nullptr;
    return taken;
}

glm::dmat4 Node::world_from_local() const {
    return parent_ != nullptr ? parent_->world_from_local() * parent_from_local_
                              : parent_from_local_;
}

Box Node::local_bounds() const {
    if (const auto* terrain = get<TerrainNode>()) {
        return terrain->surface->bounds();
    }
    if (const auto* mesh = get<MeshNode>()) {
        Box bounds = bounds_of(*mesh->mesh);
        if (mesh->material.detail.set != nullptr && !bounds.empty()) {
            const double reach = mesh->material.technique.options.true_silhouettes
                                     ? hull_reach(*mesh->mesh, mesh->material.detail)
                                     : raised_above(*mesh->mesh, mesh->material.detail);
            bounds = {bounds.low - reach, bounds.high + reach};
        }
        return bounds;
    }
    return {};
}

Box Node::world_bounds() const {
    Box bounds;
    visit_visible(*this, [&](const Node& node, const glm::dmat4& world_from_local) {
        const auto* const mesh = node.get<MeshNode>();
        const bool turns = mesh != nullptr && mesh->facing != Facing::node;
        const Box local = turns ? turned_bounds(node.local_bounds()) : node.local_bounds();
        bounds.add(reljef::transformed(world_from_local, local));
    });
    return bounds;
}

void Node::animate(double time) {
    for (const Animator& animator : animators_) {
        animator(*this, time);
    }
    std::erase_if(children_,
                  [&](const auto& child) { return child->end_ && time >= *child->end_; });
    for (const auto& child : children_) {
        child->animate(time);
    }
}

Result<Node*> Scene::add_terrain(terrain::Terrain terrain, const TerrainOptions& options) {
    std::string name = terrain.name;
    auto surface = TerrainSurface::create(
        std::make_shared<const terrain::Terrain>(std::move(terrain)), options);
    if (!surface) {
        return surface.error();
    }
    return &root_->add(
        std::move(name),
        TerrainNode{std::make_shared<const TerrainSurface>(std::move(*surface)), {}});
}

Node& Scene::add_mesh(Mesh mesh, const Material& material) {
    return root_->add("mesh", MeshNode{std::make_shared<const Mesh>(std::move(mesh)), material});
}

Node& Scene::add_light(const Light& light) {
    return root_->add("light", light);
}

Node& Scene::add_point_light(const PointLight& light, glm::dvec3 place) {
    Node& node = root_->add("point light", light);
    node.set_position(place);
    return node;
}

Node& Scene::add_camera(const Camera& camera) {
    Node& node = root_->add("camera", camera);
    if (active_camera_ == nullptr) {
        active_camera_ = &node;
    }
    return node;
}

void Scene::set_active_camera(Node& node) {
    check(node.get<Camera>() != nullptr, "a camera node was expected");
    active_camera_ = &node;
}

Camera Scene::camera() const {
    if (active_camera_ == nullptr || !contains(*root_, active_camera_)) {
        return {};
    }
    Camera camera = *active_camera_->get<Camera>();
    const glm::dmat4 world_from_local = active_camera_->world_from_local();
    camera.up = glm::dvec3(world_from_local * glm::dvec4(camera.up, 0.0));
    camera.eye = glm::dvec3(world_from_local * glm::dvec4(camera.eye, 1.0));
    camera.target = glm::dvec3(world_from_local * glm::dvec4(camera.target, 1.0));
    return camera;
}

std::optional<Light> Scene::sun() const {
    std::optional<Light> first;
    visit_visible(*root_, [&](const Node& node, const glm::dmat4& world_from_local) {
        if (const auto* light = node.get<Light>(); light != nullptr && !first) {
            first = turned(*light, world_from_local);
        }
    });
    return first;
}

std::vector<PlacedPointLight> Scene::point_lights() const {
    std::vector<PlacedPointLight> lights;
    bool has_sun = false;
    visit_visible(*root_, [&](const Node& node, const glm::dmat4& world_from_local) {
        if (const auto* lamp = node.get<PointLight>()) {
            lights.push_back({*lamp, glm::dvec3(world_from_local[3])});
        } else if (const auto* light = node.get<Light>()) {
            if (has_sun) {
                lights.push_back(as_point_light(turned(*light, world_from_local)));
            }
            has_sun = true;
        }
    });
    return lights;
}

std::optional<double> Scene::height_at(double x, double y) const {
    const Box bounds = root_->world_bounds();
    if (bounds.empty()) {
        return std::nullopt;
    }
    std::optional<double> highest;
    visit_visible(*root_, [&](const Node& node, const glm::dmat4& world_from_local) {
        if (const auto* terrain = node.get<TerrainNode>()) {
            const auto z = height_of(*terrain, world_from_local, {x, y, bounds.high.z + 1.0});
            highest = z ? std::max(*z, highest.value_or(*z)) : highest;
        }
    });
    return highest;
}

std::optional<Scene::Pick> Scene::pick(const Ray& ray) const {
    std::optional<Pick> first;
    visit_visible(*root_, [&](const Node& node, const glm::dmat4& world_from_local) {
        if (const auto* terrain = node.get<TerrainNode>()) {
            const auto hit =
                terrain->surface->pick(transformed(glm::inverse(world_from_local), ray));
            if (hit && (!first || hit->t < first->t)) {
                first = Pick{&node, hit->t, ray.at(hit->t), *hit};
            }
        }
    });
    const auto on_mesh =
        pick_mesh(ray, {0.0, first ? first->t : std::numeric_limits<double>::infinity()});
    return on_mesh ? on_mesh : first;
}

namespace {

// Precondition: the triangle has an area, and the matrix an inverse.
glm::dvec3 world_normal(const Mesh& mesh, std::size_t triangle,
                        const glm::dmat4& world_from_local) {
    const TriangleEdges edges = triangle_edges(mesh, triangle);
    return glm::normalize(glm::inverseTranspose(glm::dmat3(world_from_local)) *
                          glm::normalize(glm::cross(edges.p, edges.q)));
}

} // namespace

std::optional<Scene::Pick> Scene::pick_mesh(const Ray& ray, reljef::Interval range) const {
    std::optional<Pick> first;
    const Camera camera = this->camera();
    visit_visible(*root_, [&](const Node& node, const glm::dmat4& world_from_node) {
        const auto* const mesh = node.get<MeshNode>();
        if (mesh == nullptr) {
            return;
        }
        const glm::dmat4 world_from_local = faced(mesh->facing, world_from_node, camera);
        if (glm::determinant(glm::dmat3(world_from_local)) == 0.0) {
            return; // a plane or a point
        }
        const auto hit =
            trees_->first_hit(mesh->mesh, transformed(glm::inverse(world_from_local), ray), range);
        if (hit) {
            range.end = hit->t;
            first = Pick{.node = &node,
                         .t = hit->t,
                         .world = ray.at(hit->t),
                         .ground = {},
                         .normal = world_normal(*mesh->mesh, hit->triangle, world_from_local)};
        }
    });
    return first;
}

bool Scene::dispatch(const Event& event) const {
    return std::any_of(receivers_.rbegin(), receivers_.rend(),
                       [&](const EventReceiver& receiver) { return receiver(event); });
}

const std::string& object_name(const Node& node) {
    const Node* object = &node;
    while (object->parent() != nullptr && object->parent()->parent() != nullptr) {
        object = object->parent();
    }
    return object->name();
}

void visit_visible(const Node& root, const NodeVisitor& visit) {
    visit_below(root,
                root.parent() != nullptr ? root.parent()->world_from_local() : glm::dmat4(1.0),
                visit);
}

} // namespace reljef::scene
