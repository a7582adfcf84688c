#include "engine/cast/mesh/mesh_trees.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>

#include "engine/scene/graph/mesh.h"

namespace reljef::cast {

// A scene and its device. Instances hold on to the scenes that they show.
struct PlacedMeshes::Scene {
    std::shared_ptr<RTCDeviceTy> device;
    RTCScene scene = nullptr;

    explicit Scene(std::shared_ptr<RTCDeviceTy> of) : device(std::move(of)) {
        if (device != nullptr) {
            scene = rtcNewScene(device.get());
        }
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
    ~Scene() {
        if (scene != nullptr) {
            rtcReleaseScene(scene);
        }
    }

    // False if Embree failed since the last call.
    [[nodiscard]] bool is_good() const {
        return scene != nullptr && rtcGetDeviceError(device.get()) == RTC_ERROR_NONE;
    }
};

namespace {

// One thread builds: the calls come from any thread, and the others have work of their own.
std::shared_ptr<RTCDeviceTy> make_device() {
    return {rtcNewDevice("threads=1,set_affinity=0"), [](RTCDevice device) {
                if (device != nullptr) {
                    rtcReleaseDevice(device);
                }
            }};
}

// What the filter compares.
struct Query {
    RTCIntersectContext context;
    float nearest = std::numeric_limits<float>::infinity();
    unsigned mesh = std::numeric_limits<unsigned>::max();
    unsigned triangle = std::numeric_limits<unsigned>::max();
};

// Takes triangles that face the ray. Of equally near ones the first, whatever the order in which
// the tree shows them.
void take_first_from_outside(const RTCFilterFunctionNArguments* arguments) {
    if (arguments->N != 1 || arguments->valid[0] == 0) {
        return;
    }
    const auto& mesh = *static_cast<const scene::Mesh*>(arguments->geometryUserPtr);
    const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
    const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
    auto& query = *reinterpret_cast<Query*>(arguments->context);
    const scene::TriangleEdges edges = scene::triangle_edges(mesh, std::size_t{3} * hit.primID);
    const glm::dvec3 direction(ray.dir_x, ray.dir_y, ray.dir_z);
    const unsigned instance = arguments->context->instID[0];
    const bool is_outside = glm::dot(glm::cross(edges.p, edges.q), direction) < 0.0;
    const bool is_later = ray.tfar == query.nearest &&
                          std::pair(instance, hit.primID) > std::pair(query.mesh, query.triangle);
    if (!is_outside || is_later) {
        arguments->valid[0] = 0;
        return;
    }
    query.nearest = ray.tfar;
    query.mesh = instance;
    query.triangle = hit.primID;
}

// False without memory.
bool add_triangles(RTCDevice device, RTCScene scene, const scene::Mesh& mesh) {
    const std::size_t triangles = mesh.indices.size() / 3;
    if (triangles == 0) {
        return true;
    }
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* const positions =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(glm::vec3), mesh.positions.size());
    void* const indices = rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles);
    const bool has_memory = positions != nullptr && indices != nullptr;
    if (has_memory) {
        std::memcpy(positions, mesh.positions.data(), mesh.positions.size() * sizeof(glm::vec3));
        std::memcpy(indices, mesh.indices.data(), 3 * triangles * sizeof(std::uint32_t));
        rtcSetGeometryUserData(geometry, const_cast<scene::Mesh*>(&mesh));
        rtcSetGeometryIntersectFilterFunction(geometry, take_first_from_outside);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
    }
    rtcReleaseGeometry(geometry);
    return has_memory;
}

void add_instance(RTCDevice device, RTCScene scene, RTCScene mesh, const glm::dmat4& place,
                  unsigned number) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    std::array<float, 12> columns{};
    for (std::size_t i = 0; i < columns.size(); ++i) {
        columns[i] = static_cast<float>(place[static_cast<int>(i / 3)][static_cast<int>(i % 3)]);
    }
    rtcSetGeometryInstancedScene(geometry, mesh);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, number);
    rtcReleaseGeometry(geometry);
}

// In the triangle that Embree has found (Möller and Trumbore 1997), also where the ray passes it by
// a rounded float.
MeshHit point_on(const scene::Mesh& mesh, const Ray& local, MeshHit hit) {
    const scene::TriangleEdges edges = scene::triangle_edges(mesh, hit.triangle);
    const glm::dvec3 across = glm::cross(local.direction, edges.q);
    const double facing = glm::dot(edges.p, across);
    const glm::dvec3 from_corner = local.origin - edges.corner;
    const glm::dvec3 aside = glm::cross(from_corner, edges.p);
    const double second = glm::dot(from_corner, across);
    const double third = glm::dot(local.direction, aside);
    const bool is_sound = facing > 0.0;
    hit.shares.x = is_sound ? glm::clamp(second / facing, 0.0, 1.0) : 0.0;
    hit.shares.y = is_sound ? glm::clamp(third / facing, 0.0, 1.0 - hit.shares.x) : 0.0;
    const glm::dvec3 place =
        edges.corner + hit.shares.x * edges.p + hit.shares.y * edges.q - local.origin;
    hit.t = glm::dot(place, local.direction) / glm::dot(local.direction, local.direction);
    return hit;
}

// Embree aborts on rays of larger numbers; what is scaled down so far cannot be seen.
bool can_be_cast(const glm::dmat4& relative_from_local) {
    const double volume = std::abs(glm::determinant(relative_from_local));
    if (!(volume >= std::numeric_limits<double>::min())) {
        return false;
    }
    const glm::dmat4 local_from_relative = glm::inverse(relative_from_local);
    constexpr double largest = 0x1p59;
    bool all = true;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            all = all && std::abs(local_from_relative[column][row]) < largest; // false for NaN
        }
    }
    return all;
}

double extent_of(const Box& bounds) {
    return glm::length(glm::max(glm::abs(bounds.low), glm::abs(bounds.high)));
}

PlacedMesh placed_at(const view::MeshDraw& draw, const glm::dmat4& relative_from_local,
                     const Box& bounds) {
    const glm::dmat3 linear(relative_from_local);
    const double largest =
        std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    PlacedMesh placed{*draw.mesh, glm::inverse(relative_from_local), glm::inverseTranspose(linear),
                      bounds, largest * extent_of(bounds)};
    placed.node.mesh = view::drawn_mesh(draw);
    return placed;
}

RTCRay float_ray(glm::vec3 origin, glm::vec3 direction, float begin, float end) {
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tnear = begin;
    ray.tfar = end;
    ray.mask = ~0U;
    return ray;
}

} // namespace

std::optional<MeshHit> PlacedMeshes::first_hit(const Ray& ray, Interval range) const {
    Query query;
    rtcInitIntersectContext(&query.context);
    RTCRayHit found{};
    // Embree aborts on a range that begins before the origin, as that of a map may.
    const double moved = std::min(range.begin, 0.0);
    found.ray =
        float_ray(glm::vec3(ray.at(moved)), glm::vec3(ray.direction),
                  static_cast<float>(range.begin - moved), static_cast<float>(range.end - moved));
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_->scene, &query.context, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return std::nullopt;
    }
    MeshHit hit;
    hit.mesh = found.hit.instID[0];
    hit.triangle = std::size_t{3} * found.hit.primID;
    const PlacedMesh& mesh = meshes_[hit.mesh];
    const Ray local{glm::dvec3(mesh.local_from_relative * glm::dvec4(ray.origin, 1.0)),
                    glm::dmat3(mesh.local_from_relative) * ray.direction};
    return point_on(*mesh.node.mesh, local, hit);
}

bool PlacedMeshes::hides(glm::vec3 origin, glm::vec3 direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = float_ray(origin, direction, 0.0F, std::numeric_limits<float>::infinity());
    rtcOccluded1(scene_->scene, &context, &ray);
    return ray.tfar < 0.0F;
}

Result<const MeshTrees::Tree*> MeshTrees::tree_of(const std::shared_ptr<const scene::Mesh>& mesh) {
    Tree& tree = trees_[mesh.get()];
    if (tree.owner.lock() == mesh) {
        return &tree;
    }
    const auto made = std::make_shared<const PlacedMeshes::Scene>(device_->device);
    bool is_good = made->scene != nullptr;
    if (is_good) {
        rtcSetSceneFlags(made->scene, RTC_SCENE_FLAG_ROBUST);
        is_good = add_triangles(made->device.get(), made->scene, *mesh);
        rtcCommitScene(made->scene);
    }
    if (!made->is_good() || !is_good) {
        trees_.erase(mesh.get());
        return Error{fmt::format("rays on the CPU: a mesh of {} triangles found, fewer were "
                                 "expected: the memory for their tree is missing",
                                 mesh->indices.size() / 3)};
    }
    tree = {mesh, made, scene::bounds_of(*mesh)};
    return &tree;
}

Result<PlacedMeshes> MeshTrees::place(std::span<const view::MeshDraw> seen,
                                      std::span<const view::MeshDraw> beside, glm::dvec3 eye) {
    std::erase_if(trees_, [](const auto& entry) { return entry.second.owner.expired(); });
    if (device_ == nullptr) {
        device_ = std::make_shared<const PlacedMeshes::Scene>(make_device());
    }
    const auto all = std::make_shared<const PlacedMeshes::Scene>(device_->device);
    if (all->scene == nullptr) {
        return Error{
            "rays on the CPU: a mesh found, none was expected: the memory for Embree is missing"};
    }
    rtcSetSceneFlags(all->scene, RTC_SCENE_FLAG_ROBUST);
    PlacedMeshes placed;
    for (const auto& draws : {seen, beside}) {
        for (const view::MeshDraw& draw : draws) {
            glm::dmat4 relative_from_local = draw.world_from_local;
            relative_from_local[3] -= glm::dvec4(eye, 0.0);
            if (!can_be_cast(relative_from_local)) {
                continue;
            }
            const auto tree = tree_of(view::drawn_mesh(draw));
            if (!tree) {
                return tree.error();
            }
            add_instance(all->device.get(), all->scene, (*tree)->scene->scene, relative_from_local,
                         static_cast<unsigned>(placed.meshes_.size()));
            placed.meshes_.push_back(placed_at(draw, relative_from_local, (*tree)->bounds));
        }
    }
    rtcCommitScene(all->scene);
    if (!all->is_good()) {
        return Error{
            fmt::format("rays on the CPU: {} meshes found, fewer were expected: the memory "
                        "for their tree is missing",
                        placed.meshes_.size())};
    }
    placed.scene_ = all;
    return placed;
}

} // namespace reljef::cast
