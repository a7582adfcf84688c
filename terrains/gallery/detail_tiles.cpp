#include "terrains/gallery/detail_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/parallel_for.h"
#include "engine/material/noise.h"

namespace reljef::terrains {
namespace {

constexpr int min_side = 16;
constexpr int max_side = 4096;

// Surface at a point of the texture.
struct SurfacePoint {
    float height = 0.0F;    // any range
    glm::vec3 albedo{0.5F}; // linear
};

float noise(std::uint32_t seed, glm::vec2 place, int cells, int octaves = 4) {
    return material::fractal_noise(seed, place * static_cast<float>(cells), {octaves, 0.5F, cells});
}

glm::vec3 chosen(std::span<const glm::vec3> palette, float random) {
    const float at = random * static_cast<float>(palette.size());
    const auto index = std::min(static_cast<std::size_t>(at), palette.size() - 1);
    return glm::mix(palette[index], palette[(index + 1) % palette.size()],
                    at - static_cast<float>(index));
}

// Signed distance to a rectangle with round corners, negative inside.
float to_round_box(glm::vec2 place, glm::vec2 half, float radius) {
    const glm::vec2 beyond = glm::abs(place) - half + radius;
    return glm::length(glm::max(beyond, 0.0F)) + std::min(std::max(beyond.x, beyond.y), 0.0F) -
           radius;
}

struct Brick {
    glm::ivec2 id{0};
    glm::vec2 place{0.0F}; // from its middle, in [-½, ½] of its own sides
    glm::vec2 sides{0.0F}; // in texture widths
};

// Stretcher bond: each course is shifted by half a brick.
Brick brick_at(glm::vec2 place) {
    constexpr int bricks = 4;
    constexpr int courses = 8;
    const int course = static_cast<int>(place.y * courses) % courses;
    const float along = place.x * bricks + (course % 2 == 0 ? 0.0F : 0.5F);
    return {{static_cast<int>(along) % bricks, course},
            glm::fract(glm::vec2(along, place.y * courses)) - 0.5F,
            {1.0F / bricks, 1.0F / courses}};
}

SurfacePoint brick_wall(glm::vec2 place, std::uint32_t seed) {
    constexpr std::array<glm::vec3, 4> clays{
        glm::vec3(0.33F, 0.095F, 0.055F), glm::vec3(0.40F, 0.145F, 0.080F),
        glm::vec3(0.20F, 0.070F, 0.050F), glm::vec3(0.46F, 0.205F, 0.120F)};
    constexpr glm::vec3 lime(0.44F, 0.40F, 0.34F);
    constexpr float joint = 0.0075F; // half its width, in texture widths
    const Brick brick = brick_at(place);
    const float random = material::unit_hash(seed, brick.id.x, brick.id.y);
    const glm::vec2 tilt(material::unit_hash(seed + 1, brick.id.x, brick.id.y) - 0.5F,
                         material::unit_hash(seed + 2, brick.id.x, brick.id.y) - 0.5F);
    const float worn = 0.0035F * noise(seed + 3, place, 24, 3);
    const float outside =
        to_round_box(brick.place * brick.sides, 0.5F * brick.sides - joint, 0.011F) + worn;
    const float face = glm::smoothstep(0.004F, -0.007F, outside);
    const float grain = noise(seed + 4, place, 64, 4);
    const float rough = noise(seed + 5, place, 16, 5);
    const float pits = glm::smoothstep(0.35F, 0.75F, noise(seed + 6, place, 48, 2));
    const float top = 0.80F + 0.14F * (random - 0.5F) + 0.12F * glm::dot(tilt, brick.place) +
                      0.06F * rough + 0.02F * grain - 0.16F * pits;
    const float mortar = 0.26F + 0.10F * rough + 0.06F * grain;
    const glm::vec3 clay = chosen(clays, material::unit_hash(seed + 7, brick.id.x, brick.id.y)) *
                           (1.0F + 0.35F * rough + 0.25F * grain - 0.35F * pits);
    return {glm::mix(mortar, top, face),
            glm::mix(lime * (1.0F + 0.25F * rough + 0.2F * grain), clay, face)};
}

SurfacePoint cobbles(glm::vec2 place, std::uint32_t seed) {
    constexpr std::array<glm::vec3, 5> stones{
        glm::vec3(0.26F, 0.26F, 0.27F), glm::vec3(0.34F, 0.31F, 0.27F),
        glm::vec3(0.19F, 0.20F, 0.22F), glm::vec3(0.38F, 0.36F, 0.33F),
        glm::vec3(0.28F, 0.23F, 0.19F)};
    constexpr int cells = 7;
    const glm::vec2 wobble(noise(seed + 1, place, 14, 2), noise(seed + 2, place, 14, 2));
    const material::VoronoiCell cell =
        material::voronoi(seed, place * static_cast<float>(cells) + 0.10F * wobble, cells, 0.62F);
    const float random = material::unit_hash(seed + 3, cell.id.x, cell.id.y);
    const float grain = noise(seed + 4, place, 64, 4);
    const float rough = noise(seed + 5, place, 20, 4);
    const float inside = glm::clamp((cell.to_edge - 0.055F) / 0.30F, 0.0F, 1.0F);
    const float dome = std::sqrt(1.0F - (1.0F - inside) * (1.0F - inside));
    const float stone = 0.22F + (0.58F + 0.18F * random) * dome + 0.05F * rough + 0.015F * grain;
    const float sand = 0.24F + 0.05F * noise(seed + 6, place, 12, 5) + 0.02F * grain;
    const float moss = glm::smoothstep(0.0F, 0.5F, noise(seed + 7, place, 5, 4));
    const glm::vec3 ground =
        glm::mix(glm::vec3(0.20F, 0.16F, 0.11F), glm::vec3(0.09F, 0.12F, 0.04F), moss) *
        (1.0F + 0.4F * grain);
    const glm::vec3 rock = chosen(stones, material::unit_hash(seed + 8, cell.id.x, cell.id.y)) *
                           (1.0F + 0.30F * rough + 0.30F * grain);
    return {std::max(stone * glm::smoothstep(0.0F, 0.02F, inside), sand),
            glm::mix(ground, rock,
                     glm::smoothstep(-0.02F, 0.05F, stone - sand) *
                         glm::smoothstep(0.0F, 0.05F, inside))};
}

// Broken slabs that lean in random directions.
float slabs(glm::vec2 place, std::uint32_t seed, int cells) {
    const glm::vec2 wobble(noise(seed + 1, place, 2 * cells, 3),
                           noise(seed + 2, place, 2 * cells, 3));
    const material::VoronoiCell cell =
        material::voronoi(seed, place * static_cast<float>(cells) + 0.35F * wobble, cells, 0.9F);
    const glm::vec2 lean(material::unit_hash(seed + 3, cell.id.x, cell.id.y) - 0.5F,
                         material::unit_hash(seed + 4, cell.id.x, cell.id.y) - 0.5F);
    const float crack = glm::smoothstep(0.07F, 0.0F, cell.to_edge);
    return 0.55F * material::unit_hash(seed + 5, cell.id.x, cell.id.y) +
           0.9F * glm::dot(lean, cell.from_seed) - 0.35F * crack;
}

SurfacePoint rock_face(glm::vec2 place, std::uint32_t seed) {
    const glm::vec2 wobble(noise(seed + 20, place, 4, 4), noise(seed + 21, place, 4, 4));
    const glm::vec2 bent = glm::fract(place + 0.03F * wobble);
    const float ridges = 1.0F - std::abs(noise(seed + 22, bent, 6, 5));
    const float grain = noise(seed + 23, place, 72, 4);
    const float height = 0.55F * slabs(bent, seed, 5) + 0.22F * slabs(bent, seed + 40, 13) +
                         0.30F * ridges + 0.035F * grain;
    const float layers =
        noise(seed + 24, glm::fract(glm::vec2(place.x + 0.05F * wobble.x, place.y)), 8, 4);
    const float lichen = glm::smoothstep(0.22F, 0.42F, noise(seed + 25, bent, 7, 5));
    const glm::vec3 stone =
        glm::mix(glm::vec3(0.235F, 0.205F, 0.175F), glm::vec3(0.37F, 0.335F, 0.29F),
                 glm::clamp(0.5F + layers, 0.0F, 1.0F));
    const glm::vec3 grown = glm::mix(stone, glm::vec3(0.30F, 0.31F, 0.20F), 0.6F * lichen);
    return {height, grown * (0.75F + 0.35F * height + 0.35F * grain)};
}

// Crossing round wires; a height of 1 is their radius.
SurfacePoint wire_fence(glm::vec2 place, std::uint32_t seed) {
    constexpr int wires = 3;
    constexpr float radius = 0.13F; // share of the distance between wires
    float height = 0.0F;
    for (const float along : {place.x + place.y, place.x - place.y}) {
        const float off = std::abs(glm::fract(along * wires) - 0.5F) / radius;
        height = std::max(height, std::sqrt(std::max(1.0F - off * off, 0.0F)));
    }
    const float rough = noise(seed, place, 24, 5);
    const float rust = glm::smoothstep(0.05F, 0.45F, noise(seed + 1, place, 5, 5));
    const glm::vec3 zinc = glm::vec3(0.40F, 0.42F, 0.44F) * (1.0F + 0.3F * rough);
    const glm::vec3 brown = glm::vec3(0.30F, 0.14F, 0.06F) * (1.0F + 0.5F * rough);
    return {height, glm::mix(zinc, brown, 0.75F * rust)};
}

SurfacePoint hammered_copper(glm::vec2 place, std::uint32_t seed) {
    constexpr int dents = 9;
    const material::VoronoiCell cell =
        material::voronoi(seed, place * static_cast<float>(dents), dents, 0.75F);
    const float random = material::unit_hash(seed + 1, cell.id.x, cell.id.y);
    const float off = glm::length(cell.from_seed);
    const float ridge = glm::smoothstep(0.16F, 0.0F, cell.to_edge);
    const float grain = noise(seed + 2, place, 64, 4);
    const float dish = 0.9F * std::min(off * off, 0.6F) + 0.10F * ridge;
    const float stain = glm::smoothstep(0.10F, 0.55F, noise(seed + 3, place, 6, 5));
    const glm::vec3 copper = glm::vec3(0.58F, 0.27F, 0.16F) * (0.9F + 0.2F * random + 0.1F * grain);
    const glm::vec3 green = glm::vec3(0.20F, 0.36F, 0.28F) * (1.0F + 0.3F * grain);
    return {dish + 0.12F * random + 0.006F * grain, glm::mix(copper, green, 0.55F * stain)};
}

// Material of the rings. hang_rings() makes their shape.
SurfacePoint brass(glm::vec2 place, std::uint32_t seed) {
    const float rough = noise(seed, place, 48, 4);
    const float dull = glm::smoothstep(0.0F, 0.5F, noise(seed + 1, place, 6, 4));
    return {0.0F, glm::mix(glm::vec3(0.56F, 0.40F, 0.15F), glm::vec3(0.34F, 0.25F, 0.13F), dull) *
                      (1.0F + 0.18F * rough)};
}

// A curtain of rings. Rings of one row lean along +x, those of the next along -x. Each ring passes
// through its four neighbours, and at most two rings cover a point. With these lengths, in ring
// radii, no two rings touch.
constexpr int ring_rows = 3; // along each side, for each lean
constexpr double ring_wire = 0.11;
constexpr double ring_distance = 1.14; // to the next ring of the other lean, along x and y
constexpr double ring_lean = 0.42;     // rise over run along x
constexpr double ring_room = 0.02;     // above and below the rings, share of the height range
constexpr int ring_vertices = 96;
constexpr int wire_vertices = 20;
constexpr double ring_radius = 1.0 / (2.0 * ring_distance * ring_rows); // in texture widths
// Half the height range.
constexpr double ring_range = (ring_lean + ring_wire) / (1.0 - 2.0 * ring_room);

struct RingMesh {
    std::vector<glm::vec3> positions; // x, y in texture widths; z in [0,1]
    std::vector<std::uint32_t> indices;
};

// A point of the wire, in ring radii.
glm::dvec3 ring_point(int along, int across, double lean) {
    const double turn = 2.0 * std::acos(-1.0);
    const double angle = turn * along / ring_vertices;
    const glm::dvec3 middle(std::cos(angle), std::sin(angle), lean * std::cos(angle));
    const glm::dvec3 out = glm::normalize(middle);
    const glm::dvec3 off = glm::normalize(glm::dvec3(-lean, 0.0, 1.0));
    const double wire_angle = turn * across / wire_vertices;
    return middle + ring_wire * (std::cos(wire_angle) * out + std::sin(wire_angle) * off);
}

void add_ring(glm::dvec2 center, double lean, RingMesh& mesh) {
    constexpr glm::dvec3 scale(ring_radius, ring_radius, 0.5 / ring_range);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto vertex = [&](int along, int across) {
        return first + static_cast<std::uint32_t>((along % ring_vertices) * wire_vertices +
                                                  across % wire_vertices);
    };
    for (int along = 0; along < ring_vertices; ++along) {
        for (int across = 0; across < wire_vertices; ++across) {
            mesh.positions.emplace_back(glm::dvec3(center, 0.5) +
                                        ring_point(along, across, lean) * scale);
            mesh.indices.insert(mesh.indices.end(),
                                {vertex(along, across), vertex(along, across + 1),
                                 vertex(along + 1, across), vertex(along + 1, across),
                                 vertex(along, across + 1), vertex(along + 1, across + 1)});
        }
    }
}

void hang_rings(material::ReliefMaterial& set) {
    // Off the texels' centres, so that no vertical ray meets an edge.
    constexpr double off = 1.0 / 7919.0;
    RingMesh mesh;
    for (int row = 0; row < ring_rows; ++row) {
        for (int col = 0; col < ring_rows; ++col) {
            const glm::dvec2 middle = (glm::dvec2(col, row) + 0.25 + off) / glm::dvec2(ring_rows);
            add_ring(middle, ring_lean, mesh);
            add_ring(middle + 0.5 / ring_rows, -ring_lean, mesh);
        }
    }
    const int size = set.heights.cols();
    set.layers =
        material::layers_of_mesh({mesh.positions, mesh.indices}, size, size).value().layers;
    set.heights = material::top_heights(*set.layers);
}

void add_ribs(material::ReliefMaterial& set) {
    constexpr float ribs = 12.0F;
    const float turn = 2.0F * std::acos(-1.0F);
    set.back_heights = Grid<float>(set.heights.cols(), set.heights.rows());
    for (int row = 0; row < set.back_heights.rows(); ++row) {
        const float place =
            (static_cast<float>(row) + 0.5F) / static_cast<float>(set.heights.rows());
        const float rib = 0.5F + 0.5F * std::sin(turn * ribs * place);
        std::fill(set.back_heights.row(row).begin(), set.back_heights.row(row).end(),
                  0.3F + 0.7F * rib);
    }
}

void spread_over_unit(Grid<float>& heights) {
    const auto [low, high] =
        std::minmax_element(heights.samples().begin(), heights.samples().end());
    const float lowest = *low;
    const float range = *high - lowest;
    for (float& height : heights.samples()) {
        height = range > 0.0F ? glm::clamp((height - lowest) / range, 0.0F, 1.0F) : 0.0F;
    }
}

// Mean rise of the neighbours at a distance in eight directions; lower neighbours count as level.
float hollow(const Grid<float>& heights, glm::ivec2 texel, int distance) {
    constexpr std::array<glm::ivec2, 8> directions{
        glm::ivec2(1, 0),  glm::ivec2(1, 1),   glm::ivec2(0, 1),  glm::ivec2(-1, 1),
        glm::ivec2(-1, 0), glm::ivec2(-1, -1), glm::ivec2(0, -1), glm::ivec2(1, -1)};
    const glm::ivec2 size(heights.cols(), heights.rows());
    float sum = 0.0F;
    for (const glm::ivec2 direction : directions) {
        const glm::ivec2 other = (texel + distance * direction + size) % size;
        sum += std::max(heights(other.x, other.y) - heights(texel.x, texel.y), 0.0F);
    }
    return 0.125F * sum;
}

float open_to_sky(const Grid<float>& heights, glm::ivec2 texel) {
    const int near = std::max(heights.cols() / 128, 1);
    const float hidden =
        0.6F * hollow(heights, texel, near) + 0.7F * hollow(heights, texel, 3 * near);
    return glm::clamp(1.0F - hidden, 0.25F, 1.0F);
}

struct Kind {
    std::string_view name;
    SurfacePoint (*surface)(glm::vec2 place, std::uint32_t seed); // place in [0,1)²
    float scale;
    float specular;
    float shininess;
    void (*add_sides)(material::ReliefMaterial& set) = nullptr; // adds layers or back heights
};

material::ReliefMaterial generate(const Kind& kind, const DetailOptions& options) {
    const int size = options.size;
    const ParallelOptions parallel{options.threads, {}, {}};
    Grid<glm::vec3> albedo(size, size);
    material::ReliefMaterial set;
    set.name = std::string(kind.name);
    set.scale = kind.scale;
    set.specular = kind.specular;
    set.shininess = kind.shininess;
    set.heights = Grid<float>(size, size);
    set.color = Image(size, size);
    for_each_cell(size, size, parallel, [&](int col, int row) {
        const glm::vec2 place = (glm::vec2(col, row) + 0.5F) / static_cast<float>(size);
        const SurfacePoint point = kind.surface(place, options.seed * 1009U);
        set.heights(col, row) = point.height;
        albedo(col, row) = point.albedo;
    });
    spread_over_unit(set.heights);
    for_each_cell(size, size, parallel, [&](int col, int row) {
        set.color(col, row) =
            rgba8_from_linear(albedo(col, row) * open_to_sky(set.heights, {col, row}));
    });
    if (kind.add_sides != nullptr) {
        kind.add_sides(set);
    }
    return set;
}

constexpr auto ring_scale = static_cast<float>(2.0 * ring_range * ring_radius);
constexpr std::array<Kind, 6> kinds{{{"brick", &brick_wall, 0.05F, 0.04F, 12.0F},
                                     {"rock", &rock_face, 0.10F, 0.06F, 16.0F},
                                     {"cobble", &cobbles, 0.08F, 0.16F, 40.0F},
                                     {"fence", &wire_fence, 0.0613F, 0.35F, 40.0F},
                                     {"rings", &brass, ring_scale, 0.45F, 50.0F, &hang_rings},
                                     {"copper", &hammered_copper, 0.06F, 0.40F, 36.0F, &add_ribs}}};
constexpr auto names = [] {
    std::array<std::string_view, kinds.size()> list;
    std::transform(kinds.begin(), kinds.end(), list.begin(),
                   [](const Kind& kind) { return kind.name; });
    return list;
}();

} // namespace

std::span<const std::string_view> detail_names() {
    return names;
}

Result<material::ReliefMaterial> generate_detail(std::string_view name,
                                                 const DetailOptions& options) {
    const auto* const kind = std::find_if(kinds.begin(), kinds.end(),
                                          [&](const Kind& entry) { return entry.name == name; });
    if (kind == kinds.end()) {
        return Error{fmt::format("texture set '{}' found, one of {} was expected", name,
                                 fmt::join(names, ", "))};
    }
    if (options.size < min_side || options.size > max_side) {
        return Error{fmt::format("texture set {}: a size of {} found, {} to {} was expected", name,
                                 options.size, min_side, max_side)};
    }
    return material::completed(generate(*kind, options), material::WrapMode::wrap);
}

} // namespace reljef::terrains
