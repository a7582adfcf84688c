#include <array>
#include <cmath>

#include "terrains/urban/urban_tile.h"

namespace reljef::terrains::urban {
namespace {

struct Slope {
    float run = 0.0F;   ///< metres from the eaves
    float ridge = 0.0F; ///< metres to the ridge or hip
    std::size_t facet = 0;
};

Slope slope_at(const Building& building, glm::vec2 place) {
    float first = 1e9F;
    float second = 1e9F;
    Slope slope;
    for (std::size_t k = 0; k < building.shape.planes.size(); ++k) {
        if ((building.sloped >> std::min<std::size_t>(k, 31U) & 1U) == 0U) {
            continue;
        }
        const float distance = building.shape.planes[k].distance(place);
        if (distance < first) {
            second = first;
            first = distance;
            slope.facet = k;
        } else {
            second = std::min(second, distance);
        }
    }
    slope.run = std::max(0.0F, first);
    slope.ridge = 0.5F * (second - first);
    return slope;
}

Color pitched_color(const Building& building, const Slope& slope, const Tile& tile, std::size_t i) {
    const bool metal = building.cover == Cover::metal;
    const float facet =
        material::unit_hash(building.seed, static_cast<std::int32_t>(slope.facet), 3) - 0.5F;
    const float rows = fract(slope.run / 1.1F) < 0.4F ? -0.025F : 0.012F;
    float light = 1.0F + 0.11F * facet + rows + (metal ? 0.03F : 0.075F) * tile.grain[i] +
                  0.05F * tile.fine[i] + 0.10F * tile.broad[i];
    light *= slope.run < 0.45F ? 0.86F : 1.0F;
    Color color = building.color * light;
    const float ridge = coverage(tile, 0.22F - slope.ridge);
    return color * (1.0F + 0.10F * ridge);
}

float seams(const Building& building, glm::vec2 place, float step) {
    const float along = fract(dot(building.axis, place) / step);
    return along * step < 0.4F ? 1.0F : 0.0F;
}

Color flat_color(const Building& building, glm::vec2 place, float inside, const Tile& tile,
                 std::size_t i) {
    // Strengths of grain, fine and broad noise, and seams.
    constexpr std::array<std::array<float, 4>, 7> looks{{{0.09F, 0.06F, 0.09F, 0.0F},
                                                         {0.04F, 0.08F, 0.14F, 0.05F},
                                                         {0.02F, 0.03F, 0.07F, 0.045F},
                                                         {0.04F, 0.05F, 0.10F, 0.03F},
                                                         {0.06F, 0.05F, 0.08F, 0.0F},
                                                         {0.03F, 0.04F, 0.06F, 0.05F},
                                                         {0.08F, 0.14F, 0.20F, 0.0F}}};
    const std::array<float, 4>& look = looks[static_cast<std::size_t>(building.cover)];
    const float drains = std::clamp(1.6F - inside, 0.0F, 1.0F) * (0.06F + 0.05F * tile.fine[i]);
    const float light = 1.0F + look[0] * tile.grain[i] + look[1] * tile.fine[i] +
                        look[2] * tile.broad[i] - look[3] * seams(building, place, 3.4F) - drains;
    return building.color * light;
}

struct RoofSample {
    float height;
    Color color;
};

RoofSample roof_sample(const Building& building, glm::vec2 place, float inside, const Tile& tile,
                       std::size_t i) {
    if (building.sloped != 0U) {
        const Slope slope = slope_at(building, place);
        const float rise = building.slope * slope.run;
        if (rise < building.rise_limit) {
            return {building.eaves + rise, pitched_color(building, slope, tile, i)};
        }
        const Color deck = building.color * 0.4F + Color{0.27F, 0.27F, 0.27F};
        return {building.eaves + building.rise_limit,
                deck * (1.0F + 0.05F * tile.grain[i] + 0.08F * tile.broad[i])};
    }
    const bool is_straight = tile.walls == building::CityWalls::straight;
    const float wall = std::max(0.35F, 0.75F * tile.spacing);
    const float rim = coverage(tile, wall - inside);
    Color color = flat_color(building, place, inside, tile, i);
    blend(color, building.rim * (1.0F + 0.03F * tile.grain[i]), rim);
    const bool is_resolved = wall >= 2.0F * tile.spacing; // else its crest would be jagged
    const float straight = is_resolved ? rim : 0.0F;
    const float raised = is_straight ? straight : inside < wall ? 1.0F : 0.0F;
    return {building.eaves + raised * building.parapet, color};
}

// A roof covers a share of a sample: first the ground, then lower roofs.
void add_roof(Tile& tile, std::size_t i, float height, float share) {
    const float from_ground = std::min(tile.bare[i], share);
    const float roofed = 1.0F - tile.bare[i];
    const bool is_above = tile.built[i] < height * roofed;
    const float from_roofs = is_above ? std::min(share - from_ground, roofed) : 0.0F;
    const float ground = tile.height[i] - tile.built[i];
    const float ground_left =
        from_ground < tile.bare[i] ? ground * (1.0F - from_ground / tile.bare[i]) : 0.0F;
    const float roofs_left =
        from_roofs < roofed ? tile.built[i] * (1.0F - from_roofs / roofed) : 0.0F;
    tile.built[i] = roofs_left + (from_ground + from_roofs) * height;
    tile.bare[i] -= from_ground;
    tile.height[i] = ground_left + tile.built[i];
}

// Raises or lowers a sample to a height, as far as it is covered.
void raise(Tile& tile, std::size_t i, float height, float share) {
    tile.height[i] += share * (height - tile.height[i]);
}

Box bounds_of(const Frame& frame, glm::vec2 shift) {
    const glm::vec2 side = turned(frame.axis);
    const glm::vec2 half{std::abs(frame.axis.x) * frame.half.x + std::abs(side.x) * frame.half.y,
                         std::abs(frame.axis.y) * frame.half.x + std::abs(side.y) * frame.half.y};
    return {frame.center + shift - half, frame.center + shift + half};
}

Color prism_color(const Prism& prism, glm::vec2 local, const Tile& tile, std::size_t i) {
    switch (prism.kind) {
    case PrismKind::car: {
        const float u = local.x / prism.frame.half.x;
        const bool glass = (u > 0.12F && u < 0.42F) || (u < -0.58F && u > -0.8F);
        return glass ? Color{0.20F, 0.22F, 0.24F} : prism.color;
    }
    case PrismKind::hedge:
        return prism.color * (1.0F + 0.12F * tile.grain[i] + 0.2F * tile.fine[i]);
    case PrismKind::panel:
        return prism.color * (fract(local.x / 1.5F) < 0.2F ? 1.35F : 1.0F);
    default:
        return prism.color * (1.0F + 0.04F * tile.grain[i]);
    }
}

} // namespace

void paint_building(Tile& tile, const Warp& warp, const Building& building, glm::vec2 shift) {
    for_each_sample(tile, warp, building.shape.bounds.moved(shift), [&](std::size_t i) {
        const glm::vec2 place = tile.place[i] - shift;
        const float inside = building.shape.distance(place);
        const float tint = coverage(tile, inside);
        const bool is_straight = tile.walls == building::CityWalls::straight;
        const float share = is_straight     ? building.shape.share(place, tile.spacing)
                            : inside > 0.0F ? 1.0F
                                            : 0.0F;
        if (std::max(tint, share) <= 0.0F || tile.height[i] >= building.eaves + 60.0F) {
            return;
        }
        const RoofSample roof = roof_sample(building, place, inside, tile, i);
        if (roof.height > tile.height[i]) {
            blend(tile.color[i], roof.color, tint);
        }
        if (is_straight) {
            add_roof(tile, i, roof.height, share);
        } else if (roof.height > tile.height[i] && share > 0.0F) {
            tile.height[i] = roof.height;
        }
    });
}

void paint_prism(Tile& tile, const Warp& warp, const Prism& prism, glm::vec2 shift) {
    const bool well = prism.kind == PrismKind::well;
    const bool is_straight = tile.walls == building::CityWalls::straight;
    Frame frame = prism.frame;
    if (is_straight && prism.kind == PrismKind::hedge) {
        frame.half.y = std::max(frame.half.y, 1.5F * tile.spacing); // else its top would be jagged
    }
    const glm::vec2 axis = frame.axis;
    for_each_sample(tile, warp, bounds_of(frame, shift), [&](std::size_t i) {
        const glm::vec2 from = tile.place[i] - shift - frame.center;
        const glm::vec2 local{dot(axis, from), dot(turned(axis), from)};
        const glm::vec2 margin = frame.half - glm::abs(local);
        const float inside = std::min(margin.x, margin.y);
        const float tint = coverage(tile, inside);
        const float share = is_straight ? share_inside(axis, margin.x, tile.spacing) *
                                              share_inside(axis, margin.y, tile.spacing)
                            : inside > 0.0F ? 1.0F
                                            : 0.0F;
        if (std::max(tint, share) <= 0.0F || (tile.height[i] >= prism.top) != well) {
            return;
        }
        blend(tile.color[i], prism_color(prism, local, tile, i), tint);
        raise(tile, i, prism.top, share);
        tile.planted[i] = stands_on_ground(prism.kind) ? 1 : tile.planted[i];
    });
}

void paint_tree(Tile& tile, const Warp& warp, const Tree& tree, glm::vec2 shift) {
    Box box;
    box.add(tree.center + shift, tree.radius * 1.2F);
    for_each_sample(tile, warp, box, [&](std::size_t i) {
        const float away = length(tile.place[i] - shift - tree.center) / tree.radius;
        const float part = away * (1.0F + 0.35F * tile.fine[i]);
        const float tint = coverage(tile, (1.0F - part) * tree.radius);
        const float dome = std::sqrt(std::max(0.0F, 1.0F - part * part));
        const float top = tree.height * (0.5F + 0.5F * dome) *
                          (1.0F + 0.06F * tile.fine[i] + 0.05F * tile.grain[i]);
        if (tint <= 0.0F || top <= tile.height[i]) {
            return;
        }
        const float light = 0.74F + 0.36F * dome + 0.13F * tile.grain[i] + 0.22F * tile.fine[i];
        blend(tile.color[i], tree.color * light, tint);
        const float share = tile.walls == building::CityWalls::straight ? tint
                            : part < 1.0F                               ? 1.0F
                                                                        : 0.0F;
        raise(tile, i, top, share);
        tile.planted[i] = 1;
    });
}

} // namespace reljef::terrains::urban
