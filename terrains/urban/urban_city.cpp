#include "terrains/urban/urban_city.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/parallel_for.h"

namespace reljef::terrains::urban {
namespace {

/// The side of a street along an edge of a cell.
struct Curb {
    const Street& street;
    glm::vec2 from;
    glm::vec2 tangent;
    glm::vec2 inward;
    float length;

    [[nodiscard]] glm::vec2 at(float along, float across) const {
        return from + tangent * along + inward * across;
    }
    /// Signed distance to the nearest crossing roadway, metres; negative inside it.
    [[nodiscard]] float clearance(float along) const {
        const float place = street.along(at(along, 0.0F));
        float nearest = 1e9F;
        for (const Junction& junction : street.junctions) {
            nearest = std::min(nearest, std::abs(place - junction.at) - junction.half);
        }
        return nearest;
    }
};

void park_cars(const Curb& curb, BlockBuilder& builder) {
    Random& random = builder.random;
    const bool quay = curb.street.kind == StreetKind::river;
    const float lane = curb.street.roadway() - 1.15F;
    const float taken = quay ? 0.3F : random.range(0.25F, 0.85F);
    if (curb.street.roadway() < 3.5F) {
        return;
    }
    for (float s = 4.0F; s < curb.length - 4.0F; s += random.range(5.3F, 6.3F)) {
        if (curb.clearance(s) > 7.5F && random.chance(taken)) {
            builder.car(curb.at(s, lane + 0.1F * random.bell()), curb.tangent);
        }
    }
}

void drive_cars(const Curb& curb, BlockBuilder& builder) {
    Random& random = builder.random;
    const float roadway = curb.street.roadway();
    const bool wide = roadway > 8.0F;
    for (const float lane : {wide ? 2.6F : 1.55F, 5.7F}) {
        if (lane > roadway - 3.6F || curb.street.water > 0.0F) {
            continue;
        }
        for (float s = random.range(5.0F, 40.0F); s < curb.length - 4.0F;
             s += random.range(7.0F, wide ? 48.0F : 110.0F)) {
            if (curb.clearance(s) > 0.0F) {
                builder.car(curb.at(s, lane + 0.15F * random.bell()), curb.tangent);
            }
        }
    }
}

void plant_street(const Curb& curb, BlockBuilder& builder) {
    Random& random = builder.random;
    const Street& street = curb.street;
    const float likely = street.kind >= StreetKind::avenue ? 0.85F : 0.55F;
    if (street.kind < StreetKind::boulevard && !random.chance(likely)) {
        return;
    }
    const float size = random.range(0.6F, 0.85F);
    const float step = random.range(7.5F, 11.0F);
    for (float s = 5.0F; s < curb.length - 5.0F; s += step) {
        if (curb.clearance(s) > 6.0F && random.chance(0.82F)) {
            builder.tree(curb.at(s + random.bell(), street.roadway() + 0.9F), size);
        }
        if (street.water > 0.0F && curb.clearance(s) > 3.0F && random.chance(0.75F)) {
            builder.tree(curb.at(s, street.water + 2.2F), size);
        }
    }
}

void plant_median(const Curb& curb, BlockBuilder& builder) {
    if (curb.street.kind != StreetKind::boulevard) {
        return;
    }
    for (float s = 6.0F; s < curb.length - 6.0F; s += 17.0F) {
        if (curb.clearance(s) > 9.0F) {
            builder.tree(curb.at(s, 0.0F), 0.7F);
        }
    }
}

enum class Use : std::uint8_t { perimeter, downtown, houses, slabs, halls, park, square };

// Small cities have blocks of all uses, large ones have districts.
Use use_of(const Block& block, int index, int count, float period, std::uint32_t seed) {
    constexpr std::array<Use, 10> mixed{Use::perimeter, Use::downtown,  Use::perimeter, Use::houses,
                                        Use::park,      Use::perimeter, Use::downtown,  Use::square,
                                        Use::slabs,     Use::perimeter};
    Random random(material::hash(seed, 31, index));
    if (count < 16) {
        return mixed[static_cast<std::size_t>(index) % mixed.size()];
    }
    const float size = area(block.lot);
    const float pick = random.unit();
    if (pick < 0.07F || (size > 15000.0F && pick < 0.25F)) {
        return Use::park;
    }
    if (pick > 0.965F && size > 3500.0F && size < 9000.0F) {
        return Use::square;
    }
    const auto cells = std::max(1, static_cast<std::int32_t>(std::lround(period / 420.0F)));
    const glm::vec2 place = centroid(block.lot) * (static_cast<float>(cells) / period);
    const float dense =
        0.52F + 0.62F * material::gradient_noise(seed + 5U, place, cells) + 0.16F * random.bell();
    if (dense > 0.7F) {
        return Use::downtown;
    }
    if (dense > 0.34F) {
        return pick > 0.9F ? Use::downtown : Use::perimeter;
    }
    if (size > 5000.0F && random.chance(0.4F)) {
        return random.chance(0.6F) ? Use::slabs : Use::halls;
    }
    return Use::houses;
}

// By Use.
constexpr std::array builders{build_perimeter, build_downtown, build_houses, build_slabs,
                              build_halls,     build_park,     build_square};

Block block_of(const StreetPlan& plan, const Cell& cell) {
    Block block;
    block.cell = cell;
    block.lot = cell.outline;
    for (std::size_t i = 0; i < cell.outline.size(); ++i) {
        HalfPlane plane = edge_plane(cell.outline, i);
        plane.offset += plan.streets[cell.streets[i]].half_width;
        block.lot = clipped(block.lot, plane);
        block.bounds.add(cell.outline.corners[i], 1.0F);
    }
    return block;
}

// Adds trees and cars along the streets of a cell.
void furnish_streets(const StreetPlan& plan, const Cell& cell, BlockBuilder& builder) {
    for (std::size_t i = 0; i < cell.outline.size(); ++i) {
        const glm::vec2 from = cell.outline.corner(i);
        const glm::vec2 edge = cell.outline.corner(i + 1) - from;
        const glm::vec2 tangent = normalized(edge);
        const Curb curb{plan.streets[cell.streets[i]], from, tangent, turned(tangent),
                        length(edge)};
        park_cars(curb, builder);
        drive_cars(curb, builder);
        plant_street(curb, builder);
        plant_median(curb, builder);
    }
}

} // namespace

std::vector<BlockCopy> copies_in(const CityPlan& city, const Box& box) {
    const float period = city.plan.period;
    const auto first = [&](float from, float to) { return std::ceil((from - to) / period); };
    std::vector<BlockCopy> copies;
    for (const Block& block : city.blocks) {
        const Box& b = block.bounds;
        for (float y = first(box.low.y, b.high.y); b.low.y + y * period <= box.high.y; y += 1.0F) {
            for (float x = first(box.low.x, b.high.x); b.low.x + x * period <= box.high.x;
                 x += 1.0F) {
                copies.push_back({&block, {x * period, y * period}});
            }
        }
    }
    return copies;
}

CityPlan build_city(float period, std::uint32_t seed, unsigned threads) {
    CityPlan city;
    city.plan = plan_streets(period, seed);
    const int count = static_cast<int>(city.plan.cells.size());
    city.blocks.resize(city.plan.cells.size());
    parallel_for(count,
                 [&](int index) {
                     const Cell& cell = city.plan.cells[static_cast<std::size_t>(index)];
                     Block& block = city.blocks[static_cast<std::size_t>(index)];
                     block = block_of(city.plan, cell);
                     BlockBuilder builder(block, material::hash(seed, 21, index));
                     if (!block.lot.empty() && area(block.lot) > 60.0F) {
                         const Use use = use_of(block, index, count, period, seed);
                         builders[static_cast<std::size_t>(use)](builder);
                     }
                     furnish_streets(city.plan, cell, builder);
                 },
                 {threads, {}, {}});
    return city;
}

} // namespace reljef::terrains::urban
