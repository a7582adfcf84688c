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

const scene::Displacement* displacement_of(const view::MeshDraw& draw) {
    const scene::TechniqueParameters& parameters = draw.mesh->material.technique.parameters;
    return has_tile(draw) ? std::get_if<scene::Displacement>(&parameters) : nullptr;
}

bool is_displaced(const view::MeshDraw& draw) {
    return displacement_of(draw) != nullptr;
}

// Of displacement; 0 for other techniques.
double max_texels(const view::MeshDraw& draw) {
    const scene::Displacement* const displacement = displacement_of(draw);
    return displacement == nullptr ? 0.0 : displacement->max_texels;
}

bool has_hull(const view::MeshDraw& draw) {
    return has_tile(draw) && draw.mesh->material.technique.options.true_silhouettes;
}

TileSide side_of(const view::MeshDraw& draw) {
    const scene::Material& material = draw.mesh->material;
    return {layers_for(material.technique.id()),
            scene::visible_detail(material).border == material::WrapMode::wrap, draw.from_behind};
}

std::vector<PlainVertex> plain_vertices(const scene::Mesh& mesh) {
    std::vector<PlainVertex> vertices;
    vertices.reserve(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        vertices.push_back({mesh.positions[i], mesh.normals[i]});
    }
    return vertices;
}

// At `positions`, with the tangent frames of the original mesh.
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
upload_mesh(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices,
            std::span<const gl::VertexAttribute> attributes, view::FrameStats& stats) {
    auto mesh = upload_vertices(bytes_of(vertices), sizeof(Vertex), attributes, stats);
    return with_indices(std::move(mesh), indices, stats);
}

template <class Entry>
const Entry* find_for(const std::vector<Entry>& entries, const view::MeshDraw& draw) {
    const auto found = std::find_if(entries.begin(), entries.end(),
                                    [&](const Entry& entry) { return entry.is_for(draw); });
    return found == entries.end() ? nullptr : &*found;
}

// Minimum and maximum texture coordinate at the bottom of a hull.
glm::vec4 coordinate_range(const std::vector<HullPart>& parts) {
    glm::vec2 low(std::numeric_limits<float>::max());
    glm::vec2 high(std::numeric_limits<float>::lowest());
    for (const HullPart& part : parts) {
        for (std::size_t i = 0; i < 4; ++i) {
            if (part.corners[i].w < 0.5F) {
                const glm::vec4 two = part.coordinates[i / 2];
                const glm::vec2 coordinate = i % 2 == 0 ? glm::vec2(two) : glm::vec2(two.z, two.w);
                low = glm::min(low, coordinate);
                high = glm::max(high, coordinate);
            }
        }
    }
    return {low, high};
}

Result<ResidentHull> resident_hull(const std::vector<HullPart>& parts, view::FrameStats& stats) {
    if (parts.empty()) {
        return ResidentHull{};
    }
    auto buffer = upload_buffer(bytes_of(parts), stats);
    if (!buffer) {
        return buffer.error();
    }
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

template <class Resident>
bool MeshResidency::Derived<Resident>::is_for(const view::MeshDraw& draw) const {
    return owner.lock() == view::drawn_mesh(draw) &&
           detail == scene::visible_detail(draw.mesh->material) && texels == max_texels(draw);
}

Result<void> MeshResidency::prepare(const std::vector<view::MeshDraw>& draws,
                                    const scene::Camera& camera, view::FrameStats& stats) {
    forget_unused(draws);
    for (const view::MeshDraw& draw : draws) {
        const scene::Mesh& mesh = *view::drawn_mesh(draw);
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
    std::erase_if(displaced_, [&](const auto& entry) {
        return std::ranges::none_of(draws, [&](const view::MeshDraw& draw) {
            return is_displaced(draw) && entry.is_for(draw);
        });
    });
    std::erase_if(hulls_, [&](const auto& entry) {
        return std::ranges::none_of(draws, [&](const view::MeshDraw& draw) {
            return has_hull(draw) && entry.is_for(draw);
        });
    });
}

Result<void> MeshResidency::prepare_hull(const view::MeshDraw& draw, view::FrameStats& stats) {
    if (find_for(hulls_, draw) != nullptr) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const scene::SurfaceDetail detail = scene::visible_detail(draw.mesh->material);
    auto hull = resident_hull(hull_parts(*view::drawn_mesh(draw), detail), stats);
    if (!hull) {
        return hull.error();
    }
    hulls_.push_back({view::drawn_mesh(draw), detail, max_texels(draw), std::move(*hull)});
    return {};
}

Result<void> MeshResidency::prepare_triangles(const view::MeshDraw& draw, view::FrameStats& stats) {
    const scene::Mesh& mesh = *view::drawn_mesh(draw);
    const std::pair key{&mesh, has_tile(draw) ? Look::textured : Look::plain};
    if (triangles_.contains(key)) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    auto made = has_tile(draw)
                    ? upload_mesh(textured_vertices(mesh, mesh.positions), mesh.indices,
                                  textured_attributes, stats)
                    : upload_mesh(plain_vertices(mesh), mesh.indices, plain_attributes, stats);
    if (!made) {
        return made.error();
    }
    triangles_.emplace(key, Triangles{view::drawn_mesh(draw), std::move(*made)});
    return {};
}

Result<void> MeshResidency::prepare_displaced(const view::MeshDraw& draw, view::FrameStats& stats) {
    if (find_for(displaced_, draw) != nullptr) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const double texels = max_texels(draw);
    const scene::SurfaceDetail detail = scene::visible_detail(draw.mesh->material);
    const scene::Mesh fine = scene::tessellated(
        *view::drawn_mesh(draw), scene::cuts_for(*view::drawn_mesh(draw), detail, texels));
    auto made = upload_mesh(textured_vertices(fine, scene::displaced_positions(fine, detail)),
                            fine.indices, textured_attributes, stats);
    if (!made) {
        return made.error();
    }
    displaced_.push_back({view::drawn_mesh(draw), detail, texels, std::move(*made)});
    return {};
}

Result<void> MeshResidency::prepare_warps(const std::vector<view::MeshDraw>& draws,
                                          const scene::Camera& camera, view::FrameStats& stats) {
    std::map<const scene::MeshNode*, gl::Texture2D> last = std::exchange(warps_, {});
    for (const view::MeshDraw& draw : draws) {
        const scene::Material& material = draw.mesh->material;
        if (!has_tile(draw) || material.technique.id() != scene::TechniqueId::prewarp) {
            continue;
        }
        const auto plane = scene::texture_plane(*view::drawn_mesh(draw));
        check(plane.has_value(), "a warp of a mesh that is not flat");
        const scene::SurfaceDetail detail = scene::visible_detail(material);
        const Grid<glm::vec4> shown =
            warped_tile(*plane, detail, scene::relief_height(*view::drawn_mesh(draw), detail),
                        warp_eye(camera, draw.world_from_local));
        auto texture = upload_places(shown, last[draw.mesh], stats);
        if (!texture) {
            return texture.error();
        }
        warps_.emplace(draw.mesh, std::move(*texture));
    }
    return {};
}

const ResidentHull& MeshResidency::hull(const view::MeshDraw& draw) const {
    return checked_pointer(find_for(hulls_, draw), "a hull that was not prepared").resident;
}

const ResidentMesh& MeshResidency::mesh(const view::MeshDraw& draw) const {
    if (is_displaced(draw)) {
        return checked_pointer(find_for(displaced_, draw), "a displaced mesh that was not prepared")
            .resident;
    }
    return triangles_
        .at({view::drawn_mesh(draw).get(), has_tile(draw) ? Look::textured : Look::plain})
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
