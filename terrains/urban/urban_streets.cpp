#include "terrains/urban/urban_streets.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace reljef::terrains::urban {
namespace {

struct Planner {
    StreetPlan plan;
    Random random;
    float scale = 1.0F; ///< of street widths; below 1 in tiny cities

    explicit Planner(std::uint32_t seed) : random(seed) {}
};

Street street_of(StreetKind kind, Planner& planner) {
    constexpr std::array<float, 5> half{6.2F, 8.4F, 10.8F, 14.5F, 24.0F};
    constexpr std::array<float, 5> sidewalk{2.4F, 3.2F, 3.9F, 4.6F, 4.0F};
    const auto k = static_cast<std::size_t>(kind);
    Street street;
    street.kind = kind;
    street.half_width = (half[k] + planner.random.range(0.0F, 0.8F)) * planner.scale;
    street.sidewalk = sidewalk[k] * planner.scale;
    street.seed = planner.random.bits();
    return street;
}

std::size_t add_street(Planner& planner, Street street, const HalfPlane& middle) {
    street.tangent = {middle.normal.y, -middle.normal.x};
    street.origin = middle.normal * middle.offset;
    planner.plan.streets.push_back(std::move(street));
    return planner.plan.streets.size() - 1;
}

// The part of a cell on the inner side of a street's middle.
Cell cut(const Cell& cell, const HalfPlane& keep, std::size_t street) {
    Cell kept;
    for (std::size_t i = 0; i < cell.outline.size(); ++i) {
        const glm::vec2 a = cell.outline.corners[i];
        const glm::vec2 b = cell.outline.corner(i + 1);
        const float from = keep.distance(a);
        const float to = keep.distance(b);
        if (from >= 0.0F) {
            kept.outline.corners.push_back(a);
            kept.streets.push_back(cell.streets[i]);
        }
        if ((from >= 0.0F) != (to >= 0.0F)) {
            kept.outline.corners.push_back(a + (b - a) * (from / (from - to)));
            kept.streets.push_back(from >= 0.0F ? street : cell.streets[i]);
        }
    }
    return kept;
}

StreetKind kind_for(float length) {
    if (length > 330.0F) {
        return StreetKind::avenue;
    }
    return length > 150.0F ? StreetKind::street : StreetKind::lane;
}

// A line across `frame.axis` with a random offset and angle.
HalfPlane cutting_line(const Frame& frame, Planner& planner) {
    Random& random = planner.random;
    const bool diagonal = frame.half.y > 100.0F && random.chance(0.22F);
    const float tilt = diagonal ? (random.chance(0.5F) ? 0.6F : -0.6F) : 0.09F * random.bell();
    const glm::vec2 normal = normalized(frame.axis + turned(frame.axis) * tilt);
    const float place = frame.half.x * 0.24F * random.bell();
    return {normal, dot(normal, frame.at(place, 0.0F))};
}

bool good_piece(const Planner& planner, const Cell& cell) {
    if (cell.outline.empty()) {
        return false;
    }
    float widest = 0.0F;
    for (const std::size_t street : cell.streets) {
        widest = std::max(widest, planner.plan.streets[street].half_width);
    }
    return !inset(cell.outline, widest + 9.0F * planner.scale).empty();
}

// The pieces of `cells` on both sides of a new street; none if a piece would be too thin.
std::vector<Cell> divided(Planner& planner, const std::vector<Cell>& cells, const HalfPlane& line,
                          StreetKind kind) {
    const std::size_t street = add_street(planner, street_of(kind, planner), line);
    std::vector<Cell> pieces;
    for (const Cell& cell : cells) {
        pieces.push_back(cut(cell, line, street));
        pieces.push_back(cut(cell, line.flipped(), street));
    }
    const bool good = std::all_of(pieces.begin(), pieces.end(),
                                  [&](const Cell& piece) { return good_piece(planner, piece); });
    if (!good) {
        planner.plan.streets.pop_back();
        pieces.clear();
    }
    return pieces;
}

bool is_block(const Frame& frame, Random& random) {
    const float longest = 2.0F * frame.half.x;
    const float limit = random.chance(0.12F) ? 185.0F : random.range(92.0F, 150.0F);
    return longest < limit && (frame.half.y < 48.0F || random.chance(0.2F));
}

std::vector<Cell> pieces_of(Planner& planner, const Cell& cell, const Frame& frame) {
    const float length = 2.0F * frame.half.x;
    std::vector<Cell> halves =
        divided(planner, {cell}, cutting_line(frame, planner), kind_for(length));
    if (halves.empty() || frame.half.y < 78.0F || planner.random.chance(0.35F)) {
        return halves;
    }
    const Frame across{frame.center, turned(frame.axis), {frame.half.y, frame.half.x}};
    std::vector<Cell> quarters =
        divided(planner, halves, cutting_line(across, planner), kind_for(2.0F * frame.half.y));
    return quarters.empty() ? halves : quarters;
}

void subdivide(Planner& planner, Cell domain) {
    std::vector<Cell> open{std::move(domain)};
    while (!open.empty()) {
        const Cell cell = std::move(open.back());
        open.pop_back();
        const Frame frame = frame_of(cell.outline).lengthwise();
        std::vector<Cell> pieces;
        if (!is_block(frame, planner.random)) {
            pieces = pieces_of(planner, cell, frame);
        }
        if (pieces.empty()) {
            planner.plan.cells.push_back(cell);
        }
        open.insert(open.end(), pieces.begin(), pieces.end());
    }
}

// The cells between north-south boulevards and the west-east street or river at the seam.
std::vector<Cell> columns(Planner& planner) {
    const float period = planner.plan.period;
    const bool large = period > 420.0F;
    const int count = std::max(1, static_cast<int>(std::lround(period / 560.0F)));
    Street border = street_of(large ? StreetKind::river : StreetKind::avenue, planner);
    if (large) {
        border.water = period > 900.0F ? 21.0F : 7.5F;
        border.half_width = border.water + 17.0F;
    }
    const std::size_t south = add_street(planner, border, {{0.0F, 1.0F}, 0.0F});
    std::vector<float> places;
    std::vector<std::size_t> uprights;
    for (int i = 0; i < count; ++i) {
        const float jitter = i == 0 ? 0.0F : 0.12F * planner.random.bell();
        places.push_back((static_cast<float>(i) + jitter) * period / static_cast<float>(count));
        const StreetKind kind = large && i == 0 ? StreetKind::boulevard : StreetKind::avenue;
        uprights.push_back(add_street(planner, street_of(kind, planner), {{-1.0F, 0.0F}, 0.0F}));
        planner.plan.streets.back().origin = {places.back(), 0.0F};
    }
    places.push_back(period);
    uprights.push_back(uprights.front());
    std::vector<Cell> cells;
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        const float x0 = places[i];
        const float x1 = places[i + 1];
        cells.push_back({{{{x0, 0.0F}, {x1, 0.0F}, {x1, period}, {x0, period}}},
                         {south, uprights[i + 1], south, uprights[i]}});
    }
    return cells;
}

void add_junction(Street& street, const Street& other, glm::vec2 place) {
    const float sine = std::abs(dot(turned(street.tangent), other.tangent));
    if (sine < 0.2F) {
        return;
    }
    const float at = street.along(place);
    const bool known = std::any_of(street.junctions.begin(), street.junctions.end(),
                                   [&](const Junction& j) { return std::abs(j.at - at) < 2.0F; });
    if (!known) {
        const bool crossing =
            street.kind != StreetKind::lane &&
            material::hash(street.seed, 5, static_cast<std::int32_t>(at)) % 8U != 0;
        street.junctions.push_back({at, other.roadway() / sine, crossing});
    }
}

void find_junctions(StreetPlan& plan) {
    for (const Cell& cell : plan.cells) {
        const std::size_t count = cell.outline.size();
        for (std::size_t i = 0; i < count; ++i) {
            Street& a = plan.streets[cell.streets[i]];
            Street& b = plan.streets[cell.streets[(i + 1) % count]];
            const glm::vec2 place = cell.outline.corner(i + 1);
            add_junction(a, b, place);
            add_junction(b, a, place);
        }
    }
    for (Street& street : plan.streets) {
        std::sort(street.junctions.begin(), street.junctions.end(),
                  [](const Junction& a, const Junction& b) { return a.at < b.at; });
    }
}

// Two parabolas instead of a sine: they give the same bits on every machine.
float wave(float turns) {
    const float s = 2.0F * fract(turns) - 1.0F;
    return 4.0F * s * (1.0F - std::abs(s));
}

} // namespace

Warp::Warp(float period, std::uint32_t seed) {
    Random random(seed);
    constexpr float strain_each = 0.026F;
    for (int i = 0; i < 5; ++i) {
        const float longest = std::max(1.0F, period / random.range(230.0F, 640.0F));
        const auto turn = [&] {
            return std::floor((2.0F * random.unit() - 1.0F) * longest + 0.5F);
        };
        glm::vec2 turns{turn(), turn()};
        turns = turns == glm::vec2{0.0F, 0.0F} ? glm::vec2{1.0F, 0.0F} : turns;
        turns = turns * (1.0F / period);
        const glm::vec2 direction =
            normalized({2.0F * random.unit() - 1.0F, 2.0F * random.unit() - 1.0F});
        waves_.push_back(
            {turns, direction * (strain_each / (4.0F * length(turns))), random.unit()});
    }
}

glm::vec2 Warp::city_from_ground(glm::vec2 ground) const {
    glm::vec2 city = ground;
    for (const Wave& w : waves_) {
        city += w.amplitude * wave(dot(w.turns, ground) + w.phase);
    }
    return city;
}

glm::vec2 Warp::ground_from_city(glm::vec2 city) const {
    glm::vec2 ground = city;
    for (int i = 0; i < 6; ++i) {
        ground += city - city_from_ground(ground);
    }
    return ground;
}

StreetPlan plan_streets(float period, std::uint32_t seed) {
    Planner planner(material::hash(seed, 11, 0));
    planner.plan.period = period;
    planner.scale = std::min(1.0F, period / 120.0F);
    planner.plan.warp = Warp(period, material::hash(seed, 12, 0));
    for (Cell& cell : columns(planner)) {
        subdivide(planner, std::move(cell));
    }
    find_junctions(planner.plan);
    return std::move(planner.plan);
}

} // namespace reljef::terrains::urban
