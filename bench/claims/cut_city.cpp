#include "bench/claims/cut_city.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "terrains/generators.h"

namespace reljef::bench {
namespace {

constexpr Rgba8 meadow{104, 118, 74, 255};

Result<terrain::Terrain> urban_of(int size, bool is_tileable, unsigned threads) {
    return terrains::generate_urban({.size = size,
                                     .tileable = is_tileable,
                                     .walls = building::CityWalls::stepped,
                                     .threads = threads});
}

std::uint8_t mean_of(int a, int b, int c, int d) {
    return static_cast<std::uint8_t>((a + b + c + d + 2) / 4);
}

// One colour for each cell, the mean of its corners: a picture reaches from edge sample to edge
// sample, so that those of pieces are parts of that of the whole.
Image colors_of_cells(const Image& samples) {
    Image cells(samples.cols() - 1, samples.rows() - 1);
    for (int row = 0; row < cells.rows(); ++row) {
        for (int col = 0; col < cells.cols(); ++col) {
            const Rgba8& a = samples(col, row);
            const Rgba8& b = samples(col + 1, row);
            const Rgba8& c = samples(col, row + 1);
            const Rgba8& d = samples(col + 1, row + 1);
            cells(col, row) = {mean_of(a.r, b.r, c.r, d.r), mean_of(a.g, b.g, c.g, d.g),
                               mean_of(a.b, b.b, c.b, d.b), 255};
        }
    }
    return cells;
}

// Heights and colours of samples.
struct Samples {
    Grid<float> heights;
    Image colors;

    Samples(int side, float height, Rgba8 color)
        : heights(side, side, height), colors(side, side, color) {}
};

Samples wrapped(const terrain::Terrain& tile, int side) {
    Samples samples(side, 0.0F, {});
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            const int c = col % tile.heightfield.heights.cols();
            const int r = row % tile.heightfield.heights.rows();
            samples.heights(col, row) = tile.heightfield.heights(c, r);
            samples.colors(col, row) = tile.color(c, r);
        }
    }
    return samples;
}

Samples part_of(const Samples& whole, glm::ivec2 begin, int side) {
    Samples part(side, 0.0F, {});
    for (int row = 0; row < side; ++row) {
        for (int col = 0; col < side; ++col) {
            part.heights(col, row) = whole.heights(begin.x + col, begin.y + row);
            part.colors(col, row) = whole.colors(begin.x + col, begin.y + row);
        }
    }
    return part;
}

Result<std::shared_ptr<const scene::TerrainSurface>> surface_of(Samples samples,
                                                                glm::dvec2 spacing) {
    terrain::Terrain terrain;
    terrain.name = "city";
    terrain.color = colors_of_cells(samples.colors);
    terrain.heightfield.heights = std::move(samples.heights);
    terrain.heightfield.spacing = spacing;
    terrain.heightfield.range = terrain::height_range(terrain.heightfield.heights, {});
    auto surface =
        scene::TerrainSurface::create(std::make_shared<const terrain::Terrain>(std::move(terrain)),
                                      {.placement = terrain::PlacementKind::plane});
    if (!surface) {
        return surface.error();
    }
    return std::make_shared<const scene::TerrainSurface>(std::move(*surface));
}

bool is_level(const Grid<float>& heights) {
    const auto samples = heights.samples();
    return std::all_of(samples.begin(), samples.end(),
                       [&](float height) { return height == samples.front(); });
}

// Cuts a terrain of `pieces` × `pieces` pieces; those of one height share a surface.
Result<void> cut(CutCity& city, const Samples& whole, const LoneCityOptions& options) {
    std::shared_ptr<const scene::TerrainSurface> level;
    for (int row = 0; row < options.pieces; ++row) {
        for (int col = 0; col < options.pieces; ++col) {
            const glm::ivec2 begin(col * options.piece, row * options.piece);
            Samples part = part_of(whole, begin, options.piece + 1);
            const bool has_buildings = !is_level(part.heights);
            if (!has_buildings && level != nullptr) {
                city.pieces.push_back({level, begin, false});
                continue;
            }
            auto surface = surface_of(std::move(part), city.whole.surface->heightfield().spacing);
            if (!surface) {
                return surface.error();
            }
            level = has_buildings ? level : *surface;
            city.pieces.push_back({*surface, begin, has_buildings});
        }
    }
    return {};
}

glm::dvec3 place_of(const CutCity& city, const CityPiece& piece) {
    const Grid<float>& heights = piece.surface->heightfield().heights;
    const glm::dvec2 middle =
        glm::dvec2(piece.begin) + 0.5 * glm::dvec2(heights.cols() - 1, heights.rows() - 1);
    return city.whole.surface->placement().world_from_sample(glm::dvec3(middle, 0.0));
}

// The hit as one on the whole, by the piece that puts it nearest to a sample of the whole.
Hit nearest_hit(const Hit& hit, const std::vector<CityPiece>& pieces, glm::dvec2 sample) {
    Hit moved = hit;
    double nearest = std::numeric_limits<double>::infinity();
    for (const CityPiece& piece : pieces) {
        const glm::dvec2 place = hit.place() + glm::dvec2(piece.begin);
        const double distance = glm::distance(place, sample);
        if (distance < nearest) {
            nearest = distance;
            moved = hit_at(place, static_cast<double>(hit.height), static_cast<double>(hit.depth));
        }
    }
    return moved;
}

} // namespace

Result<CutCity> repeated_city(int tile, int copies, unsigned threads) {
    if (copies < 1) {
        return Error{fmt::format("{} copies of a tile found, one at least was expected", copies)};
    }
    const auto urban = urban_of(tile, true, threads);
    if (!urban) {
        return urban.error();
    }
    const glm::dvec2 spacing = urban->heightfield.spacing;
    auto whole = surface_of(wrapped(*urban, tile * copies + 1), spacing);
    auto piece = surface_of(wrapped(*urban, tile + 1), spacing);
    if (!whole || !piece) {
        return whole ? piece.error() : whole.error();
    }
    CutCity city;
    city.name = fmt::format("{0} × {0} tiles of {1} cells", copies, tile);
    city.whole = {*whole};
    for (int row = 0; row < copies; ++row) {
        for (int col = 0; col < copies; ++col) {
            city.pieces.push_back({*piece, glm::ivec2(col, row) * tile});
        }
    }
    return city;
}

Result<CutCity> lone_city(const LoneCityOptions& options) {
    if (options.city < 1 || options.city >= options.pieces) {
        return Error{fmt::format("a city of {} of {} pieces a side found, fewer were expected",
                                 options.city, options.pieces)};
    }
    const auto urban = urban_of(options.city * options.piece - 1, false, options.threads);
    if (!urban) {
        return urban.error();
    }
    Samples samples(options.pieces * options.piece + 1, 0.0F, meadow);
    const int begin = (options.pieces - options.city) / 2 * options.piece + 1;
    const Grid<float>& heights = urban->heightfield.heights;
    for (int row = 0; row < heights.rows(); ++row) {
        for (int col = 0; col < heights.cols(); ++col) {
            samples.heights(begin + col, begin + row) = heights(col, row);
            samples.colors(begin + col, begin + row) = urban->color(col, row);
        }
    }
    CutCity city;
    city.name = fmt::format("{0} × {0} pieces of {1} cells, {2} × {2} with buildings",
                            options.pieces, options.piece, options.city);
    auto whole = surface_of(samples, urban->heightfield.spacing);
    if (!whole) {
        return whole.error();
    }
    city.whole = {*whole};
    if (auto done = cut(city, samples, options); !done) {
        return done.error();
    }
    return city;
}

scene::Scene scene_of_pieces(const CutCity& city, const std::vector<CityPiece>& pieces,
                             const PieceTechniques& techniques, const scene::Camera& camera) {
    scene::Scene scene;
    for (const CityPiece& piece : pieces) {
        scene::Material material;
        material.technique = piece.has_buildings ? techniques.buildings : techniques.level;
        scene::Node& node = scene.root().add("piece", scene::TerrainNode{piece.surface, material});
        node.set_position(place_of(city, piece));
    }
    scene.add_light({});
    scene.add_camera(camera);
    return scene;
}

HitBuffer hits_on_whole(const CutCity& city, const std::vector<CityPiece>& pieces,
                        const scene::Camera& camera, const HitBuffer& hits) {
    const glm::ivec2 size(hits.cols(), hits.rows());
    HitBuffer moved = hits;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const Hit& hit = hits(x, y);
            if (hit.is_sky()) {
                continue;
            }
            const Ray ray = scene::view_ray(camera, size, glm::dvec2(x, y) + 0.5);
            const auto seen = city.whole.surface->placement().sample_from_world(ray.at(hit.depth));
            moved(x, y) = seen ? nearest_hit(hit, pieces, glm::dvec2(*seen)) : hit;
        }
    }
    return moved;
}

} // namespace reljef::bench
