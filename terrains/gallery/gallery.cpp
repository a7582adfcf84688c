#include "terrains/gallery/gallery.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/material/noise.h"

namespace reljef::terrains {
namespace {

constexpr double floor_width = 40.0; // metres
constexpr int color_side = 1024;     // texels of the floor's image

constexpr float through_the_middle = -0.5F;

// Shape, name, textures, center, heading, size, repeats, technique, offset.
constexpr std::array models{
    GalleryModel{GalleryShape::plane, "plane", "brick", glm::dvec3(0.0, 3.4, 2.25), 0.0,
                 glm::vec3(12.0F, 4.5F, 0.0F), glm::vec2(8.0F, 3.0F), "relief"},
    GalleryModel{GalleryShape::box, "box", "rock", glm::dvec3(-3.35, 0.3, 1.0), 24.0,
                 glm::vec3(2.0F, 2.0F, 2.0F), glm::vec2(2.0F, 2.0F), "relief", through_the_middle},
    GalleryModel{GalleryShape::sphere, "sphere", "cobble", glm::dvec3(-0.25, 0.7, 1.3), 0.0,
                 glm::vec3(1.3F, 0.0F, 0.0F), glm::vec2(4.0F, 2.0F), "relief"},
    GalleryModel{GalleryShape::torus, "torus", "rock", glm::dvec3(1.15, -2.1, 0.46), 0.0,
                 glm::vec3(0.98F, 0.46F, 0.0F), glm::vec2(4.0F, 2.0F), "relief"},
    GalleryModel{GalleryShape::cylinder, "cylinder", "brick", glm::dvec3(3.4, 0.6, 1.5), 0.0,
                 glm::vec3(0.95F, 3.0F, 0.0F), glm::vec2(4.0F, 2.0F), "relief"},
    GalleryModel{GalleryShape::sheet, "fence", "fence", glm::dvec3(-3.55, -2.0, 0.75), 22.0,
                 glm::vec3(3.0F, 1.5F, 0.0F), glm::vec2(4.0F, 2.0F), "lattice", through_the_middle},
    GalleryModel{GalleryShape::sheet, "curtain", "rings", glm::dvec3(3.7, -1.8, 1.3), 30.0,
                 glm::vec3(2.4F, 2.4F, 0.0F), glm::vec2(2.0F, 2.0F), "multi-layer:n=64",
                 through_the_middle},
    GalleryModel{GalleryShape::bowl, "shell", "copper", glm::dvec3(-1.35, -2.75, 0.8), 0.0,
                 glm::vec3(0.8F, 0.0F, 0.0F), glm::vec2(6.0F, 1.5F), "relief:sides=two",
                 through_the_middle}};

// Metres from a place on the floor to the model's footprint; 0 inside it.
double distance_to_foot(const GalleryModel& model, glm::dvec2 place) {
    const double turn = glm::radians(model.heading);
    const glm::dvec2 off = place - glm::dvec2(model.center);
    const glm::dvec2 own(off.x * std::cos(turn) - off.y * std::sin(turn),
                         off.x * std::sin(turn) + off.y * std::cos(turn));
    const double far = glm::length(own);
    switch (model.shape) {
    case GalleryShape::plane:
    case GalleryShape::box: {
        const double depth = model.shape == GalleryShape::box ? 0.5 * model.size.y : 0.0;
        return glm::length(
            glm::max(glm::abs(own) - glm::dvec2(0.5 * model.size.x, depth), glm::dvec2(0.0)));
    }
    case GalleryShape::torus:
        return std::abs(far - model.size.x);
    case GalleryShape::sphere:
    case GalleryShape::bowl:
        return far;
    default:
        return std::max(far - model.size.x, 0.0);
    }
}

// Share of the sky that is visible from a place on the floor, in (0,1].
double sky_seen(glm::dvec2 place) {
    double seen = 1.0;
    for (const GalleryModel& model : models) {
        if (model.shape == GalleryShape::sheet) {
            continue; // it has holes
        }
        const double reach = 0.45 * std::max(model.center.z, 0.5);
        const double away = distance_to_foot(model, place) / reach;
        seen *= 1.0 - 0.62 * std::exp(-away * away);
    }
    return seen;
}

glm::vec3 floor_albedo(glm::vec2 place, std::uint32_t seed) {
    constexpr float slab = 1.6F;
    const glm::vec2 at = place / slab;
    const glm::ivec2 id(glm::floor(at));
    const glm::vec2 to_joint = 0.5F - glm::abs(glm::fract(at) - 0.5F);
    const float joint = glm::smoothstep(0.005F, 0.022F, std::min(to_joint.x, to_joint.y));
    const float tone = 0.92F + 0.16F * material::unit_hash(seed, id.x, id.y);
    const float grain = material::fractal_noise(seed + 1, 3.0F * place, {5, 0.6F, 0});
    const glm::vec3 stone = glm::vec3(0.335F, 0.315F, 0.285F) * tone * (1.0F + 0.14F * grain);
    return stone * glm::mix(0.62F, 1.0F, joint);
}

} // namespace

std::span<const GalleryModel> gallery_models() {
    return models;
}

Result<terrain::Terrain> generate_gallery(const GeneratorOptions& options) {
    if (options.size < 16 || options.size > 4096) {
        return Error{fmt::format("gallery: the size is {}, expected 16 to 4096", options.size)};
    }
    if (options.spacing != 0.0 || options.tileable) {
        return Error{fmt::format("gallery: {} was given, which its floor has no use for",
                                 options.tileable ? "tileable" : "a spacing")};
    }
    const double spacing = floor_width / (options.size - 1.0);
    terrain::Terrain terrain;
    terrain.name = "gallery";
    terrain.heightfield.heights = Grid<float>(options.size, options.size, 0.0F);
    terrain.heightfield.spacing = {spacing, spacing};
    terrain.color = Image(color_side, color_side);
    const ParallelOptions parallel{options.threads, options.stop, options.progress};
    const bool is_done = for_each_cell(color_side, color_side, parallel, [&](int col, int row) {
        const glm::dvec2 share = glm::dvec2(col, row) / (color_side - 1.0) - 0.5;
        const glm::dvec2 place(share.x * floor_width, -share.y * floor_width);
        terrain.color(col, row) = rgba8_from_linear(floor_albedo(glm::vec2(place), options.seed) *
                                                    static_cast<float>(sky_seen(place)));
    });
    return is_done ? Result<terrain::Terrain>(std::move(terrain))
                   : Error{"gallery: generating was stopped"};
}

} // namespace reljef::terrains
