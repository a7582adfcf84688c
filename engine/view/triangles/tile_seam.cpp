#include "engine/view/triangles/tile_seam.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace reljef::view {
namespace {

// Whether a side runs from left to right, seen from outside.
bool runs_right(TileSide side) {
    return side == TileSide::south || side == TileSide::west;
}

glm::dvec3 local_of(const GridVertex& vertex) {
    return glm::dvec3(vertex.position) + glm::dvec3(vertex.rest);
}

bool are_one(const GridVertex& a, const GridVertex& b) {
    return a.position == b.position && a.rest == b.rest;
}

template <class T> T between(T a, T b, double share) {
    return (1.0 - share) * a + share * b;
}

// The edge of a border that contains a place: the number of its first vertex.
std::size_t edge_at(std::span<const BorderVertex> border, double at) {
    const auto after =
        std::upper_bound(border.begin(), border.end(), at,
                         [](double place, const BorderVertex& v) { return place < v.at; });
    const auto found = static_cast<std::size_t>(after - border.begin());
    return std::clamp<std::size_t>(found, 1, border.size() - 1) - 1;
}

double share_of_edge(std::span<const BorderVertex> border, std::size_t edge, double at) {
    const double from = border[edge].at;
    return std::clamp((at - from) / (border[edge + 1].at - from), 0.0, 1.0);
}

double height_at(std::span<const BorderVertex> border, double at) {
    const std::size_t edge = edge_at(border, at);
    return between(static_cast<double>(border[edge].vertex.height),
                   static_cast<double>(border[edge + 1].vertex.height),
                   share_of_edge(border, edge, at));
}

// All places of border vertices of an open side, and its ends.
std::vector<double> places_of(const OpenSide& open, std::span<const BorderVertex> border) {
    std::vector<double> places{open.from};
    for (const BorderVertex& vertex : border) {
        if (vertex.at > open.from && vertex.at < open.to) {
            places.push_back(vertex.at);
        }
    }
    places.push_back(open.to);
    return places;
}

// The places of both borders, and those where they cross.
std::vector<double> joint_places(const OpenSide& open, std::span<const BorderVertex> own,
                                 std::span<const BorderVertex> other) {
    const std::vector<double> a = places_of(open, own);
    const std::vector<double> b = places_of(open, other);
    std::vector<double> ends;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(ends));
    std::vector<double> places;
    double last = 0.0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const double above = height_at(own, ends[i]) - height_at(other, ends[i]);
        if (i > 0 && last * above < 0.0) {
            const double cross = between(ends[i - 1], ends[i], last / (last - above));
            if (cross > ends[i - 1] && cross < ends[i]) {
                places.push_back(cross);
            }
        }
        places.push_back(ends[i]);
        last = above;
    }
    return places;
}

BorderVertex border_vertex(const TileSurface& surface, TileSide side, glm::dvec2 sample,
                           const GridVertex& vertex) {
    const glm::dvec2 place = surface.placement.on_terrain(sample);
    return {runs_along_rows(side) ? place.x : place.y, vertex};
}

// The sides of a tile on which a place lies.
template <class Visit>
void for_each_side(const terrain::TileCells& tile, terrain::Steps place, const Visit& visit) {
    const terrain::Steps first = terrain::steps_of(tile.first);
    const terrain::Steps last = terrain::steps_of(tile.last());
    if (place.y == first.y) {
        visit(TileSide::north);
    }
    if (place.x == last.x) {
        visit(TileSide::east);
    }
    if (place.y == last.y) {
        visit(TileSide::south);
    }
    if (place.x == first.x) {
        visit(TileSide::west);
    }
}

// In order and each once: parts of a mesh repeat vertices.
void put_in_order(TileBorder& border) {
    for (std::vector<BorderVertex>& side : border) {
        std::sort(side.begin(), side.end(),
                  [](const BorderVertex& a, const BorderVertex& b) { return a.at < b.at; });
        const auto repeated =
            std::unique(side.begin(), side.end(),
                        [](const BorderVertex& a, const BorderVertex& b) { return a.at == b.at; });
        side.erase(repeated, side.end());
    }
}

// The sine of the angle between an orthographic view and the vertical of a tile, at least an
// eighth: from above, an error is higher than it is wide.
double sine_of_view(const DrawList& list, const TileDraw& draw) {
    const glm::dvec3 up =
        glm::normalize(glm::dmat3(list.world_from_local(draw)) * glm::dvec3(draw.tile->up));
    return std::max(glm::length(glm::cross(scene::view_axes(list.camera).forward, up)), 1.0 / 8.0);
}

// The largest distance from the eye to a tile, metres.
double farthest(const DrawList& list, const TileDraw& draw) {
    const Box bounds = transformed(list.world_from_local(draw), draw.tile->bounds);
    const glm::dvec3 away =
        glm::max(glm::abs(list.camera.eye - bounds.low), glm::abs(list.camera.eye - bounds.high));
    return glm::length(away);
}

// Errors of an unproven tile: wider gaps beside one were not seen.
constexpr double errors_of_gaps = 16.0;

// Scene metres.
double error_of(const TileDraw& draw) {
    const scene::TerrainTile& tile = *draw.tile;
    return tile.is_proven ? tile.error : errors_of_gaps * tile.error;
}

// Metres along the vertical, at a place in local metres.
double metres_at(const BorderError& error, glm::dvec3 place, glm::dvec3 up) {
    if (error.slope == 0.0) {
        return error.metres;
    }
    constexpr double min_sine = 1.0 / 8.0;
    const glm::dvec3 way = place - error.eye;
    const double distance = glm::length(way);
    const double sine =
        distance > 0.0 ? std::max(glm::length(glm::cross(way, up)) / distance, min_sine) : 1.0;
    return error.metres + error.slope * distance / sine;
}

} // namespace

BorderError border_error(const DrawList& list, const TileDraw& draw) {
    const glm::dvec2 metres(scene::metres_a_pixel(list.camera, list.size));
    const double pixels = std::max(draw.triangle_error, 1.0);
    BorderError error{.metres = error_of(draw) + pixels * metres.x / sine_of_view(list, draw)};
    if (draw.coarse) {
        error.slope = pixels * metres.y;
        error.eye = glm::dvec3(glm::inverse(list.world_from_local(draw)) *
                               glm::dvec4(list.camera.eye, 1.0));
    } else {
        const double size = glm::length(draw.terrain->surface->bounds().size());
        error.metres += pixels * metres.y * farthest(list, draw);
        error.metres = std::exp2(std::ceil(std::log2(std::min(error.metres, size))));
    }
    return error;
}

TileBorder border_of(const TileSurface& surface, const CutMesh& mesh) {
    TileBorder border;
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
        for (std::size_t k = 0; k < mesh.vertices[i].size(); ++k) {
            const terrain::Steps place = mesh.parts[i].vertices[k];
            for_each_side(surface.samples, place, [&](TileSide side) {
                border[static_cast<std::size_t>(side)].push_back(
                    border_vertex(surface, side, terrain::samples_of(place), mesh.vertices[i][k]));
            });
        }
    }
    put_in_order(border);
    return border;
}

TileBorder border_of_samples(const TileSurface& surface) {
    const terrain::TileCells& tile = surface.samples;
    CutMesh mesh;
    terrain::Triangulation& part = mesh.parts.emplace_back();
    for (int col = 0; col <= tile.count.x; ++col) {
        part.vertices.push_back(terrain::steps_of({tile.first.x + col, tile.first.y}));
        part.vertices.push_back(terrain::steps_of({tile.first.x + col, tile.last().y}));
    }
    for (int row = 1; row < tile.count.y; ++row) {
        part.vertices.push_back(terrain::steps_of({tile.first.x, tile.first.y + row}));
        part.vertices.push_back(terrain::steps_of({tile.last().x, tile.first.y + row}));
    }
    mesh.vertices.push_back(VertexPlacer(surface.heightfield, surface.placement, tile).place(part));
    return border_of(surface, mesh);
}

// The points of a border at some places.
struct SeamMaker::Line {
    std::vector<double> places;
    std::vector<GridVertex> points;
};

SeamMaker::Line SeamMaker::line_along(std::span<const BorderVertex> border, TileSide side,
                                      std::span<const double> places) const {
    Line line{{places.begin(), places.end()}, {}};
    for (const double at : places) {
        const std::size_t edge = edge_at(border, at);
        const double share = share_of_edge(border, edge, at);
        const GridVertex& a = border[edge].vertex;
        const GridVertex& b = border[edge + 1].vertex;
        const bool is_vertex = share == 0.0 || share == 1.0;
        const GridVertex point = is_vertex
                                     ? (share == 0.0 ? a : b)
                                     : grid_vertex(between(local_of(a), local_of(b), share),
                                                   between(static_cast<double>(a.height),
                                                           static_cast<double>(b.height), share),
                                                   {});
        line.points.push_back(with_own_place(point, side, at));
    }
    return line;
}

// A neighbour counts its places from its own first sample.
GridVertex SeamMaker::with_own_place(GridVertex vertex, TileSide side, double at) const {
    const terrain::TileCells& tile = surface_.samples;
    const glm::dvec2 first = surface_.placement.on_terrain(glm::dvec2(tile.first));
    const glm::dvec2 extent = surface_.placement.on_terrain(glm::dvec2(tile.last())) - first;
    const int along = runs_along_rows(side) ? 0 : 1;
    const bool is_far = side == TileSide::east || side == TileSide::south;
    glm::dvec2 place(is_far ? extent : glm::dvec2(0.0));
    place[along] = at - first[along];
    vertex.place = glm::vec2(place);
    return vertex;
}

void SeamMaker::join(const OpenSide& open, const TileBorder& neighbour) {
    const auto& own = own_[static_cast<std::size_t>(open.side)];
    const auto& other = neighbour[static_cast<std::size_t>(opposite(open.side))];
    const std::vector<double> places = joint_places(open, own, other);
    const Line own_line = line_along(own, open.side, places);
    const Line other_line = line_along(other, open.side, places);
    add_walls(own_line, other_line, open.side);
    add_flaps(own, own_line, open.side);
    add_flaps(other, other_line, open.side);
}

void SeamMaker::hang(const OpenSide& open, const BorderError& error) {
    const auto& own = own_[static_cast<std::size_t>(open.side)];
    const Line upper = line_along(own, open.side, places_of(open, own));
    Line lower = upper;
    for (GridVertex& point : lower.points) {
        const glm::dvec3 place = local_of(point);
        const glm::dvec3 up = surface_.placement.up(place);
        const double metres = metres_at(error, place, up);
        point = grid_vertex(place - metres * up,
                            static_cast<double>(point.height) -
                                metres / surface_.placement.exaggeration(),
                            glm::dvec2(point.place));
    }
    add_walls(upper, lower, open.side);
    add_flaps(own, upper, open.side);
}

// Walls between two lines, seen from where the lower one is.
void SeamMaker::add_walls(const Line& own, const Line& other, TileSide side) {
    for (std::size_t i = 0; i + 1 < own.points.size(); ++i) {
        const std::size_t left = runs_right(side) ? i : i + 1;
        const std::size_t right = runs_right(side) ? i + 1 : i;
        add_triangle(other.points[left], other.points[right], own.points[right]);
        add_triangle(other.points[left], own.points[right], own.points[left]);
    }
}

// A point between the ends of an edge is rounded, so the walls that end there may leave a gap to
// the tile that has the whole edge. Triangles from both to a point below them fill it: they lie in
// the ground, and are wide enough for a rasterizer to interpolate.
void SeamMaker::add_flaps(std::span<const BorderVertex> border, const Line& line, TileSide side) {
    constexpr double depth_of_length = 1.0 / 64.0;
    const auto add = [&](const BorderVertex& a, std::span<const GridVertex> between,
                         const BorderVertex& b) {
        const GridVertex first = with_own_place(a.vertex, side, a.at);
        const GridVertex last = with_own_place(b.vertex, side, b.at);
        const glm::dvec3 middle = 0.5 * (local_of(first) + local_of(last));
        const double depth = depth_of_length * glm::distance(local_of(first), local_of(last));
        const double height = 0.5 * (static_cast<double>(first.height) + last.height);
        const GridVertex below =
            grid_vertex(middle - depth * surface_.placement.up(middle),
                        height - depth / surface_.placement.exaggeration(),
                        0.5 * (glm::dvec2(first.place) + glm::dvec2(last.place)));
        const auto add_both = [&](const GridVertex& from, const GridVertex& to) {
            add_triangle(from, to, below);
            add_triangle(to, from, below);
        };
        add_both(first, last);
        const GridVertex* before = &first;
        for (const GridVertex& point : between) {
            add_both(*before, point);
            before = &point;
        }
        add_both(*before, last);
    };
    std::size_t i = 0;
    for (std::size_t edge = 0; edge + 1 < border.size(); ++edge) {
        while (i < line.places.size() && line.places[i] <= border[edge].at) {
            ++i;
        }
        const std::size_t begin = i;
        while (i < line.places.size() && line.places[i] < border[edge + 1].at) {
            ++i;
        }
        if (i > begin) {
            add(border[edge], std::span(line.points).subspan(begin, i - begin), border[edge + 1]);
        }
    }
}

void SeamMaker::add_triangle(const GridVertex& a, const GridVertex& b, const GridVertex& c) {
    if (are_one(a, b) || are_one(b, c) || are_one(c, a)) {
        return;
    }
    constexpr std::size_t max_vertices = std::numeric_limits<std::uint16_t>::max() - 3;
    if (parts_.empty() || parts_.back().vertices.size() > max_vertices) {
        parts_.emplace_back();
    }
    SeamPart& part = parts_.back();
    for (const GridVertex* const corner : {&a, &b, &c}) {
        part.indices.push_back(static_cast<std::uint16_t>(part.vertices.size()));
        part.vertices.push_back(*corner);
    }
}

} // namespace reljef::view
