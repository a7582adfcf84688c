#include <algorithm>
#include <array>

#include "terrains/urban/urban_city.h"

namespace reljef::terrains::urban {
namespace {

Color varied(Color color, Random& random, float amount) {
    const float light = 1.0F + amount * random.bell();
    const float warm = 1.0F + 0.25F * amount * random.bell();
    return {color.x * light * warm, color.y * light, color.z * light / warm};
}

Color tile_color(Random& random) {
    constexpr std::array palette{
        Color(0.53F, 0.34F, 0.27F), Color(0.57F, 0.37F, 0.29F), Color(0.49F, 0.32F, 0.27F),
        Color(0.60F, 0.43F, 0.34F), Color(0.45F, 0.35F, 0.30F), Color(0.41F, 0.34F, 0.31F),
        Color(0.44F, 0.43F, 0.42F), Color(0.37F, 0.38F, 0.40F), Color(0.51F, 0.38F, 0.32F)};
    return varied(random.pick(palette), random, 0.13F);
}

Color car_color(Random& random) {
    constexpr std::array palette{Color(0.86F, 0.86F, 0.85F), Color(0.80F, 0.80F, 0.80F),
                                 Color(0.62F, 0.64F, 0.66F), Color(0.45F, 0.46F, 0.48F),
                                 Color(0.22F, 0.22F, 0.24F), Color(0.15F, 0.15F, 0.17F),
                                 Color(0.27F, 0.33F, 0.45F), Color(0.50F, 0.21F, 0.19F),
                                 Color(0.52F, 0.49F, 0.43F), Color(0.70F, 0.71F, 0.72F)};
    return varied(random.pick(palette), random, 0.06F);
}

struct FlatRoof {
    Cover cover;
    Color color;
};

FlatRoof flat_roof(Random& random) {
    constexpr std::array<FlatRoof, 9> roofs{{{Cover::gravel, {0.56F, 0.54F, 0.50F}},
                                             {Cover::gravel, {0.50F, 0.48F, 0.45F}},
                                             {Cover::gravel, {0.62F, 0.59F, 0.54F}},
                                             {Cover::tar, {0.36F, 0.36F, 0.37F}},
                                             {Cover::tar, {0.43F, 0.42F, 0.42F}},
                                             {Cover::membrane, {0.72F, 0.72F, 0.71F}},
                                             {Cover::membrane, {0.62F, 0.63F, 0.64F}},
                                             {Cover::concrete, {0.58F, 0.55F, 0.50F}},
                                             {Cover::concrete, {0.52F, 0.51F, 0.50F}}}};
    if (random.chance(0.035F)) {
        return {Cover::green, {0.40F, 0.43F, 0.28F}};
    }
    FlatRoof roof = random.pick(roofs);
    roof.color = varied(roof.color, random, 0.11F);
    return roof;
}

} // namespace

void BlockBuilder::patch(const Convex& shape, Surface surface) {
    if (shape.empty()) {
        return;
    }
    block_.patches.push_back({Footprint(shape), frame_of(shape), surface, random.bits()});
    block_.bounds.add(block_.patches.back().shape.bounds);
}

void BlockBuilder::tree(glm::vec2 center, float size) {
    const float radius = size * random.range(1.7F, 4.1F);
    const Color base =
        random.chance(0.12F) ? Color{0.33F, 0.35F, 0.19F} : Color{0.24F, 0.31F, 0.17F};
    block_.trees.push_back(
        {center, radius, radius * random.range(1.7F, 2.5F) + 1.0F, varied(base, random, 0.26F)});
    block_.bounds.add(center, radius + 1.0F);
}

void BlockBuilder::grove(const Convex& shape, float spacing, float size) {
    if (shape.empty()) {
        return;
    }
    const Frame frame = frame_of(shape);
    const int count = static_cast<int>(4.0F * frame.half.x * frame.half.y / (spacing * spacing));
    for (int i = 0; i < count; ++i) {
        const glm::vec2 place = frame.at(frame.half.x * random.range(-1.0F, 1.0F),
                                         frame.half.y * random.range(-1.0F, 1.0F));
        if (inner_distance(shape, place) > 1.5F) {
            tree(place, size);
        }
    }
}

void BlockBuilder::box(const Frame& frame, float top, Color color, PrismKind kind) {
    block_.prisms.push_back({frame, top, kind, color});
    block_.bounds.add(frame.center, frame.half.x + frame.half.y);
}

void BlockBuilder::car(glm::vec2 center, glm::vec2 axis) {
    const bool van = random.chance(0.09F);
    const glm::vec2 half = van ? glm::vec2{2.8F, 1.05F}
                               : glm::vec2{random.range(2.0F, 2.35F), random.range(0.86F, 0.95F)};
    box({center, random.chance(0.5F) ? axis : -axis, half}, van ? 2.3F : 1.45F, car_color(random),
        PrismKind::car);
}

void BlockBuilder::parking(const Frame& frame) {
    patch(rectangle(frame), Surface::stalls);
    const float taken = random.range(0.35F, 0.9F);
    const bool two_rows = frame.half.y > 7.0F;
    const float edge = frame.half.y - 2.6F;
    for (float x = -frame.half.x + 1.3F; x < frame.half.x - 1.0F; x += 2.6F) {
        for (const float side : {-1.0F, 1.0F}) {
            if ((two_rows || side < 0.0F) && random.chance(taken)) {
                car(frame.at(x, side * edge + 0.3F * random.bell()), turned(frame.axis));
            }
        }
    }
}

void BlockBuilder::hedge(glm::vec2 from, glm::vec2 to) {
    const float half = 0.5F * length(to - from);
    box({(from + to) * 0.5F, normalized(to - from), {half, 0.55F}}, random.range(1.2F, 2.0F),
        varied({0.24F, 0.30F, 0.17F}, random, 0.12F), PrismKind::hedge);
}

void BlockBuilder::building(const Convex& shape, Building building) {
    if (shape.empty()) {
        return;
    }
    building.shape = Footprint(shape);
    building.outline = shape;
    building.axis = frame_of(shape).axis;
    building.seed = random.bits();
    block_.bounds.add(building.shape.bounds);
    block_.buildings.push_back(std::move(building));
}

void BlockBuilder::flat_building(const Convex& shape, float eaves) {
    if (shape.empty()) {
        return;
    }
    const FlatRoof roof = flat_roof(random);
    Building made;
    made.eaves = eaves;
    made.parapet = random.range(0.4F, 1.1F);
    made.cover = roof.cover;
    made.color = roof.color;
    made.rim = varied({0.64F, 0.61F, 0.56F}, random, 0.14F);
    building(shape, made);
    furnish(inset(shape, 1.2F), eaves);
}

void BlockBuilder::pitched_building(const Convex& shape, float eaves, std::uint32_t sloped) {
    if (shape.empty()) {
        return;
    }
    Building made;
    made.eaves = eaves;
    made.slope = random.range(0.5F, 0.95F);
    made.sloped = sloped;
    made.color = tile_color(random);
    made.cover = random.chance(0.1F) ? Cover::metal : Cover::tiles;
    if (made.cover == Cover::metal) {
        made.color = random.chance(0.3F) ? Color{0.45F, 0.55F, 0.50F} : Color{0.55F, 0.57F, 0.59F};
    }
    made.rise_limit = random.chance(0.16F) ? random.range(2.2F, 3.2F) : 1e9F;
    made.rim = varied({0.60F, 0.57F, 0.52F}, random, 0.12F);
    chimneys(shape, made);
    building(shape, made);
}

void BlockBuilder::chimneys(const Convex& shape, const Building& roof) {
    const Frame frame = frame_of(shape);
    const int count = random.index(4);
    for (int i = 0; i < count; ++i) {
        const glm::vec2 place = frame.at(frame.half.x * random.range(-0.7F, 0.7F),
                                         frame.half.y * random.range(-0.5F, 0.5F));
        const float rise = std::min(roof.rise_limit, roof.slope * inner_distance(shape, place));
        if (rise > 1.0F) {
            const bool window = random.chance(0.35F);
            box({place, frame.axis, window ? glm::vec2{0.6F, 0.8F} : glm::vec2{0.55F, 0.75F}},
                roof.eaves + rise + (window ? 0.1F : 1.3F),
                window ? Color{0.30F, 0.34F, 0.38F} : varied({0.47F, 0.38F, 0.34F}, random, 0.15F),
                window ? PrismKind::glass : PrismKind::box);
        }
    }
}

void BlockBuilder::furnish(const Convex& roof, float top) {
    if (roof.empty() || area(roof) < 40.0F) {
        return;
    }
    if (area(roof) > 120.0F && random.chance(0.13F)) {
        solar_panels(inset(roof, 1.0F), top);
        return;
    }
    const int count = 1 + static_cast<int>(area(roof) / random.range(45.0F, 150.0F));
    for (int i = 0; i < std::min(count, 26); ++i) {
        roof_box(roof, top, i == 0 && area(roof) > 110.0F);
    }
}

void BlockBuilder::roof_box(const Convex& roof, float top, bool stairs) {
    const Frame frame = frame_of(roof);
    const glm::vec2 half = stairs ? glm::vec2{random.range(1.8F, 3.2F), random.range(1.4F, 2.2F)}
                                  : glm::vec2{random.range(0.4F, 1.5F), random.range(0.4F, 1.1F)};
    const glm::vec2 place = frame.at(frame.half.x * random.range(-0.9F, 0.9F),
                                     frame.half.y * random.range(-0.9F, 0.9F));
    if (inner_distance(roof, place) < half.x + 0.3F) {
        return;
    }
    const Frame footprint{place, frame.axis, half};
    if (!stairs && random.chance(0.2F)) {
        box(footprint, top + 0.4F, {0.38F, 0.44F, 0.49F}, PrismKind::glass);
        return;
    }
    const float rise = stairs ? random.range(2.4F, 3.2F) : random.range(0.7F, 1.8F);
    box(footprint, top + rise, varied({0.66F, 0.66F, 0.65F}, random, 0.16F), PrismKind::box);
}

void BlockBuilder::solar_panels(const Convex& roof, float top) {
    if (roof.empty()) {
        return;
    }
    const Frame frame = frame_of(roof);
    const float length = random.range(2.0F, 4.5F);
    for (float y = -frame.half.y + 0.9F; y < frame.half.y; y += 2.3F) {
        for (float x = -frame.half.x + length; x < frame.half.x; x += 2.0F * length + 1.0F) {
            const glm::vec2 place = frame.at(x, y);
            if (inner_distance(roof, frame.at(x - length, y)) > 0.8F &&
                inner_distance(roof, frame.at(x + length, y)) > 0.8F) {
                box({place, frame.axis, {length, 0.75F}}, top + 0.6F, {0.19F, 0.22F, 0.30F},
                    PrismKind::panel);
            }
        }
    }
}

} // namespace reljef::terrains::urban
