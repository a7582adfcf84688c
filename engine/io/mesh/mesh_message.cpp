#include "engine/io/mesh/mesh_message.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/io/mesh/corner_mesh.h"

namespace reljef::io {
namespace {

constexpr std::uint32_t message_mark = 0x6d6a6c72; // "rljm"
constexpr std::size_t max_text = 4096;
constexpr std::size_t max_picture = std::size_t{256} << 20U;

void append(std::vector<std::byte>& bytes, const void* data, std::size_t size) {
    const std::size_t end = bytes.size();
    bytes.resize(end + size);
    if (size > 0) {
        std::memcpy(bytes.data() + end, data, size);
    }
}

void append_count(std::vector<std::byte>& bytes, std::size_t count) {
    const auto number = static_cast<std::uint64_t>(count);
    append(bytes, &number, sizeof number);
}

template <class T> void append_all(std::vector<std::byte>& bytes, const std::vector<T>& values) {
    append_count(bytes, values.size());
    append(bytes, values.data(), values.size() * sizeof(T));
}

// Reads what was appended. After the first failure everything is empty.
class MessageReader {
public:
    explicit MessageReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    [[nodiscard]] bool good() const { return good_; }
    [[nodiscard]] bool at_end() const { return rest_.empty(); }

    template <class T> T value() {
        static_assert(std::is_trivially_copyable_v<T>);
        T found{};
        if (take(sizeof(T))) {
            std::memcpy(&found, taken_.data(), sizeof(T));
        }
        return found;
    }

    std::size_t count(std::size_t max) {
        const auto found = value<std::uint64_t>();
        good_ = good_ && found <= max;
        return good_ ? static_cast<std::size_t>(found) : 0;
    }

    template <class T> std::vector<T> all(std::size_t max) {
        const std::size_t size = count(max);
        std::vector<T> values;
        if (take(size * sizeof(T)) && size > 0) { // size is at most max: no overflow
            values.resize(size);
            std::memcpy(values.data(), taken_.data(), taken_.size());
        }
        return values;
    }

private:
    bool take(std::size_t size) {
        good_ = good_ && size <= rest_.size();
        taken_ = good_ ? rest_.first(size) : std::span<const std::byte>();
        rest_ = good_ ? rest_.subspan(size) : rest_;
        return good_;
    }

    std::span<const std::byte> rest_;
    std::span<const std::byte> taken_;
    bool good_ = true;
};

bool is_finite(glm::vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_in_reach(glm::vec3 v) {
    return is_finite(v) && std::abs(v.x) <= max_mesh_coordinate &&
           std::abs(v.y) <= max_mesh_coordinate && std::abs(v.z) <= max_mesh_coordinate;
}

// Sums of the normals of the triangles around each vertex, weighted by area.
std::vector<glm::dvec3> face_normals(const scene::Mesh& mesh) {
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const scene::TriangleEdges edges = scene::triangle_edges(mesh, i);
        const glm::dvec3 across = glm::cross(edges.p, edges.q);
        for (std::size_t corner = 0; corner < 3; ++corner) {
            sums[mesh.indices[i + corner]] += across;
        }
    }
    return sums;
}

void mend_normals(scene::Mesh& mesh) {
    mesh.normals.resize(mesh.positions.size(), glm::vec3(0.0F));
    if (std::all_of(mesh.normals.begin(), mesh.normals.end(), is_normal)) {
        for (glm::vec3& normal : mesh.normals) {
            normal = glm::normalize(normal);
        }
        return;
    }
    const std::vector<glm::dvec3> sums = face_normals(mesh);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double length = glm::length(sums[i]);
        mesh.normals[i] = is_normal(mesh.normals[i]) ? glm::normalize(mesh.normals[i])
                          : length > 0.0             ? glm::vec3(sums[i] / length)
                                                     : glm::vec3(0.0F, 0.0F, 1.0F);
    }
}

void mend_coordinates(scene::Mesh& mesh) {
    mesh.texture_coordinates.resize(mesh.positions.size(), glm::vec2(0.0F));
    for (glm::vec2& coordinate : mesh.texture_coordinates) {
        if (!std::isfinite(coordinate.x) || !std::isfinite(coordinate.y)) {
            coordinate = glm::vec2(0.0F);
        }
    }
}

Result<void> check_mesh(const scene::Mesh& mesh) {
    const std::size_t vertices = mesh.positions.size();
    if (mesh.indices.size() % 3 != 0 ||
        std::any_of(mesh.indices.begin(), mesh.indices.end(),
                    [&](std::uint32_t index) { return index >= vertices; })) {
        return Error{"holds triangles without corners, complete ones were expected"};
    }
    if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), is_in_reach)) {
        return Error{fmt::format("holds a point that is over {} m from its origin, or no number; "
                                 "an object around its origin was expected",
                                 max_mesh_coordinate)};
    }
    return {};
}

MeshPart read_part(MessageReader& reader) {
    constexpr std::size_t max_corners = 3 * max_mesh_triangles;
    MeshPart part;
    part.color = reader.value<glm::vec3>();
    const std::vector<char> texture = reader.all<char>(max_text);
    part.texture.assign(texture.begin(), texture.end());
    part.picture = reader.all<std::byte>(max_picture);
    part.mesh.positions = reader.all<glm::vec3>(max_corners);
    part.mesh.normals = reader.all<glm::vec3>(max_corners);
    part.mesh.texture_coordinates = reader.all<glm::vec2>(max_corners);
    part.mesh.indices = reader.all<std::uint32_t>(max_corners);
    return part;
}

} // namespace

std::vector<std::byte> encoded_parts(const std::vector<MeshPart>& parts) {
    std::vector<std::byte> bytes;
    append(bytes, &message_mark, sizeof message_mark);
    append_count(bytes, parts.size());
    for (const MeshPart& part : parts) {
        append(bytes, &part.color, sizeof part.color);
        append_all(bytes, std::vector<char>(part.texture.begin(), part.texture.end()));
        append_all(bytes, part.picture);
        append_all(bytes, part.mesh.positions);
        append_all(bytes, part.mesh.normals);
        append_all(bytes, part.mesh.texture_coordinates);
        append_all(bytes, part.mesh.indices);
    }
    return bytes;
}

Result<std::vector<MeshPart>> decoded_parts(std::span<const std::byte> bytes) {
    MessageReader reader(bytes);
    const bool is_marked = reader.value<std::uint32_t>() == message_mark;
    const std::size_t count = is_marked ? reader.count(max_mesh_parts) : 0;
    std::vector<MeshPart> parts;
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < count && reader.good(); ++i) {
        parts.push_back(read_part(reader));
        triangles += parts.back().mesh.indices.size() / 3;
    }
    if (!is_marked || !reader.good() || !reader.at_end() || triangles > max_mesh_triangles) {
        return Error{"gave an importer's answer that is no mesh, one was expected"};
    }
    for (MeshPart& part : parts) {
        if (auto good = check_mesh(part.mesh); !good) {
            return good.error();
        }
        mend_coordinates(part.mesh); // first: triangles are read with theirs
        mend_normals(part.mesh);
        part.color = is_finite(part.color) ? glm::clamp(part.color, 0.0F, 1.0F) : glm::vec3(0.8F);
    }
    return parts;
}

} // namespace reljef::io
