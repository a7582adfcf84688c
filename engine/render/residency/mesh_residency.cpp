#include "engine/render/residency/mesh_residency.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>

#include "engine/render/residency/hull_mesh.h"
#include "engine/render/residency/mesh_warp.h"
#include "engine/render/residency/prewarp.h"
#include "engine/render/residency/uploads.h"
#include "engine/scene/graph/tangent_frames.h"

namespace reljef::render {
namespace {

struct PlainVertex {
    glm::vec3 position;
    glm::vec3 normal;
};

// One vertex as in tile_vertex.glsl.
struct TexturedVertex {
    glm::vec3 position;
    glm::vec3 normal;
    glm::vec2 texture_coordinate;
    glm::vec4 tangent; // w: handedness
    glm::vec2 density;
};
static_assert(sizeof(TexturedVertex) == 56);

constexpr std::array plain_attributes{
    gl::VertexAttribute{.location = 0, .components = 3},
    gl::VertexAttribute{.location = 1, .components = 3, .offset = offsetof(PlainVertex, normal)}};
constexpr std::array textured_attributes{
    gl::VertexAttribute{.location = 0, .components = 3},
    gl::VertexAttribute{.location = 1, .components = 3, .offset = offsetof(TexturedVertex, normal)},
    gl::VertexAttribute{
        .location = 2, .components = 2, .offset = offsetof(TexturedVertex, texture_coordinate)},
    gl::VertexAttribute{
        .location = 3, .components = 4, .offset = offsetof(TexturedVertex, tangent)},
    gl::VertexAttribute{
        .location = 4, .components = 2, .offset = offsetof(TexturedVertex, density)}};

bool has_tile(const view::MeshDraw& draw) {
    return draw.mesh->material.detail.set != nullptr;
}

// Null where it moves no vertices.
const scene::Displacement* displacement_of(const view::MeshDraw& draw) {
    const scene::TechniqueParameters& parameters = draw.mesh->material.technique.parameters;
    return has_tile(draw) ? std::get_if<scene::Displacement>(&parameters) : nullptr;
}

bool is_displaced(const view::MeshDraw& draw) {
    return displacement_of(draw) != nullptr;
}

bool has_hull(const view::MeshDraw& draw) {
    return has_tile(draw) && draw.mesh->material.technique.options.true_silhouettes;
}

// Which surface of its tile is shown.
TileSide side_of(const view::MeshDraw& draw) {
    const scene::Material& material = draw.mesh->material;
    return {layers_for(material.technique.id()),
            scene::shown_detail(material).border == material::WrapMode::wrap, draw.from_behind};
}

std::vector<PlainVertex> plain_vertices(const scene::Mesh& mesh) {
    std::vector<PlainVertex> vertices;
    vertices.reserve(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        vertices.push_back({mesh.positions[i], mesh.normals[i]});
    }
    return vertices;
}

// At `positions`, with the frames of the mesh as it is.
std::vector<TexturedVertex> textured_vertices(const scene::Mesh& mesh,
                                              const std::vector<glm::vec3>& positions) {
    const std::vector<scene::TangentFrame> frames = scene::tangent_frames(mesh);
    std::vector<TexturedVertex> vertices;
    vertices.reserve(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        vertices.push_back({positions[i], mesh.normals[i], mesh.texture_coordinates[i],
                            glm::vec4(frames[i].tangent, frames[i].handedness), frames[i].density});
    }
    return vertices;
}

template <class Vertex>
Result<ResidentMesh>
filled(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices,
       std::span<const gl::VertexAttribute> attributes, view::FrameStats& stats) {
    auto vertex_buffer = gl::Buffer::create(bytes_of(vertices));
    if (!vertex_buffer) {
        return vertex_buffer.error();
    }
    auto index_buffer = gl::Buffer::create(bytes_of(indices));
    if (!index_buffer) {
        return index_buffer.error();
    }
    count_upload(stats, vertex_buffer->size());
    count_upload(stats, index_buffer->size());
    ResidentMesh mesh{std::move(*vertex_buffer), gl::VertexArray::create(),
                      static_cast<int>(indices.size()), std::move(*index_buffer)};
    mesh.vertex_array.set_vertices(mesh.vertices, {.stride = sizeof(Vertex)}, attributes);
    mesh.vertex_array.set_indices(mesh.indices);
    return mesh;
}

// Of the texture where a hull is lowest: least and greatest.
glm::vec4 coordinate_range(const std::vector<HullPart>& parts) {
    glm::vec2 least(std::numeric_limits<float>::max());
    glm::vec2 greatest(std::numeric_limits<float>::lowest());
    for (const HullPart& part : parts) {
        for (std::size_t i = 0; i < 4; ++i) {
            if (part.corners[i].w < 0.5F) {
                const glm::vec4 two = part.coordinates[i / 2];
                const glm::vec2 coordinate = i % 2 == 0 ? glm::vec2(two) : glm::vec2(two.z, two.w);
                least = glm::min(least, coordinate);
                greatest = glm::max(greatest, coordinate);
            }
        }
    }
    return {least, greatest};
}

Result<ResidentHull> resident_hull(const std::vector<HullPart>& parts, view::FrameStats& stats) {
    if (parts.empty()) {
        return ResidentHull{};
    }
    auto buffer = gl::Buffer::create(bytes_of(parts));
    if (!buffer) {
        return buffer.error();
    }
    count_upload(stats, buffer->size());
    std::vector<gl::VertexAttribute> attributes;
    const auto add = [&](unsigned int location, int components, std::size_t offset) {
        attributes.push_back({.location = location, .components = components, .offset = offset});
    };
    for (unsigned int i = 0; i < 4; ++i) {
        add(i, 4, offsetof(HullPart, corners) + i * sizeof(glm::vec4));
        add(6 + i, 4, offsetof(HullPart, normals) + i * sizeof(glm::vec4));
    }
    add(4, 4, offsetof(HullPart, coordinates));
    add(5, 4, offsetof(HullPart, coordinates) + sizeof(glm::vec4));
    ResidentHull hull{std::move(*buffer), gl::VertexArray::create(), static_cast<int>(parts.size()),
                      coordinate_range(parts)};
    hull.vertex_array.set_vertices(hull.parts, {.stride = sizeof(HullPart), .divisor = 1},
                                   attributes);
    return hull;
}

} // namespace

Result<void> MeshResidency::prepare(const std::vector<view::MeshDraw>& draws,
                                    const scene::Camera& camera, view::FrameStats& stats) {
    forget_unused(draws);
    for (const view::MeshDraw& draw : draws) {
        const scene::Mesh& mesh = *draw.mesh->mesh;
        if (mesh.indices.empty()) {
            continue;
        }
        check(mesh.normals.size() == mesh.positions.size(),
              "a mesh needs a normal for every position");
        auto done = has_hull(draw)       ? prepare_hull(draw, stats)
                    : is_displaced(draw) ? prepare_displaced(draw, stats)
                                         : prepare_triangles(draw, stats);
        if (done && has_tile(draw)) {
            const scene::Material& material = draw.mesh->material;
            done =
                tiles_.prepare(material.detail.set, side_of(draw), material.technique.id(), stats);
        }
        if (!done) {
            return done;
        }
    }
    return prepare_warps(draws, camera, stats);
}

void MeshResidency::forget_unused(const std::vector<view::MeshDraw>& draws) {
    const auto is_gone = [](const auto& entry) { return entry.second.owner.expired(); };
    std::erase_if(triangles_, is_gone);
    tiles_.forget_unused();
    for (Displaced& entry : displaced_) {
        entry.drawn = std::any_of(draws.begin(), draws.end(), [&](const view::MeshDraw& draw) {
            return is_displaced(draw) && displaced(draw) == &entry;
        });
    }
    std::erase_if(displaced_, [](const Displaced& entry) { return !entry.drawn; });
    for (Hull& entry : hulls_) {
        entry.drawn = std::any_of(draws.begin(), draws.end(), [&](const view::MeshDraw& draw) {
            return has_hull(draw) && find_hull(draw) == &entry;
        });
    }
    std::erase_if(hulls_, [](const Hull& entry) { return !entry.drawn; });
}

Result<void> MeshResidency::prepare_hull(const view::MeshDraw& draw, view::FrameStats& stats) {
    if (find_hull(draw) != nullptr) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const scene::SurfaceDetail detail = scene::shown_detail(draw.mesh->material);
    auto hull = resident_hull(hull_parts(*draw.mesh->mesh, detail), stats);
    if (!hull) {
        return hull.error();
    }
    hulls_.push_back({draw.mesh->mesh, detail, std::move(*hull), true});
    return {};
}

Result<void> MeshResidency::prepare_triangles(const view::MeshDraw& draw, view::FrameStats& stats) {
    const scene::Mesh& mesh = *draw.mesh->mesh;
    const std::pair key{&mesh, has_tile(draw) ? Look::textured : Look::plain};
    if (triangles_.contains(key)) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    auto made = has_tile(draw)
                    ? filled(textured_vertices(mesh, mesh.positions), mesh.indices,
                             textured_attributes, stats)
                    : filled(plain_vertices(mesh), mesh.indices, plain_attributes, stats);
    if (!made) {
        return made.error();
    }
    triangles_.emplace(key, Triangles{draw.mesh->mesh, std::move(*made)});
    return {};
}

Result<void> MeshResidency::prepare_displaced(const view::MeshDraw& draw, view::FrameStats& stats) {
    if (displaced(draw) != nullptr) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const scene::Material& material = draw.mesh->material;
    const double texels = displacement_of(draw)->max_texels;
    const scene::SurfaceDetail detail = scene::shown_detail(material);
    const scene::Mesh fine =
        scene::tessellated(*draw.mesh->mesh, scene::cuts_for(*draw.mesh->mesh, detail, texels));
    auto made = filled(textured_vertices(fine, scene::displaced_positions(fine, detail)),
                       fine.indices, textured_attributes, stats);
    if (!made) {
        return made.error();
    }
    displaced_.push_back({draw.mesh->mesh, detail, texels, std::move(*made), true});
    return {};
}

Result<void> MeshResidency::prepare_warps(const std::vector<view::MeshDraw>& draws,
                                          const scene::Camera& camera, view::FrameStats& stats) {
    std::map<const scene::MeshNode*, gl::Texture2D> before = std::exchange(warps_, {});
    for (const view::MeshDraw& draw : draws) {
        const scene::Material& material = draw.mesh->material;
        if (!has_tile(draw) || material.technique.id() != scene::TechniqueId::prewarp) {
            continue;
        }
        const auto plane = scene::texture_plane(*draw.mesh->mesh);
        check(plane.has_value(), "a warp of a mesh that is not flat");
        const scene::SurfaceDetail detail = scene::shown_detail(material);
        const Grid<glm::vec4> shown =
            warped_tile(*plane, detail, scene::relief_height(*draw.mesh->mesh, detail),
                        warp_eye(camera, draw.world_from_local));
        auto texture = place_texture({shown.cols(), shown.rows()}, before[draw.mesh]);
        if (!texture) {
            return texture.error();
        }
        texture->upload(0, shown);
        count_upload(stats, texture->bytes());
        warps_.emplace(draw.mesh, std::move(*texture));
    }
    return {};
}

const MeshResidency::Displaced* MeshResidency::displaced(const view::MeshDraw& draw) const {
    const scene::Material& material = draw.mesh->material;
    const scene::SurfaceDetail detail = scene::shown_detail(material);
    const double texels = displacement_of(draw)->max_texels;
    const auto found =
        std::find_if(displaced_.begin(), displaced_.end(), [&](const Displaced& entry) {
            return entry.owner.lock() == draw.mesh->mesh && entry.detail == detail &&
                   entry.texels == texels;
        });
    return found == displaced_.end() ? nullptr : &*found;
}

const MeshResidency::Hull* MeshResidency::find_hull(const view::MeshDraw& draw) const {
    const scene::SurfaceDetail detail = scene::shown_detail(draw.mesh->material);
    const auto found = std::find_if(hulls_.begin(), hulls_.end(), [&](const Hull& entry) {
        return entry.owner.lock() == draw.mesh->mesh && entry.detail == detail;
    });
    return found == hulls_.end() ? nullptr : &*found;
}

const ResidentHull& MeshResidency::hull(const view::MeshDraw& draw) const {
    const Hull* const entry = find_hull(draw);
    check(entry != nullptr, "a hull that was not prepared");
    return entry->resident;
}

const ResidentMesh& MeshResidency::mesh(const view::MeshDraw& draw) const {
    if (is_displaced(draw)) {
        const Displaced* const entry = displaced(draw);
        check(entry != nullptr, "a displaced mesh that was not prepared");
        return entry->resident;
    }
    return triangles_.at({draw.mesh->mesh.get(), has_tile(draw) ? Look::textured : Look::plain})
        .resident;
}

const ResidentTile& MeshResidency::tile(const view::MeshDraw& draw) const {
    return tiles_.tile(draw.mesh->material.detail.set, side_of(draw));
}

const gl::Texture2D* MeshResidency::warp(const view::MeshDraw& draw) const {
    const auto found = warps_.find(draw.mesh);
    return found == warps_.end() ? nullptr : &found->second;
}

const ResidentSurface& MeshResidency::surface(const view::MeshDraw& draw) const {
    return tiles_.surface(draw.mesh->material.detail.set, side_of(draw));
}

} // namespace reljef::render
