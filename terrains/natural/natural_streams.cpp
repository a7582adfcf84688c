#include "terrains/natural/natural_land.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "engine/material/noise.h"

namespace reljef::terrains::natural {
namespace {

constexpr float min_catchment = 0.7F; // km² above which a stream is drawn

/// A point of a stream. The points downstream of it come first.
struct Point {
    glm::vec2 place{0.0F};       // col, row
    std::int32_t next = no_cell; // downstream
    std::int32_t back = no_cell; // upstream, along the largest donor
    float half_width = 0.0F;     // cells
    float level = 0.0F;          // of the water, metres
};

float width_of(float square_kilometres) {
    return 0.14F + 0.085F * std::sqrt(square_kilometres);
}

std::vector<Point> points_of(const Land& land) {
    const Drainage& drainage = land.drainage;
    std::vector<std::int32_t> point_of_cell(drainage.receiver.size(), no_cell);
    std::vector<Point> points;
    const int cols = land.heights.cols();
    for (const std::int32_t cell : drainage.order) {
        const float upstream = catchment(drainage, cell_index(cell));
        if (upstream < min_catchment) {
            continue;
        }
        const std::int32_t receiver = drainage.receiver[cell_index(cell)];
        Point point;
        point.place = glm::vec2(place_of(cell, cols));
        point.half_width = width_of(upstream);
        point.next = receiver == cell ? no_cell : point_of_cell[cell_index(receiver)];
        const auto index = static_cast<std::int32_t>(points.size());
        if (point.next != no_cell) {
            Point& next = points[cell_index(point.next)];
            if (next.back == no_cell ||
                points[cell_index(next.back)].half_width < point.half_width) {
                next.back = index;
            }
        }
        point_of_cell[cell_index(cell)] = index;
        points.push_back(point);
    }
    return points;
}

void smooth(std::vector<Point>& points, int passes) {
    for (int pass = 0; pass < passes; ++pass) {
        const std::vector<Point> before = points;
        for (Point& point : points) {
            if (point.next != no_cell && point.back != no_cell) {
                point.place = 0.5F * point.place + 0.25F * (before[cell_index(point.next)].place +
                                                            before[cell_index(point.back)].place);
            }
        }
    }
}

void meander(std::vector<Point>& points, const LandOptions& options) {
    const float last = static_cast<float>(options.size - 1);
    for (Point& point : points) {
        const float swing = 6.5F * smoothstep(0.3F, 1.1F, point.half_width);
        const glm::vec2 from = point.place / 12.0F;
        point.place += swing * glm::vec2{material::gradient_noise(options.seed + 61, from),
                                         material::gradient_noise(options.seed + 62, from)};
        point.place = glm::clamp(point.place, 0.0F, last);
    }
}

void find_levels(std::vector<Point>& points, const Land& land) {
    constexpr float min_fall = 0.01F;
    for (Point& point : points) {
        const int col = static_cast<int>(std::lround(point.place.x));
        const int row = static_cast<int>(std::lround(point.place.y));
        const float bed = land.heights(col, row) - 1.0F - 1.5F * std::min(point.half_width, 1.5F);
        point.level = point.next == no_cell
                          ? bed
                          : std::max(bed, points[cell_index(point.next)].level + min_fall);
    }
}

/// A piece of a stream between two points.
struct Stretch {
    Point from;
    Point to;
    std::uint32_t seed;

    void draw(Land& land, int col, int row) const {
        const glm::vec2 place(col, row);
        const glm::vec2 along = to.place - from.place;
        const float length2 = glm::dot(along, along);
        const float part =
            length2 > 0.0F ? std::clamp(glm::dot(place - from.place, along) / length2, 0.0F, 1.0F)
                           : 0.0F;
        const float distance = glm::length(place - (from.place + part * along));
        const float width = std::lerp(from.half_width, to.half_width, part);
        const float random = material::gradient_noise(seed, place / 6.0F) + 0.35F;
        const float bank = width + smoothstep(0.35F, 1.0F, width) * 1.8F * std::max(random, 0.0F);
        const auto cover = [&](float half) {
            return std::clamp(half + 0.5F - distance, 0.0F, 1.0F) * std::min(1.0F, 2.0F * half);
        };
        land.water(col, row) = std::max(land.water(col, row), cover(width));
        land.gravel(col, row) = std::max(land.gravel(col, row), cover(bank));
        const float rim = std::lerp(from.level, to.level, part) +
                          design_spacing * 0.25F * std::max(distance - width - 0.5F, 0.0F);
        if (land.lake(col, row) == 0 && distance < width + 1.5F) {
            land.heights(col, row) = std::min(land.heights(col, row), rim);
        }
    }
};

void draw(Land& land, const Stretch& stretch) {
    const float reach = 3.5F + 2.0F * stretch.to.half_width;
    const glm::ivec2 low(glm::min(stretch.from.place, stretch.to.place) - reach);
    const glm::ivec2 high(glm::max(stretch.from.place, stretch.to.place) + reach);
    const int last = land.heights.cols() - 1;
    for (int row = std::max(0, low.y); row <= std::min(last, high.y); ++row) {
        for (int col = std::max(0, low.x); col <= std::min(last, high.x); ++col) {
            stretch.draw(land, col, row);
        }
    }
}

} // namespace

void draw_streams(Land& land, const LandOptions& options) {
    land.water = Grid<float>(land.heights.cols(), land.heights.rows());
    land.gravel = Grid<float>(land.heights.cols(), land.heights.rows());
    std::vector<Point> points = points_of(land);
    smooth(points, 4);
    meander(points, options);
    smooth(points, 5);
    find_levels(points, land);
    for (const Point& point : points) {
        if (point.next != no_cell) {
            draw(land, {point, points[cell_index(point.next)], options.seed + 63});
        }
    }
    for (std::size_t cell = 0; cell < land.lake.size(); ++cell) {
        if (land.lake.samples()[cell] != 0) {
            land.water.samples()[cell] = 1.0F;
        }
    }
}

} // namespace reljef::terrains::natural
