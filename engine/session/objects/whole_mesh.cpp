#include "engine/session/objects/whole_mesh.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/io/mesh/mesh_file.h"
#include "engine/scene/graph/surface_detail.h"

namespace reljef::session {
namespace {

void append(scene::Mesh& whole, const scene::Mesh& part) {
    const auto first = static_cast<std::uint32_t>(whole.positions.size());
    whole.positions.insert(whole.positions.end(), part.positions.begin(), part.positions.end());
    whole.normals.insert(whole.normals.end(), part.normals.begin(), part.normals.end());
    whole.texture_coordinates.insert(whole.texture_coordinates.end(),
                                     part.texture_coordinates.begin(),
                                     part.texture_coordinates.end());
    for (const std::uint32_t index : part.indices) {
        whole.indices.push_back(first + index);
    }
}

} // namespace

Result<scene::Mesh> read_whole_mesh(const std::filesystem::path& file, double side,
                                    const std::stop_token& stop) {
    const auto found = io::read_mesh_file(file, {}, stop);
    if (!found) {
        return found.error();
    }
    const glm::dvec3 size = found->bounds.size();
    const double largest = std::max({size.x, size.y, size.z});
    scene::Mesh whole;
    for (const io::ColoredMesh& part : found->parts) {
        append(whole, *part.mesh);
    }
    if (!(largest > 0.0)) {
        return Error{fmt::format("{}: a mesh without size found, one with some was expected",
                                 file.string())};
    }
    const glm::dvec3 foot(glm::dvec2(found->bounds.center()), found->bounds.low.z);
    for (glm::vec3& position : whole.positions) {
        position = glm::vec3((glm::dvec3(position) - foot) * (side / largest));
    }
    if (!(scene::tile_width(whole, glm::vec2(1.0F)) > 0.0)) {
        return Error{fmt::format("{}: no texture coordinates found, some were expected, to show "
                                 "detail textures on it",
                                 file.string())};
    }
    return whole;
}

} // namespace reljef::session
