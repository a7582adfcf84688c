#include "engine/session/objects/building_levels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/building/building_faces.h"
#include "engine/scene/levels/mesh_distance.h"

namespace reljef::session {
namespace {

const glm::vec2 of_wall(-1.0F); // as texture coordinate; other faces have the place of their colour

// Appends triangles of a mesh. `coordinate`: of all; null: their own.
void append_triangles(scene::Mesh& to, const scene::Mesh& from,
                      std::span<const std::uint32_t> indices, const glm::vec2* coordinate) {
    for (const std::uint32_t index : indices) {
        to.indices.push_back(static_cast<std::uint32_t>(to.positions.size()));
        to.positions.push_back(from.positions[index]);
        to.normals.push_back(from.normals[index]);
        to.texture_coordinates.push_back(coordinate != nullptr ? *coordinate
                                                               : from.texture_coordinates[index]);
    }
}

std::span<const std::uint32_t> part_of(const std::vector<std::uint32_t>& indices, std::size_t begin,
                                       std::size_t end) {
    return std::span(indices).subspan(begin, end - begin);
}

std::size_t triangle_count(const scene::Mesh& mesh) {
    return mesh.indices.size() / 3;
}

// Windows to the right and down on an upright plane.
glm::vec2 on_facade(glm::vec3 position, glm::vec3 normal) {
    const glm::vec2 along(-normal.y, normal.x);
    const float length = glm::length(along);
    const float right = length > 0.0F ? glm::dot(along / length, glm::vec2(position)) : position.x;
    return {right / static_cast<float>(building::window_bay),
            -position.z / static_cast<float>(building::window_storey)};
}

struct Square {
    scene::Mesh walls;
    scene::Mesh others;

    [[nodiscard]] std::size_t triangles() const {
        return triangle_count(walls) + triangle_count(others);
    }
    // As one mesh, for distances.
    [[nodiscard]] scene::Mesh whole() const {
        scene::Mesh mesh;
        append_triangles(mesh, walls, walls.indices, &of_wall);
        append_triangles(mesh, others, others.indices, nullptr);
        return mesh;
    }
};

// Places of a building that become one. A place moves by the tolerance at most, so each point of a
// triangle does, too.
class JoinedPlaces {
public:
    JoinedPlaces(const scene::Mesh& building, double tolerance) : tolerance_(tolerance) {
        std::map<std::array<float, 3>, std::uint32_t> known;
        for (const glm::vec3 position : building.positions) {
            const std::array<float, 3> key{position.x, position.y, position.z};
            const auto next = static_cast<std::uint32_t>(places_.size());
            const auto [found, is_new] = known.emplace(key, next);
            if (is_new) {
                places_.emplace_back(position);
                members_.push_back({next});
                joined_.push_back(next);
            }
            place_of_.push_back(found->second);
        }
        join_edges(building);
    }

    // Of a vertex: its place after the joining.
    [[nodiscard]] std::uint32_t of(std::uint32_t vertex) const {
        return joined_[place_of_[vertex]];
    }
    [[nodiscard]] glm::vec3 position(std::uint32_t place) const {
        return glm::vec3(places_[place]);
    }

private:
    void join_edges(const scene::Mesh& building) {
        std::vector<std::tuple<double, std::uint32_t, std::uint32_t>> edges;
        for (std::size_t i = 0; i < building.indices.size(); ++i) {
            const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
            const std::uint32_t a = place_of_[building.indices[i]];
            const std::uint32_t b = place_of_[building.indices[next]];
            const double length = glm::distance(places_[a], places_[b]);
            if (a < b && length <= tolerance_) {
                edges.emplace_back(length, a, b);
            }
        }
        std::sort(edges.begin(), edges.end());
        for (const auto& [length, a, b] : edges) {
            join(joined_[a], joined_[b]);
        }
    }

    // The farthest that places of one group are from a place.
    [[nodiscard]] double farthest(std::uint32_t group, std::uint32_t from) const {
        double largest = 0.0;
        for (const std::uint32_t member : members_[group]) {
            largest = std::max(largest, glm::distance(places_[member], places_[from]));
        }
        return largest;
    }

    void join(std::uint32_t a, std::uint32_t b) {
        const double to_a = farthest(b, a);
        const double to_b = farthest(a, b);
        if (a == b || std::min(to_a, to_b) > tolerance_) {
            return;
        }
        const std::uint32_t kept = to_a <= to_b ? a : b;
        const std::uint32_t gone = kept == a ? b : a;
        for (const std::uint32_t member : members_[gone]) {
            joined_[member] = kept;
            members_[kept].push_back(member);
        }
        members_[gone].clear();
    }

    double tolerance_;
    std::vector<std::uint32_t> place_of_; // of each vertex
    std::vector<glm::dvec3> places_;
    std::vector<std::uint32_t> joined_;               // of each place: the one that is kept
    std::vector<std::vector<std::uint32_t>> members_; // of each kept place
};

// Triangles keep their colours and normals. Those that become lines are gone.
void append_joined(const scene::Mesh& building, const JoinedPlaces& places, Square& square) {
    for (std::size_t i = 0; i < building.indices.size(); i += 3) {
        const std::array<std::uint32_t, 3> corners{places.of(building.indices[i]),
                                                   places.of(building.indices[i + 1]),
                                                   places.of(building.indices[i + 2])};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
            continue;
        }
        const glm::vec2 coordinate = building.texture_coordinates[building.indices[i]];
        const bool is_wall = coordinate == of_wall;
        const std::array<glm::vec3, 3> positions{
            places.position(corners[0]), places.position(corners[1]), places.position(corners[2])};
        const glm::vec3 normal =
            glm::cross(positions[1] - positions[0], positions[2] - positions[0]);
        scene::Mesh& mesh = is_wall ? square.walls : square.others;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const glm::vec3 position = positions.at(corner);
            mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(position);
            mesh.normals.push_back(building.normals[building.indices[i + corner]]);
            mesh.texture_coordinates.push_back(is_wall ? on_facade(position, normal) : coordinate);
        }
    }
}

// The buildings of a square, each as one mesh.
std::vector<scene::Mesh> buildings_of(const scene::Mesh& walls, const scene::Mesh& others,
                                      std::span<const BuildingEnd> ends) {
    std::vector<scene::Mesh> buildings;
    BuildingEnd begin;
    for (const BuildingEnd& end : ends) {
        scene::Mesh building;
        append_triangles(building, walls, part_of(walls.indices, begin.walls, end.walls), &of_wall);
        append_triangles(building, others, part_of(others.indices, begin.others, end.others),
                         nullptr);
        buildings.push_back(std::move(building));
        begin = end;
    }
    return buildings;
}

// Whether nothing of a building is farther from a simpler one than the tolerance: poles vanish as
// lines.
bool is_near(const scene::Mesh& building, const scene::Mesh& simpler, double tolerance) {
    constexpr double rounded_up = 1.125; // as max_distance()
    constexpr double enough = 0.125;     // of the tolerance
    return !simpler.indices.empty() &&
           *scene::max_distance(building, scene::MeshTree(simpler), enough * tolerance,
                                {1U, {}, {}}) <= rounded_up * tolerance;
}

Square simplified(const std::vector<scene::Mesh>& buildings, double tolerance) {
    Square square;
    for (const scene::Mesh& building : buildings) {
        if (glm::length(scene::bounds_of(building).size()) <= tolerance) {
            continue;
        }
        Square one;
        append_joined(building, JoinedPlaces(building, tolerance), one);
        const bool is_good = is_near(building, one.whole(), tolerance);
        append_joined(building, JoinedPlaces(building, is_good ? tolerance : 0.0), square);
    }
    return square;
}

} // namespace

BuildingLevels building_levels(const scene::Mesh& walls, const scene::Mesh& others,
                               std::span<const BuildingEnd> buildings) {
    BuildingLevels levels;
    const std::vector<scene::Mesh> apart = buildings_of(walls, others, buildings);
    const Square all{walls, others};
    const scene::Mesh whole = all.whole();
    const Box bounds = scene::bounds_of(whole);
    std::size_t last = all.triangles();
    double error = 0.0;
    for (const double tolerance : building_tolerances) {
        Square square = simplified(apart, tolerance);
        if (square.walls.indices.empty() || square.others.indices.empty() ||
            8 * square.triangles() > 7 * last) {
            continue;
        }
        last = square.triangles();
        const scene::Mesh coarse = square.whole();
        error = std::max({error, tolerance, *scene::max_distance_between(whole, coarse)});
        // Proven together, chosen together: roofs wait for the windows.
        const auto level = [&](scene::Mesh mesh) {
            return scene::MeshLevel{std::make_shared<const scene::Mesh>(std::move(mesh)), error,
                                    0.0, std::max(building::window_bay, building::window_storey),
                                    bounds};
        };
        levels.walls.push_back(level(std::move(square.walls)));
        levels.others.push_back(level(std::move(square.others)));
    }
    return levels;
}

} // namespace reljef::session
