#include "engine/render/mesh_residency.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/render/relief_maps.h"
#include "engine/render/uploads.h"
#include "engine/scene/tangent_frames.h"

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

bool has_tile(const MeshDraw& draw) {
    return draw.mesh->material.detail.set != nullptr;
}

bool is_displaced(const MeshDraw& draw) {
    return has_tile(draw) && draw.mesh->material.technique.id == scene::TechniqueId::displacement;
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
Result<ResidentMesh> filled(const std::vector<Vertex>& vertices,
                            const std::vector<std::uint32_t>& indices,
                            std::span<const gl::VertexAttribute> attributes, FrameStats& stats) {
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
    mesh.vertex_array.set_vertices(0, mesh.vertices, {.stride = sizeof(Vertex)}, attributes);
    mesh.vertex_array.set_indices(mesh.indices);
    return mesh;
}

// x and y of the normals, as rg16_snorm has them.
std::vector<glm::i16vec2> packed_normals(const Grid<glm::vec3>& normals) {
    std::vector<glm::i16vec2> packed;
    packed.reserve(normals.size());
    for (const glm::vec3& normal : normals.samples()) {
        packed.emplace_back(glm::round(glm::vec2(normal) * 32767.0F));
    }
    return packed;
}

// The heights with those that lie between the tile and its next copies; at least one cell.
Grid<float> with_next_copies(const Grid<float>& heights, bool wraps) {
    const int more = wraps ? 1 : 0;
    Grid<float> all(std::max(heights.cols() + more, 2), std::max(heights.rows() + more, 2));
    for (int row = 0; row < all.rows(); ++row) {
        for (int col = 0; col < all.cols(); ++col) {
            all(col, row) = wraps ? heights(col % heights.cols(), row % heights.rows())
                                  : heights.clamped(col, row);
        }
    }
    return all;
}

Result<ResidentTile> uploaded(const terrain::TextureSet& set, bool wraps, FrameStats& stats) {
    const gl::Wrap wrap = wraps ? gl::Wrap::repeat : gl::Wrap::clamp;
    auto color = mipmapped({set.color.cols(), set.color.rows()}, gl::Format::rgba8_srgb,
                           std::as_bytes(set.color.samples()), stats, wrap);
    if (!color) {
        return color.error();
    }
    auto normals = mipmapped({set.normals.cols(), set.normals.rows()}, gl::Format::rg16_snorm,
                             bytes_of(packed_normals(set.normals)), stats, wrap);
    if (!normals) {
        return normals.error();
    }
    auto heights = tile_height_texture(set.heights, wrap, stats);
    if (!heights) {
        return heights.error();
    }
    const Grid<float> all = with_next_copies(set.heights, wraps);
    return ResidentTile{std::move(*color),
                        std::move(*heights),
                        std::move(*normals),
                        std::nullopt,
                        {all.cols() - 1, all.rows() - 1}};
}

} // namespace

Result<void> MeshResidency::prepare(const std::vector<MeshDraw>& draws, FrameStats& stats) {
    forget_unused(draws);
    for (const MeshDraw& draw : draws) {
        const scene::Mesh& mesh = *draw.mesh->mesh;
        if (mesh.indices.empty()) {
            continue;
        }
        check(mesh.normals.size() == mesh.positions.size(),
              "a mesh needs a normal for every position");
        auto done =
            is_displaced(draw) ? prepare_displaced(draw, stats) : prepare_triangles(draw, stats);
        if (done && has_tile(draw)) {
            done = prepare_tile(draw, stats);
        }
        if (!done) {
            return done;
        }
    }
    return {};
}

void MeshResidency::forget_unused(const std::vector<MeshDraw>& draws) {
    const auto is_gone = [](const auto& entry) { return entry.second.owner.expired(); };
    std::erase_if(triangles_, is_gone);
    std::erase_if(tiles_, is_gone);
    for (Displaced& entry : displaced_) {
        entry.drawn = std::any_of(draws.begin(), draws.end(), [&](const MeshDraw& draw) {
            return is_displaced(draw) && displaced(draw) == &entry;
        });
    }
    std::erase_if(displaced_, [](const Displaced& entry) { return !entry.drawn; });
}

Result<void> MeshResidency::prepare_triangles(const MeshDraw& draw, FrameStats& stats) {
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

Result<void> MeshResidency::prepare_displaced(const MeshDraw& draw, FrameStats& stats) {
    if (displaced(draw) != nullptr) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const scene::Material& material = draw.mesh->material;
    const double texels = material.technique.values.front();
    const scene::TextureDetail detail = scene::shown_detail(material);
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

MeshResidency::TileKey MeshResidency::key_of(const scene::TextureDetail& detail) {
    return {detail.set.get(), detail.border == terrain::TileBorder::wrap};
}

Result<void> MeshResidency::prepare_tile(const MeshDraw& draw, FrameStats& stats) {
    const scene::TextureDetail detail = scene::shown_detail(draw.mesh->material);
    const auto key = key_of(detail);
    auto found = tiles_.find(key);
    if (found == tiles_.end()) {
        auto tile = uploaded(*detail.set, key.second, stats);
        if (!tile) {
            return tile.error();
        }
        found = tiles_.emplace(key, Tile{detail.set, std::move(*tile)}).first;
    } else {
        ++stats.skipped.uploads_unchanged;
    }
    std::optional<gl::Texture2D>& greatest = found->second.resident.greatest;
    if (draw.mesh->material.technique.id == scene::TechniqueId::exact && !greatest) {
        const Grid<float> heights = with_next_copies(detail.set->heights, key.second);
        auto texture = pyramid_texture(greatest_heights(heights.view()), stats);
        if (!texture) {
            return texture.error();
        }
        greatest = std::move(*texture);
    }
    return {};
}

const MeshResidency::Displaced* MeshResidency::displaced(const MeshDraw& draw) const {
    const scene::Material& material = draw.mesh->material;
    const scene::TextureDetail detail = scene::shown_detail(material);
    const auto found =
        std::find_if(displaced_.begin(), displaced_.end(), [&](const Displaced& entry) {
            return entry.owner.lock() == draw.mesh->mesh && entry.detail == detail &&
                   entry.texels == material.technique.values.front();
        });
    return found == displaced_.end() ? nullptr : &*found;
}

const ResidentMesh& MeshResidency::mesh(const MeshDraw& draw) const {
    if (is_displaced(draw)) {
        const Displaced* const entry = displaced(draw);
        check(entry != nullptr, "a displaced mesh that was not prepared");
        return entry->resident;
    }
    return triangles_.at({draw.mesh->mesh.get(), has_tile(draw) ? Look::textured : Look::plain})
        .resident;
}

const ResidentTile& MeshResidency::tile(const MeshDraw& draw) const {
    return tiles_.at(key_of(scene::shown_detail(draw.mesh->material))).resident;
}

} // namespace reljef::render
