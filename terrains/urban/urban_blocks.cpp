#include <algorithm>
#include <cmath>

#include "terrains/urban/urban_city.h"

namespace reljef::terrains::urban {
namespace {

constexpr std::uint32_t all_edges = ~0U;
constexpr float storey = 3.1F;

Frame shrunk(Frame frame, float by) {
    frame.half = {frame.half.x - by, frame.half.y - by};
    return frame;
}

/// One edge of a block and the edge of its courtyard behind it.
struct Side {
    glm::vec2 from;
    glm::vec2 to;
    glm::vec2 inner_from;
    glm::vec2 inner_to;
};

// The part of a side between two places along its front, metres.
Convex slice(const Side& side, float from, float to, bool first, bool last) {
    const glm::vec2 axis = normalized(side.to - side.from);
    const HalfPlane front{turned(axis), dot(turned(axis), side.from)};
    const auto inner_at = [&](float s) {
        return side.from + axis * s + front.normal * front.distance(side.inner_from);
    };
    return {{side.from + axis * from, side.from + axis * to, last ? side.inner_to : inner_at(to),
             first ? side.inner_from : inner_at(from)}};
}

void ring_house(BlockBuilder& builder, const Convex& shape, float eaves, bool pitched) {
    if (pitched) {
        builder.pitched_building(shape, eaves, 0b0101U);
    } else {
        builder.flat_building(shape, eaves);
    }
}

void back_lot(BlockBuilder& builder, const Side& side, float middle, float width) {
    Random& random = builder.random;
    const glm::vec2 axis = normalized(side.to - side.from);
    const glm::vec2 inward = turned(axis);
    const float depth = dot(inward, side.inner_from - side.from);
    const float reach = random.range(5.0F, 9.0F);
    const glm::vec2 center = side.from + axis * middle + inward * (depth + 0.5F * reach);
    const Frame yard{center, axis, {0.5F * width - 0.3F, 0.5F * reach}};
    const float pick = random.unit();
    builder.patch(rectangle(yard), pick < 0.5F    ? Surface::lawn
                                   : pick < 0.68F ? Surface::paving
                                   : pick < 0.8F  ? Surface::gravel
                                                  : Surface::asphalt);
    if (random.chance(0.3F)) {
        builder.flat_building(
            rectangle({center, axis, {random.range(1.8F, 3.4F), random.range(1.6F, 3.0F)}}),
            random.range(2.8F, 6.5F));
    }
    if (pick < 0.5F && random.chance(0.7F)) {
        builder.tree(yard.at(random.range(-2.0F, 2.0F), random.range(-1.0F, 3.0F)), 0.85F);
    }
    if (random.chance(0.4F)) {
        builder.hedge(yard.at(yard.half.x, -yard.half.y), yard.at(yard.half.x, yard.half.y));
    }
}

struct RingStyle {
    float floors = 4.0F;
    float pitched = 0.6F; ///< part of the houses
    float gaps = 0.05F;
    float depth = 12.0F;
};

void build_side(BlockBuilder& builder, const Side& side, const RingStyle& style) {
    Random& random = builder.random;
    const float total = length(side.to - side.from);
    const float corner = style.depth + 6.0F;
    float from = 0.0F;
    while (from < total - 0.5F) {
        float to = from + (from > 0.0F ? random.range(11.0F, 24.0F) : corner);
        if (to > total - corner) {
            to = from < total - corner - 8.0F ? total - corner : total;
        }
        const bool end = from <= 0.0F || to >= total;
        const float floors = std::max(2.0F, style.floors + std::floor(1.3F * random.bell() + 0.5F));
        if (end || !random.chance(style.gaps)) {
            ring_house(builder, slice(side, from, to, from <= 0.0F, to >= total),
                       floors * storey + random.range(0.5F, 1.6F), random.chance(style.pitched));
            back_lot(builder, side, 0.5F * (from + to), std::min(to - from, 16.0F));
        }
        from = to;
    }
}

// The courtyard; empty if the block is too small or has sharp corners.
Convex courtyard_of(const Convex& lot, float depth) {
    Convex yard;
    for (std::size_t i = 0; i < lot.size(); ++i) {
        const HalfPlane before = edge_plane(lot, i + lot.size() - 1);
        const HalfPlane after = edge_plane(lot, i);
        const float sine = before.normal.x * after.normal.y - before.normal.y * after.normal.x;
        if (sine < 0.25F) {
            return {};
        }
        const float a = before.offset + depth;
        const float b = after.offset + depth;
        yard.corners.emplace_back((a * after.normal.y - b * before.normal.y) / sine,
                                  (b * before.normal.x - a * after.normal.x) / sine);
    }
    for (std::size_t i = 0; i < lot.size(); ++i) {
        const glm::vec2 outer = lot.corner(i + 1) - lot.corner(i);
        if (dot(normalized(outer), yard.corner(i + 1) - yard.corner(i)) < 9.0F ||
            length(outer) < 2.0F * depth + 14.0F) {
            return {};
        }
    }
    return yard;
}

// A house in the middle of a lot, with driveway, garage and pool.
void build_house(BlockBuilder& builder, const Convex& lot, const Convex& block) {
    Random& random = builder.random;
    const Frame frame = frame_of(lot);
    std::size_t street = 0;
    for (std::size_t i = 1; i < block.size(); ++i) {
        if (edge_plane(block, i).distance(frame.center) <
            edge_plane(block, street).distance(frame.center)) {
            street = i;
        }
    }
    const HalfPlane front = edge_plane(block, street);
    const glm::vec2 axis{front.normal.y, -front.normal.x};
    const glm::vec2 center = frame.center - front.normal * random.range(0.0F, 2.5F);
    const glm::vec2 half{random.range(4.2F, 6.2F), random.range(3.8F, 5.2F)};
    const float eaves = random.chance(0.6F) ? random.range(5.2F, 6.6F) : random.range(3.0F, 4.0F);
    const Frame drive{
        center + axis * (half.x + 1.7F) - front.normal * 6.0F, front.normal, {9.0F, 1.5F}};
    Convex driveway = rectangle(drive);
    for (std::size_t i = 0; i < lot.size(); ++i) {
        driveway = clipped(driveway, edge_plane(lot, i));
    }
    builder.patch(driveway, random.chance(0.5F) ? Surface::paving : Surface::asphalt);
    const bool hip = random.chance(0.45F);
    builder.pitched_building(rectangle({center, axis, half}), eaves, hip ? all_edges : 0b0101U);
    if (random.chance(0.45F)) {
        const glm::vec2 wing = center + axis * random.range(-2.5F, 2.5F) + front.normal * half.y;
        builder.pitched_building(rectangle({wing, front.normal, {4.0F, 2.8F}}), eaves - 0.4F,
                                 hip ? all_edges : 0b0101U);
    }
    builder.flat_building(rectangle({drive.center + front.normal * 5.0F, axis, {1.7F, 3.0F}}),
                          2.7F);
    if (random.chance(0.6F)) {
        builder.car(drive.center - front.normal * 3.0F, front.normal);
    }
    if (random.chance(0.16F)) {
        builder.patch(octagon(center + front.normal * (half.y + 7.0F), {3.6F, 2.2F}),
                      Surface::pool);
    }
}

void build_garden(BlockBuilder& builder, const Convex& lot) {
    Random& random = builder.random;
    builder.patch(inset(lot, 0.3F), random.chance(0.85F) ? Surface::lawn : Surface::gravel);
    for (std::size_t i = 0; i < lot.size(); ++i) {
        if (random.chance(0.35F)) {
            builder.hedge(lot.corner(i), lot.corner(i + 1));
        }
        if (random.chance(0.6F)) {
            const glm::vec2 inside = (centroid(lot) - lot.corner(i)) * random.range(0.15F, 0.4F);
            builder.tree(lot.corner(i) + inside, 0.9F);
        }
    }
}

void build_tower(BlockBuilder& builder, const Convex& base, float height) {
    Random& random = builder.random;
    const float podium = random.range(8.0F, 17.0F);
    builder.flat_building(base, podium);
    Convex shape = inset(base, random.range(2.5F, 6.0F));
    const int steps = 1 + random.index(2);
    for (int i = 1; i <= steps; ++i) {
        if (shape.empty() || area(shape) < 120.0F) {
            return;
        }
        builder.flat_building(shape, podium + (height - podium) * static_cast<float>(i) /
                                                  static_cast<float>(steps));
        shape = inset(shape, random.range(2.0F, 4.0F));
    }
}

void light_well(BlockBuilder& builder, const Convex& lot) {
    const Frame frame = frame_of(lot);
    if (frame.half.x > 11.0F && frame.half.y > 8.0F) {
        builder.box({frame.center, frame.axis, {0.32F * frame.half.x, 0.3F * frame.half.y}}, 3.0F,
                    {0.42F, 0.41F, 0.39F}, PrismKind::well);
    }
}

} // namespace

void build_perimeter(BlockBuilder& builder) {
    Random& random = builder.random;
    RingStyle style;
    style.depth = random.range(10.5F, 13.5F);
    const Convex& lot = builder.lot();
    const Convex yard = courtyard_of(lot, style.depth);
    if (yard.empty()) {
        build_downtown(builder);
        return;
    }
    style.floors = 3.0F + static_cast<float>(random.index(4));
    style.pitched = random.chance(0.7F) ? random.range(0.65F, 1.0F) : random.range(0.0F, 0.3F);
    style.gaps = random.range(0.0F, 0.1F);
    const bool green = random.chance(0.6F);
    builder.ground(Surface::paving);
    builder.patch(yard, green                 ? Surface::lawn
                        : random.chance(0.5F) ? Surface::paving
                                              : Surface::gravel);
    for (std::size_t i = 0; i < lot.size(); ++i) {
        build_side(builder, {lot.corner(i), lot.corner(i + 1), yard.corner(i), yard.corner(i + 1)},
                   style);
    }
    const Convex middle = inset(yard, 9.0F);
    builder.grove(middle, green ? 7.0F : 12.0F);
    if (!middle.empty() && !green && random.chance(0.6F)) {
        builder.flat_building(rectangle(shrunk(frame_of(middle), 3.0F)), random.range(3.5F, 8.0F));
    }
}

void build_downtown(BlockBuilder& builder) {
    Random& random = builder.random;
    builder.ground(Surface::paving);
    const LotOptions options{random.range(420.0F, 1500.0F), 0.14F, 9.0F};
    const float floors = random.range(4.0F, 8.0F);
    for (const Convex& lot : lots_of(builder.lot(), options, random)) {
        const float height = std::max(2.0F, floors + 3.0F * random.bell()) * storey;
        const float pick = random.unit();
        if (area(lot) > 700.0F && pick < 0.2F) {
            build_tower(builder, inset(lot, 0.8F), random.range(38.0F, 88.0F));
        } else if (pick > 0.95F) {
            builder.parking(shrunk(frame_of(inset(lot, 2.0F)), 0.5F));
        } else if (height < 19.0F && random.chance(0.28F)) {
            builder.pitched_building(lot, height, all_edges);
        } else {
            builder.flat_building(lot, height);
            light_well(builder, lot);
        }
    }
}

void build_houses(BlockBuilder& builder) {
    Random& random = builder.random;
    builder.ground(Surface::lawn);
    const LotOptions options{random.range(430.0F, 720.0F), 0.05F, 9.5F};
    for (const Convex& lot : lots_of(builder.lot(), options, random)) {
        build_garden(builder, lot);
        if (area(lot) > 210.0F) {
            build_house(builder, lot, builder.lot());
        }
    }
}

void build_slabs(BlockBuilder& builder) {
    Random& random = builder.random;
    builder.ground(Surface::lawn);
    const Convex& lot = builder.lot();
    const Frame frame = frame_of(lot);
    const float height = random.range(5.0F, 15.0F) * storey;
    const bool across = random.chance(0.5F);
    const Frame lie =
        across ? Frame{frame.center, turned(frame.axis), {frame.half.y, frame.half.x}} : frame;
    const float step = random.range(34.0F, 44.0F);
    const int rows = std::max(1, static_cast<int>(2.0F * lie.half.y / step));
    for (int i = 0; i < rows; ++i) {
        const float y = (static_cast<float>(i) - 0.5F * static_cast<float>(rows - 1)) * step;
        const Convex strip =
            rectangle({lie.at(0.0F, y - 3.0F), lie.axis, {lie.half.x - 9.0F, 6.5F}});
        Convex slab = strip;
        Convex room = inset(lot, 4.0F);
        for (std::size_t k = 0; k < room.size(); ++k) {
            slab = clipped(slab, edge_plane(room, k));
        }
        builder.flat_building(slab, std::max(12.0F, height + 6.0F * random.bell()));
        const Frame cars{lie.at(0.0F, y + 11.0F), lie.axis, {0.62F * lie.half.x, 8.2F}};
        if (inner_distance(lot, cars.at(cars.half.x, 8.2F)) > 0.0F &&
            inner_distance(lot, cars.at(-cars.half.x, 8.2F)) > 0.0F) {
            builder.parking(cars);
        }
        builder.patch(rectangle({lie.at(0.0F, y - 11.5F), lie.axis, {0.9F * lie.half.x, 1.2F}}),
                      Surface::path);
    }
    builder.grove(lot, 10.5F);
}

void build_halls(BlockBuilder& builder) {
    Random& random = builder.random;
    builder.ground(Surface::asphalt);
    const LotOptions options{5200.0F, 0.15F, 20.0F};
    for (const Convex& lot : lots_of(inset(builder.lot(), 2.0F), options, random)) {
        const Frame frame = frame_of(lot);
        const float place = frame.half.x * random.range(-0.1F, 0.35F);
        const HalfPlane side{frame.axis, dot(frame.axis, frame.at(place, 0.0F))};
        const Convex hall = inset(clipped(lot, side), 3.0F);
        builder.flat_building(hall, random.range(6.5F, 13.0F));
        const Convex yard = inset(clipped(lot, side.flipped()), 2.0F);
        if (!yard.empty()) {
            const Frame rows = frame_along(yard, turned(frame.axis));
            for (float y = -rows.half.y + 8.5F; y < rows.half.y - 8.0F; y += 17.5F) {
                builder.parking({rows.at(0.0F, y), rows.axis, {0.8F * rows.half.x, 8.2F}});
            }
        }
        builder.grove(clipped(lot, {-side.normal, -side.offset - 3.0F}), 19.0F, 0.8F);
    }
}

void build_park(BlockBuilder& builder) {
    Random& random = builder.random;
    builder.ground(Surface::meadow);
    const Convex& lot = builder.lot();
    const glm::vec2 center = centroid(lot) + frame_of(lot).axis * (6.0F * random.bell());
    for (std::size_t i = 0; i < lot.size(); ++i) {
        const glm::vec2 edge = lot.corner(i + 1) - lot.corner(i);
        for (const glm::vec2 gate :
             {lot.corner(i), lot.corner(i) + edge * random.range(0.4F, 0.6F)}) {
            const glm::vec2 way = center - gate;
            builder.patch(
                rectangle({gate + way * 0.5F, normalized(way), {0.5F * length(way), 1.4F}}),
                Surface::path);
        }
    }
    const Frame frame = frame_of(lot);
    builder.grove(inset(lot, 1.0F), random.range(6.5F, 9.5F), 1.15F);
    const bool pond = random.chance(0.6F);
    const glm::vec2 size = frame.half * (pond ? 0.36F : 0.22F);
    builder.patch(octagon(center, {size.x + 2.5F, size.y + 2.5F}), Surface::path);
    builder.patch(octagon(center, size), pond ? Surface::water : Surface::lawn);
}

void build_square(BlockBuilder& builder) {
    Random& random = builder.random;
    builder.ground(Surface::paving);
    const Frame frame = shrunk(frame_of(builder.lot()), 6.0F);
    const float nave = std::min(15.0F, 0.45F * frame.half.x);
    const float aisle = std::min(7.5F, 0.3F * frame.half.y);
    Building church;
    church.cover = Cover::tiles;
    church.color = {0.40F, 0.37F, 0.35F};
    church.eaves = 11.0F;
    church.slope = 1.1F;
    church.sloped = 0b0101U;
    const glm::vec2 place = frame.at(0.3F * frame.half.x, 0.0F);
    builder.building(rectangle({place, frame.axis, {nave, aisle}}), church);
    builder.building(rectangle({place + frame.axis * (0.35F * nave),
                                turned(frame.axis),
                                {aisle * 1.7F, aisle * 0.8F}}),
                     church);
    church.eaves = 27.0F;
    church.slope = 3.4F;
    church.sloped = all_edges;
    church.cover = Cover::metal;
    church.color = {0.42F, 0.52F, 0.47F};
    builder.building(rectangle({place - frame.axis * nave, frame.axis, {3.6F, 3.6F}}), church);
    builder.patch(octagon(frame.at(-0.55F * frame.half.x, 0.0F), {5.5F, 5.5F}), Surface::gravel);
    builder.patch(octagon(frame.at(-0.55F * frame.half.x, 0.0F), {4.5F, 4.5F}), Surface::pool);
    for (float x = -frame.half.x; x < frame.half.x; x += 8.5F) {
        for (const float y : {-frame.half.y, frame.half.y}) {
            if (random.chance(0.85F)) {
                builder.tree(frame.at(x, y), 0.9F);
            }
        }
    }
}

} // namespace reljef::terrains::urban
