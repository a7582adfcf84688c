#include <array>
#include <cmath>

#include "terrains/urban/urban_tile.h"

namespace reljef::terrains::urban {
namespace {

constexpr Color paint_white{0.76F, 0.75F, 0.72F};
constexpr float sidewalk_height = 0.15F;

/// The base colour and the strength of each noise.
struct SurfaceLook {
    Color color;
    float grain;
    float fine;
    float broad;
};

constexpr std::array<SurfaceLook, 11> looks{{{{0.405F, 0.400F, 0.395F}, 0.030F, 0.03F, 0.06F},
                                             {{0.560F, 0.540F, 0.505F}, 0.035F, 0.04F, 0.07F},
                                             {{0.580F, 0.545F, 0.475F}, 0.050F, 0.05F, 0.08F},
                                             {{0.355F, 0.405F, 0.235F}, 0.050F, 0.08F, 0.16F},
                                             {{0.375F, 0.410F, 0.245F}, 0.060F, 0.11F, 0.24F},
                                             {{0.430F, 0.365F, 0.285F}, 0.060F, 0.10F, 0.12F},
                                             {{0.220F, 0.275F, 0.260F}, 0.015F, 0.03F, 0.07F},
                                             {{0.360F, 0.590F, 0.640F}, 0.015F, 0.03F, 0.02F},
                                             {{0.640F, 0.600F, 0.525F}, 0.040F, 0.04F, 0.05F},
                                             {{0.520F, 0.350F, 0.270F}, 0.020F, 0.02F, 0.05F},
                                             {{0.425F, 0.420F, 0.410F}, 0.030F, 0.03F, 0.07F}}};

/// A street at the border of a cell.
struct Arm {
    HalfPlane middle; ///< its distance counts from the middle of the street into the cell
    const Street* street = nullptr;
    float tone = 1.0F;
};

// A place on a street, metres.
struct RoadPlace {
    float along = 0.0F;
    float across = 0.0F; // from the middle
    float clear = 0.0F;  // to the next junction
};

// The two edges of the block with the largest distance to a sample outside.
struct Outside {
    const Arm* first = nullptr;
    const Arm* second = nullptr; // may be null
    float first_depth = 0.0F;
    float second_depth = 0.0F;
};

Outside outside(const std::vector<Arm>& arms, glm::vec2 place) {
    Outside found;
    for (const Arm& arm : arms) {
        const float depth = arm.street->half_width - arm.middle.distance(place);
        if (depth > found.first_depth) {
            found = {&arm, found.first, depth, found.first_depth};
        } else if (depth > found.second_depth) {
            found.second = &arm;
            found.second_depth = depth;
        }
    }
    return found;
}

float block_distance(const Outside& out) {
    const float a = out.first_depth;
    const float b = out.second_depth;
    if (out.second == nullptr) {
        return a;
    }
    const float c = dot(out.first->middle.normal, out.second->middle.normal);
    if (a < c * b || b < c * a || c * c > 0.98F) {
        return a;
    }
    return std::sqrt((a * a + b * b - 2.0F * c * a * b) / (1.0F - c * c));
}

struct NextJunction {
    float clear = 1e9F; // metres before it
    bool crossing = false;
};

NextJunction next_junction(const Street& street, float along) {
    NextJunction next;
    for (const Junction& junction : street.junctions) {
        const float distance = std::abs(along - junction.at) - junction.half;
        if (distance < next.clear) {
            next = {distance, junction.crossing};
        }
    }
    return next;
}

// Blends the widths of two streets at a corner.
float sidewalk_width(const Outside& out) {
    const float first = out.first->street->sidewalk;
    if (out.second == nullptr) {
        return first;
    }
    const float a = out.first_depth * out.first_depth;
    const float b = out.second_depth * out.second_depth;
    return (a * first + b * out.second->street->sidewalk) / (a + b);
}

struct GroundPainter {
    Tile& tile;
    const Block& block;
    std::vector<Arm> arms;

    void sample(std::size_t i, glm::vec2 place) {
        float inside = 1e9F;
        float lot = 1e9F;
        for (const Arm& arm : arms) {
            const float distance = arm.middle.distance(place);
            inside = std::min(inside, distance);
            lot = std::min(lot, distance - arm.street->half_width);
        }
        if (inside < -0.05F) {
            return;
        }
        if (lot >= 0.0F) {
            tile.color[i] = surface_color(block.ground, tile, i);
            tile.height[i] = sidewalk_height;
        } else {
            street_sample(i, place);
        }
    }

private:
    void street_sample(std::size_t i, glm::vec2 place) {
        const Outside out = outside(arms, place);
        const float curb = block_distance(out) - sidewalk_width(out);
        int here = 0;
        const Arm* road = nullptr;
        const Arm* water = nullptr;
        for (const Arm& each : arms) {
            const float across = each.middle.distance(place);
            water = across < each.street->water + 3.4F ? &each : water;
            if (across < each.street->roadway()) {
                ++here;
                road = road == nullptr || across < road->middle.distance(place) ? &each : road;
            }
        }
        if (water != nullptr && !on_bridge(*water, place)) {
            river(i, *water, water->middle.distance(place));
            return;
        }
        if (curb < 0.25F || road == nullptr) {
            sidewalk(i, place, *out.first, curb);
            return;
        }
        roadway(i, place, here, *road, road->middle.distance(place));
    }

    void roadway(std::size_t i, glm::vec2 place, int arms_here, const Arm& arm, float across) {
        const float along = arm.street->along(place);
        Color color = surface_color(Surface::asphalt, tile, i) * arm.tone;
        const float wheel = std::abs(fract(across / 1.75F) - 0.5F);
        color *= 1.0F + (wheel < 0.2F ? -0.022F : 0.012F);
        if (material::unit_hash(arm.street->seed,
                                static_cast<std::int32_t>(std::floor(along / 13.0F)),
                                static_cast<std::int32_t>(across / 3.3F)) > 0.93F) {
            color *= 0.92F;
        }
        tile.color[i] = color;
        tile.height[i] = 0.0F;
        if (arms_here == 1) {
            markings(i, arm, along, across);
        }
    }

    void sidewalk(std::size_t i, glm::vec2 place, const Arm& arm, float curb) {
        const bool joint = fract(dot(place, arm.street->tangent) / 3.0F) < 0.12F;
        const float light = 0.97F + 0.06F * arm.tone - (joint ? 0.03F : 0.0F);
        tile.color[i] = surface_color(Surface::paving, tile, i) * light;
        blend(tile.color[i], {0.63F, 0.62F, 0.59F}, 0.6F * coverage(tile, 0.2F - std::abs(curb)));
        tile.height[i] = sidewalk_height;
    }

    void markings(std::size_t i, const Arm& arm, float along, float across) {
        const Street& street = *arm.street;
        const auto [clear, crossing] = next_junction(street, along);
        if (clear < 0.5F) {
            return;
        }
        if (clear < 4.5F) {
            if (crossing && clear > 0.8F && clear < 3.9F && across < street.roadway() - 0.4F) {
                line(i, fract(across / 1.25F) * 1.25F - 0.62F, 0.31F, 0.8F);
            }
            return;
        }
        if (street.kind == StreetKind::boulevard && across < 1.3F && clear > 6.0F) {
            tile.color[i] = surface_color(Surface::lawn, tile, i);
            tile.height[i] = sidewalk_height;
            return;
        }
        lanes(i, street, {along, across, clear});
        if (street.kind != StreetKind::lane && clear < 5.6F && across < 3.3F) {
            line(i, clear - 5.1F, 0.22F, 0.6F);
        }
        if (street.roadway() > 5.0F && street.water <= 0.0F && clear > 6.0F) {
            line(i, across - (street.roadway() - 2.25F), 0.06F, 0.22F);
        }
    }

    void lanes(std::size_t i, const Street& street, const RoadPlace& place) {
        const bool near = place.clear < 22.0F;
        const bool dash = near || fract(place.along / 9.0F) < 0.45F;
        if (street.kind == StreetKind::boulevard) {
            line(i, place.across - 1.7F, 0.09F, 0.6F);
            line(i, place.across - 5.1F, 0.08F, dash ? 0.6F : 0.0F);
        } else if (street.kind != StreetKind::lane && street.water <= 0.0F) {
            line(i, place.across, 0.09F, dash ? 0.65F : 0.0F);
            if (street.roadway() > 6.2F) {
                line(i, place.across - 3.4F, 0.08F, near ? 0.6F : 0.0F);
            }
        }
    }

    void river(std::size_t i, const Arm& arm, float across) {
        const float water = arm.street->water;
        const bool is_straight = tile.walls == building::CityWalls::straight;
        // Of the wall along the quay; narrower, its top would be jagged.
        const float width = is_straight ? std::max(0.8F, 2.5F * tile.spacing) : 0.8F;
        if (across < water) {
            tile.color[i] = surface_color(Surface::water, tile, i);
            const float deep = std::min(1.0F, (water - across) / 3.0F);
            tile.color[i] *= 1.12F - 0.12F * deep + 0.02F * tile.fine[i] * deep;
            tile.height[i] = -3.0F;
        } else {
            const bool is_wall = across < water + width;
            tile.color[i] = surface_color(Surface::paving, tile, i) * (is_wall ? 1.14F : 0.96F);
            tile.height[i] = is_wall ? 0.9F : sidewalk_height;
        }
        if (is_straight) {
            const float quay = share_inside(arm.middle.normal, across - water, tile.spacing);
            const float bank =
                share_inside(arm.middle.normal, across - water - width, tile.spacing);
            tile.height[i] = -3.0F + 3.9F * quay + (sidewalk_height - 0.9F) * bank;
        }
    }

    [[nodiscard]] bool on_bridge(const Arm& river, glm::vec2 place) const {
        for (const Arm& arm : arms) {
            if (arm.street != river.street && arm.street->kind >= StreetKind::avenue &&
                arm.middle.distance(place) < arm.street->half_width) {
                return true;
            }
        }
        return false;
    }

    void line(std::size_t i, float across, float half, float strength) {
        const float worn = strength * std::clamp(0.75F + 0.5F * tile.fine[i], 0.2F, 1.0F);
        const float cover = coverage(tile, half - std::abs(across)) *
                            std::min(1.0F, 2.0F * half / tile.spacing + 0.3F);
        blend(tile.color[i], paint_white, worn * cover);
    }
};

// White lines across the long axis, on both sides of a lane.
void stall_lines(Tile& tile, std::size_t i, const Frame& frame, glm::vec2 place) {
    const glm::vec2 local{dot(frame.axis, place - frame.center),
                          dot(turned(frame.axis), place - frame.center)};
    const float edge = frame.half.y - std::abs(local.y);
    const float phase = fract((local.x + frame.half.x) / 2.6F) * 2.6F;
    if (edge < 5.0F && (local.y < 0.0F || frame.half.y > 7.0F)) {
        blend(tile.color[i], paint_white,
              0.5F * coverage(tile, 0.1F - std::min(phase, 2.6F - phase)));
    }
}

} // namespace

Color surface_color(Surface surface, const Tile& tile, std::size_t i) {
    const SurfaceLook& look = looks[static_cast<std::size_t>(surface)];
    const float light =
        1.0F + look.grain * tile.grain[i] + look.fine * tile.fine[i] + look.broad * tile.broad[i];
    Color color = look.color * light;
    if (surface == Surface::lawn || surface == Surface::meadow) {
        const float dry =
            std::clamp(0.25F + 0.9F * tile.broad[i] + 0.3F * tile.fine[i], 0.0F, 0.7F);
        blend(color, Color{0.46F, 0.43F, 0.29F} * light, dry);
    }
    return color;
}

void paint_ground(Tile& tile, const StreetPlan& plan, const Block& block, glm::vec2 shift) {
    GroundPainter painter{tile, block, {}};
    Box box;
    for (std::size_t k = 0; k < block.cell.outline.size(); ++k) {
        const Street& street = plan.streets[block.cell.streets[k]];
        const float tone = 0.86F + 0.3F * material::unit_hash(street.seed, 1, 1);
        painter.arms.push_back({edge_plane(block.cell.outline, k), &street, tone});
        box.add(block.cell.outline.corners[k] + shift, 0.1F);
    }
    for_each_sample(tile, plan.warp, box,
                    [&](std::size_t i) { painter.sample(i, tile.place[i] - shift); });
}

void paint_patch(Tile& tile, const Warp& warp, const Patch& patch, glm::vec2 shift) {
    const float tone = 0.9F + 0.2F * material::unit_hash(patch.seed, 2, 2);
    const bool sunken = patch.surface == Surface::water || patch.surface == Surface::pool;
    for_each_sample(tile, warp, patch.shape.bounds.moved(shift), [&](std::size_t i) {
        const glm::vec2 place = tile.place[i] - shift;
        const float distance = patch.shape.distance(place);
        const float cover = coverage(tile, distance);
        if (cover <= 0.0F) {
            return;
        }
        blend(tile.color[i], surface_color(patch.surface, tile, i) * tone, cover);
        if (patch.surface == Surface::stalls && distance > 0.0F) {
            stall_lines(tile, i, patch.frame, place);
        }
        if (sunken && distance > 0.0F) {
            tile.height[i] = -0.3F;
        }
    });
}

} // namespace reljef::terrains::urban
