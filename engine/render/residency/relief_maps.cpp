#include "engine/render/residency/relief_maps.h"

#include <algorithm>
#include <bit>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/view/relief_samples.h"

namespace reljef::render {
namespace {

Grid<float> cell_maxima(GridView<const float> heights) {
    const int cols = heights.cols() - 1;
    const int rows = heights.rows() - 1;
    const auto side_for = [](int cells) {
        return static_cast<int>(std::bit_ceil(static_cast<unsigned>(cells)));
    };
    Grid<float> maxima(side_for(cols), side_for(rows), 0.0F);
    for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
            maxima(col, row) = std::max({heights(col, row), heights(col + 1, row),
                                         heights(col, row + 1), heights(col + 1, row + 1)});
        }
    }
    return maxima;
}

Grid<float> halved(const Grid<float>& fine) {
    Grid<float> coarse(std::max(fine.cols() / 2, 1), std::max(fine.rows() / 2, 1));
    for (int row = 0; row < coarse.rows(); ++row) {
        for (int col = 0; col < coarse.cols(); ++col) {
            coarse(col, row) = std::max(
                {fine.clamped(2 * col, 2 * row), fine.clamped(2 * col + 1, 2 * row),
                 fine.clamped(2 * col, 2 * row + 1), fine.clamped(2 * col + 1, 2 * row + 1)});
        }
    }
    return coarse;
}

using Tiles = std::span<const std::shared_ptr<const scene::TerrainTile>>;

// Along a side. A page takes 8 bytes, and a third more for the coarser levels: 11 MB.
constexpr int max_pages = 1024;

// The level of the finest tiles, or a coarser one whose pages are few enough.
int finest_level(const terrain::TileTree& tree, Tiles tiles) {
    int level = tree.root().level;
    for (const auto& tile : tiles) {
        level = std::min(level, tile->id.level);
    }
    const auto longest = [&](int at) {
        const glm::ivec2 pages = terrain::level_tiles(tree, at);
        return std::max(pages.x, pages.y);
    };
    while (longest(level) > max_pages) {
        ++level;
    }
    return level;
}

terrain::MinMax range_of(const scene::TerrainSurface& overview, Tiles tiles) {
    terrain::MinMax range = overview.pyramid().total();
    for (const auto& tile : tiles) {
        range.low = std::min(range.low, static_cast<float>(tile->range.low));
        range.high = std::max(range.high, static_cast<float>(tile->range.high));
    }
    return range;
}

// Local metres of a terrain's samples on a plane, and the samples of its overview. Rows that close
// it or its overview at a pole count like all others, which are between them.
struct SamplePlaces {
    SamplePlaces(const scene::TileBuilder& builder, glm::dvec2 last_sample)
        : exaggeration(builder.overview().placement().exaggeration()) {
        const glm::dvec2 first = 0.25 * last_sample;
        const glm::dvec2 second = last_sample - first;
        const glm::dvec2 first_on_overview = builder.on_overview(first);
        overview_a_sample = (builder.on_overview(second) - first_on_overview) / (second - first);
        overview_origin = first_on_overview - first * overview_a_sample;
        const auto local = [&](glm::dvec2 sample) {
            return glm::dvec2(builder.overview().placement().world_from_sample(
                {builder.on_overview(sample), 0.0}));
        };
        metres_a_sample = (local(second) - local(first)) / (second - first);
        origin = local(first) - first * metres_a_sample;
    }

    [[nodiscard]] glm::dvec2 on_overview(glm::dvec2 sample) const {
        return overview_origin + sample * overview_a_sample;
    }
    [[nodiscard]] glm::dvec2 from_overview(glm::dvec2 sample) const {
        return (sample - overview_origin) / overview_a_sample;
    }

    double exaggeration;
    glm::dvec2 metres_a_sample{1.0};
    glm::dvec2 origin{0.0};
    glm::dvec2 overview_a_sample{1.0};
    glm::dvec2 overview_origin{0.0};
};

} // namespace

ReliefSpace relief_space(const scene::TerrainSurface& surface) {
    const terrain::Placement& placement = surface.placement();
    const Grid<float>& heights = surface.heightfield().heights;
    const terrain::MinMax total = surface.pyramid().total();
    ReliefSpace space;
    space.box.low = glm::dvec3(0.0);
    space.lowest = total.low;
    space.range = total.high > total.low ? static_cast<double>(total.high) - total.low : 1.0;
    space.box.high = {heights.cols() - 1.0, heights.rows() - 1.0, 1.0};
    if (placement.kind() == terrain::PlacementKind::ellipsoid) {
        space.samples_per_unit = {1.0, 1.0, space.range};
        space.sample_of_origin = {0.0, 0.0, space.lowest};
        place_curved_space(space, placement);
        return space;
    }
    place_space(space, [&](glm::dvec3 place) {
        return placement.world_from_sample(
            {place.x, place.y, space.lowest + space.range * place.z});
    });
    return space;
}

glm::dvec2 origin_near(glm::dvec2 eye, glm::dvec2 last,
                       const std::optional<view::RayCourse>& course) {
    return course && course->degrees ? glm::clamp(glm::round(eye), glm::dvec2(0.0), last)
                                     : glm::clamp(glm::floor(eye), glm::dvec2(0.0), last - 1.0);
}

ReliefSpace moved_to(const ReliefSpace& space, glm::dvec2 origin) {
    ReliefSpace moved = space;
    const glm::dvec3 way(origin, 0.0);
    moved.space_of_origin -= way;
    moved.sample_of_origin += way * space.samples_per_unit;
    moved.box.low -= way;
    moved.box.high -= way;
    return moved;
}

void place_curved_space(ReliefSpace& space, const terrain::Placement& placement) {
    const auto sample = [&](glm::dvec3 place) {
        return space.sample_of_origin + place * space.samples_per_unit;
    };
    const glm::dvec3 middle = space.box.center();
    const glm::dvec3 origin = placement.world_from_sample(sample(middle));
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 beside = middle;
        beside[axis] += 1.0;
        space.metres_per_unit[axis] =
            static_cast<float>(glm::distance(placement.world_from_sample(sample(beside)), origin));
    }
    space.box.low.z = -view::relief_margin;
    space.box.high.z = 1.0 + view::relief_margin;
}

void place_space(ReliefSpace& space, const std::function<glm::dvec3(glm::dvec3)>& local) {
    const glm::dvec3 origin = local(glm::dvec3(0.0));
    const glm::dmat3 local_from_space(local({1.0, 0.0, 0.0}) - origin,
                                      local({0.0, 1.0, 0.0}) - origin,
                                      local({0.0, 0.0, 1.0}) - origin);
    space.space_from_local = glm::inverse(local_from_space);
    space.space_of_origin = -(space.space_from_local * origin);
    space.metres_per_unit =
        glm::vec3(glm::length(local_from_space[0]), glm::length(local_from_space[1]),
                  glm::length(local_from_space[2]));
    space.box.low.z = -view::relief_margin;
    space.box.high.z = 1.0 + view::relief_margin;
    space.local_box.add(local(space.box.low));
    space.local_box.add(local(space.box.high));
}

StreamedSpace streamed_space(const scene::TileBuilder& builder, Tiles tiles, glm::dvec3 eye,
                             const std::optional<view::RayCourse>& course) {
    const terrain::TileTree& tree = builder.tree();
    const int samples_in_tree = 1 << builder.level_of_samples(); // of the tree, per sample
    StreamedSpace made;
    made.level = finest_level(tree, tiles);
    made.last_cell = terrain::level_cells(tree, made.level) - 1;
    made.samples_a_cell = static_cast<double>(1 << made.level) / samples_in_tree;
    const glm::dvec2 last_sample =
        glm::dvec2(tree.cols() - 1, tree.rows() - 1) / static_cast<double>(samples_in_tree);
    const SamplePlaces places(builder, last_sample);
    const glm::dvec2 eye_sample = course
                                      ? places.from_overview(glm::dvec2(course->eye))
                                      : (glm::dvec2(eye) - places.origin) / places.metres_a_sample;
    made.origin = glm::ivec2(
        origin_near(eye_sample / made.samples_a_cell, glm::dvec2(made.last_cell) + 1.0, course));
    made.origin_sample = glm::dvec2(made.origin) * made.samples_a_cell;

    ReliefSpace& space = made.space;
    const terrain::MinMax range = range_of(builder.overview(), tiles);
    space.lowest = range.low;
    space.range = range.high > range.low ? static_cast<double>(range.high) - range.low : 1.0;
    space.box.low = glm::dvec3(-glm::dvec2(made.origin), 0.0);
    space.box.high = glm::dvec3(last_sample / made.samples_a_cell - glm::dvec2(made.origin), 1.0);
    if (course) {
        space.samples_per_unit =
            glm::dvec3(made.samples_a_cell * places.overview_a_sample, space.range);
        space.sample_of_origin = glm::dvec3(places.on_overview(made.origin_sample), space.lowest);
        place_curved_space(space, builder.overview().placement());
        return made;
    }
    place_space(space, [&](glm::dvec3 place) {
        const glm::dvec2 sample = made.origin_sample + glm::dvec2(place) * made.samples_a_cell;
        return glm::dvec3(places.origin + sample * places.metres_a_sample,
                          (space.lowest + space.range * place.z) * places.exaggeration);
    });
    return made;
}

Grid<glm::vec2> cone_texels(const material::ConeMaps& cones) {
    Grid<glm::vec2> texels(cones.plain.cols() + 1, cones.plain.rows() + 1);
    for (int row = 0; row < texels.rows(); ++row) {
        for (int col = 0; col < texels.cols(); ++col) {
            texels(col, row) = {cones.plain.clamped(col, row), cones.relaxed.clamped(col, row)};
        }
    }
    return texels;
}

std::vector<Grid<float>> max_mipmap(GridView<const float> relief_heights) {
    std::vector<Grid<float>> levels;
    levels.push_back(cell_maxima(relief_heights));
    while (levels.back().cols() > 1 || levels.back().rows() > 1) {
        levels.push_back(halved(levels.back()));
    }
    return levels;
}

} // namespace reljef::render
