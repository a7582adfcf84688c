// Tangent frames of meshes that have none.
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "bench/stress/stress_run.h"
#include "engine/scene/graph/tangent_frames.h"

namespace reljef::bench {
namespace {

// The axes are floats: each product of three terms is off by a few units of the last place.
constexpr double frame_tolerance = 1e-5;

struct OddMesh {
    std::string name;
    scene::Mesh mesh;
};

template <class Change> OddMesh changed(std::string name, const Change& change) {
    OddMesh odd{std::move(name), scene::sphere_mesh(1.0F, 12)};
    change(odd.mesh);
    return odd;
}

std::vector<OddMesh> odd_meshes() {
    std::vector<OddMesh> all;
    all.push_back(changed("triangles without area", [](scene::Mesh& mesh) {
        std::fill(mesh.positions.begin(), mesh.positions.end(), glm::vec3(1.0F));
    }));
    all.push_back(changed("equal texture coordinates", [](scene::Mesh& mesh) {
        std::fill(mesh.texture_coordinates.begin(), mesh.texture_coordinates.end(),
                  glm::vec2(0.25F));
    }));
    all.push_back(changed("mirrored texture", [](scene::Mesh& mesh) {
        for (glm::vec2& place : mesh.texture_coordinates) {
            place.x = -place.x;
        }
    }));
    all.push_back(changed("texture along one line", [](scene::Mesh& mesh) {
        for (glm::vec2& place : mesh.texture_coordinates) {
            place.y = 3.0F * place.x;
        }
    }));
    for (const float scale : {1e-20F, 1e20F}) {
        all.push_back(changed(fmt::format("metres times {:g}", scale), [scale](scene::Mesh& mesh) {
            for (glm::vec3& position : mesh.positions) {
                position *= scale;
            }
        }));
        all.push_back(
            changed(fmt::format("texture coordinates times {:g}", scale), [scale](auto& mesh) {
                for (glm::vec2& place : mesh.texture_coordinates) {
                    place *= scale;
                }
            }));
    }
    return all;
}

bool is_orthonormal(const scene::TangentFrame& frame, glm::dvec3 normal) {
    const glm::dvec3 tangent(frame.tangent);
    return std::abs(glm::length(tangent) - 1.0) <= frame_tolerance &&
           std::abs(glm::dot(tangent, normal)) <= frame_tolerance &&
           std::abs(frame.handedness) == 1.0F && std::isfinite(frame.density.x) &&
           std::isfinite(frame.density.y);
}

} // namespace

Result<void> stress_tangent_frames(StressRun& run) {
    for (const OddMesh& odd : odd_meshes()) {
        const std::vector<scene::TangentFrame> frames = scene::tangent_frames(odd.mesh);
        double bad = 0.0;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            bad += is_orthonormal(frames[i], glm::dvec3(odd.mesh.normals[i])) ? 0.0 : 1.0;
        }
        run.add({.stress = "tangent frames",
                 .figure = "frames not orthonormal or not finite",
                 .value = bad,
                 .limit = 0.0,
                 .at = odd.name});
    }
    return {};
}

} // namespace reljef::bench
