#include "engine/session/objects/building_meshes.h"

#include <cmath>
#include <cstdint>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/check.h"
#include "engine/scene/graph/picture_detail.h"

namespace reljef::session {
namespace {

constexpr int colors_in_row = 64;

std::uint32_t packed(Rgba8 color) {
    return (static_cast<std::uint32_t>(color.r) << 16U) |
           (static_cast<std::uint32_t>(color.g) << 8U) | color.b;
}

template <class Point> Point mean_of(const std::vector<Point>& points) {
    const Point sum = std::accumulate(points.begin(), points.end(), Point(0.0));
    return sum / static_cast<double>(points.size());
}

// Newell's method (Sutherland, Sproull & Schumacker 1974): also of faces that are nearly flat.
glm::dvec3 normal_of(const std::vector<glm::dvec3>& corners) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        sum += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    }
    const double length = glm::length(sum);
    return length > 0.0 ? sum / length : glm::dvec3(0.0, 0.0, 1.0);
}

// Around the middle if there are more than four corners, so that no triangle is turned over.
void append_fan(scene::Mesh& mesh, std::uint32_t first, std::uint32_t corners) {
    const bool has_middle = corners > 4;
    const std::uint32_t hub = has_middle ? first + corners : first;
    const std::uint32_t begin = has_middle ? 0 : 1;
    const std::uint32_t end = has_middle ? corners : corners - 1;
    for (std::uint32_t i = begin; i < end; ++i) {
        mesh.indices.insert(mesh.indices.end(), {hub, first + i, first + (i + 1) % corners});
    }
}

int rows_of(std::size_t colors) {
    return (static_cast<int>(colors) + colors_in_row - 1) / colors_in_row;
}

Image picture_of(const std::vector<Rgba8>& colors) {
    const int rows = rows_of(colors.size());
    Image picture(colors_in_row, rows, Rgba8{});
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const int at = static_cast<int>(i);
        const int row = at / colors_in_row;
        picture(at % colors_in_row, row) = colors[i];
    }
    return picture;
}

// The middle of the texel of each vertex's colour.
void set_texels(scene::Mesh& mesh, std::size_t colors) {
    const int rows = rows_of(colors);
    for (glm::vec2& coordinate : mesh.texture_coordinates) {
        const int index = static_cast<int>(coordinate.x);
        const int row = index / colors_in_row;
        const glm::ivec2 texel(index % colors_in_row, row);
        coordinate = (glm::vec2(texel) + 0.5F) / glm::vec2(colors_in_row, rows);
    }
}

scene::MeshNode node_of(scene::Mesh mesh,
                        const std::shared_ptr<const material::ReliefMaterial>& picture) {
    scene::MeshNode node{std::make_shared<const scene::Mesh>(std::move(mesh)), {}};
    node.material.technique = scene::make_technique(scene::TechniqueId::texture);
    node.material.detail.set = picture;
    return node;
}

void add_part(scene::Node& square, const char* name, scene::MeshNode part,
              const scene::MeshLevels& levels) {
    if (part.mesh->indices.empty()) {
        return;
    }
    if (!levels.empty()) {
        part.levels = std::make_shared<const scene::MeshLevels>(levels);
    }
    square.add(name, std::move(part));
}

} // namespace

Image facade_picture() {
    constexpr int side = 64;
    const Rgba8 plaster{206, 198, 184};
    const Rgba8 ledge{188, 180, 167};
    const Rgba8 frame{228, 225, 219};
    const Rgba8 glass{74, 88, 101};
    Image picture(side, side, plaster);
    const auto fill = [&](glm::ivec2 low, glm::ivec2 high, Rgba8 color) {
        for (int y = low.y; y < high.y; ++y) {
            for (int x = low.x; x < high.x; ++x) {
                picture(x, y) = color;
            }
        }
    };
    fill({0, 0}, {side, 3}, ledge); // between storeys
    fill({19, 14}, {45, 48}, frame);
    fill({21, 16}, {31, 46}, glass);
    fill({33, 16}, {43, 46}, glass);
    fill({17, 48}, {47, 51}, ledge);
    return picture;
}

std::uint32_t BuildingMeshes::index_of(glm::vec3 color) {
    const Rgba8 encoded = rgba8_from_linear(color);
    const auto next = static_cast<std::uint32_t>(colors_.size());
    const auto [found, is_new] = index_by_color_.emplace(packed(encoded), next);
    if (is_new) {
        colors_.push_back(encoded);
    }
    return found->second;
}

void BuildingMeshes::add(const building::Face& face, std::uint32_t color,
                         const glm::dmat4& square_from_building, Square& square) {
    const bool is_facade = !face.facade.empty();
    scene::Mesh& mesh = is_facade ? square.walls : square.others;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto count = static_cast<std::uint32_t>(face.corners.size());
    const auto place = [&](glm::dvec3 point) {
        return glm::vec3(glm::dvec3(square_from_building * glm::dvec4(point, 1.0)));
    };
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
        mesh.positions.push_back(place(face.corners[i]));
        mesh.texture_coordinates.push_back(is_facade ? glm::vec2(face.facade[i])
                                                     : glm::vec2(static_cast<float>(color), 0.0F));
    }
    if (count > 4) {
        mesh.positions.push_back(place(mean_of(face.corners)));
        const glm::vec2 at = mesh.texture_coordinates.back();
        mesh.texture_coordinates.push_back(is_facade ? glm::vec2(mean_of(face.facade)) : at);
    }
    const glm::vec3 normal(glm::dmat3(square_from_building) * normal_of(face.corners));
    mesh.normals.resize(mesh.positions.size(), normal);
    const std::size_t before = mesh.indices.size();
    append_fan(mesh, first, count);
    triangles_ += (mesh.indices.size() - before) / 3;
}

void BuildingMeshes::add(const building::PaintedFaces& building,
                         const glm::dmat4& world_from_scene) {
    const glm::dmat4 world_from_building = glm::translate(world_from_scene, building.origin);
    const glm::dvec3 at(world_from_building[3]);
    const glm::dvec2 cell = glm::floor(glm::dvec2(at) / building_square);
    constexpr int farthest = 1'000'000'000;
    const std::pair key(clamped_int(cell.x, -farthest, farthest),
                        clamped_int(cell.y, -farthest, farthest));
    Square& square = squares_.try_emplace(key, Square{at, {}, {}, {}}).first->second;
    const glm::dmat4 square_from_building =
        glm::translate(glm::dmat4(1.0), -square.origin) * world_from_building;
    const std::uint32_t color = index_of(building.color);
    for (const building::Face& face : building.faces) {
        reljef::check(face.corners.size() >= 3, "a face has three corners");
        add(face, color, square_from_building, square);
    }
    square.ends.push_back({square.walls.indices.size(), square.others.indices.size()});
}

Result<void> BuildingMeshes::add_to(scene::Node& parent, bool with_levels) const {
    if (squares_.empty()) {
        return {};
    }
    const auto facade = scene::picture_material(facade_picture(), "façade");
    const auto colors = scene::picture_material(picture_of(colors_), "colours of roofs");
    if (!facade || !colors) {
        return facade ? colors.error() : facade.error();
    }
    for (const auto& [key, square] : squares_) {
        scene::Node& node = parent.add("square");
        node.set_position(square.origin);
        scene::Mesh others = square.others;
        set_texels(others, colors_.size());
        const BuildingLevels levels =
            with_levels ? building_levels(square.walls, others, square.ends) : BuildingLevels();
        add_part(node, "walls", node_of(square.walls, *facade), levels.walls);
        add_part(node, "roofs", node_of(std::move(others), *colors), levels.others);
    }
    return {};
}

} // namespace reljef::session
