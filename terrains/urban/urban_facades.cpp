#include "terrains/urban/urban_facades.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/building/building_faces.h"

namespace reljef::terrains::urban {
namespace {

constexpr double longest_part = 6.0; // metres: streets curve, walls do not
constexpr double reach = 2.25;       // samples from a wall: its slope, and the cells beside it
constexpr double on_slope = 1.0;     // samples from a wall
constexpr double same_height = 0.5;  // metres

Rgba8 plaster_of(const Building& building) {
    constexpr std::array plasters{Rgba8{206, 198, 184, 255}, Rgba8{199, 184, 158, 255},
                                  Rgba8{190, 186, 180, 255}, Rgba8{214, 204, 178, 255},
                                  Rgba8{188, 164, 140, 255}, Rgba8{176, 178, 176, 255},
                                  Rgba8{205, 186, 172, 255}};
    return plasters.at(material::hash(building.seed, 5, 5) % plasters.size());
}

// Marks the samples near walls.
class FacadePainter {
public:
    FacadePainter(const Raster& raster, GridView<const float> heights,
                  const Grid<std::uint8_t>& planted)
        : raster_(raster), heights_(heights), planted_(planted),
          away_(raster.size, raster.size, reach) {
        facades_.wall_at = Grid<std::uint32_t>(raster.size, raster.size);
    }

    void add(const terrain::Facade& wall) {
        const glm::dvec2 low = glm::max(glm::min(wall.begin, wall.end) - reach, 0.0);
        const glm::dvec2 high =
            glm::min(glm::max(wall.begin, wall.end) + reach, raster_.size - 1.0);
        const auto number = static_cast<std::uint32_t>(facades_.walls.size() + 1);
        bool is_seen = false;
        for (int row = static_cast<int>(std::ceil(low.y)); row <= high.y; ++row) {
            for (int col = static_cast<int>(std::ceil(low.x)); col <= high.x; ++col) {
                is_seen = mark({col, row}, wall, number) || is_seen;
            }
        }
        if (is_seen) {
            facades_.walls.push_back(wall);
        }
    }

    terrain::Facades take() { return std::move(facades_); }

private:
    // The higher of two walls stands behind the lower one, or on it.
    bool mark(glm::ivec2 at, const terrain::Facade& wall, std::uint32_t number) {
        const double away = distance(glm::dvec2(at), wall);
        std::uint32_t& nearest = facades_.wall_at(at.x, at.y);
        const double top = wall.foot + wall.eaves + wall.rise;
        const bool is_under_roof = heights_(at.x, at.y) > top + above_eaves_;
        const bool is_before_wall = planted_(at.x, at.y) != 0 && away >= on_slope;
        if (!(away < reach) || is_before_wall || is_under_roof) {
            return false;
        }
        if (nearest != 0 && nearest != number) {
            const double higher = wall.eaves - facades_.walls[nearest - 1].eaves;
            const bool is_closer = away < away_(at.x, at.y);
            if (std::abs(higher) <= same_height ? !is_closer : higher < 0.0) {
                return false;
            }
        }
        nearest = number;
        away_(at.x, at.y) = away;
        return true;
    }

    static double distance(glm::dvec2 at, const terrain::Facade& wall) {
        const glm::dvec2 way = wall.end - wall.begin;
        const double part = glm::dot(at - wall.begin, way) / glm::dot(way, way);
        return glm::distance(at, wall.begin + glm::clamp(part, 0.0, 1.0) * way);
    }

    const Raster& raster_;
    GridView<const float> heights_;
    const Grid<std::uint8_t>& planted_;
    double above_eaves_ = same_height + reach * raster_.spacing; // of roofs near walls, metres
    terrain::Facades facades_;
    Grid<double> away_; // samples
};

// The way along a wall, city metres.
struct Edge {
    glm::vec2 from;
    glm::vec2 to;      // the building lies on the right, for y that grows south
    double rise = 0.0; // above the eaves, metres
};

// A wall of a building, cut into parts that follow the street.
void add_edge(const Building& building, const Edge& edge, const CityPlan& city,
              const Raster& raster, FacadePainter& painter) {
    const glm::vec2 way = edge.to - edge.from;
    const double metres = length(way);
    if (metres < 0.5 * raster.spacing_in_metres) {
        return;
    }
    const double windows = std::max(1.0, std::round(metres / building::window_bay));
    const int parts = std::max(1, static_cast<int>(std::ceil(metres / longest_part)));
    const auto sample_at = [&](int part) {
        const glm::vec2 place =
            edge.from + way * (static_cast<float>(part) / static_cast<float>(parts));
        const glm::vec2 ground = city.plan.warp.ground_from_city(place) - raster.origin;
        return glm::dvec2(ground) / static_cast<double>(raster.spacing);
    };
    for (int part = 0; part < parts; ++part) {
        painter.add({.begin = sample_at(part),
                     .end = sample_at(part + 1),
                     .windows = windows * glm::dvec2(part, part + 1) / static_cast<double>(parts),
                     .foot = 0.0,
                     .eaves = building.eaves,
                     .storeys = std::max(1.0, std::round(building.eaves / building::window_storey)),
                     .rise = edge.rise,
                     .plaster = plaster_of(building)});
    }
}

// The highest place of the roof over a wall, metres above the eaves.
double rise_of(const Building& building, glm::vec2 from, glm::vec2 to) {
    constexpr int steps = 32;
    float rise = building.parapet;
    for (int i = 0; i <= steps && building.sloped != 0U; ++i) {
        const glm::vec2 place = glm::mix(from, to, static_cast<float>(i) / steps);
        float run = std::numeric_limits<float>::max();
        for (std::size_t k = 0; k < building.shape.planes.size(); ++k) {
            const bool is_sloped = (building.sloped >> std::min<std::size_t>(k, 31U) & 1U) != 0U;
            run = is_sloped ? std::min(run, building.shape.planes[k].distance(place)) : run;
        }
        rise = std::max(rise, std::min(building.slope * run, building.rise_limit));
    }
    return rise;
}

// The outer walls, and those of wells in the roof.
std::vector<Edge> edges_of(const Building& building, const Block& block, glm::vec2 shift) {
    std::vector<Edge> edges;
    const Convex& outline = building.outline;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const glm::vec2 from = outline.corner(i);
        const glm::vec2 to = outline.corner(i + 1);
        edges.push_back({from + shift, to + shift, rise_of(building, from, to)});
    }
    for (const Prism& prism : block.prisms) {
        if (prism.kind == PrismKind::well && prism.top < building.eaves &&
            building.shape.distance(prism.frame.center) > 0.0F) {
            const Convex well = rectangle(prism.frame);
            for (std::size_t i = 0; i < well.size(); ++i) {
                edges.push_back({well.corner(i + 1) + shift, well.corner(i) + shift, 0.0});
            }
        }
    }
    return edges;
}

} // namespace

terrain::Facades facades_of(const CityPlan& city, const Raster& raster,
                            GridView<const float> heights, const Grid<std::uint8_t>& planted) {
    FacadePainter painter(raster, heights, planted);
    for (const BlockCopy& copy : copies_in(city, city_bounds(raster, city.plan.warp))) {
        for (const Building& building : copy.block->buildings) {
            for (const Edge& edge : edges_of(building, *copy.block, copy.shift)) {
                add_edge(building, edge, city, raster, painter);
            }
        }
    }
    return painter.take();
}

} // namespace reljef::terrains::urban
