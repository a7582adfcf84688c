#include "engine/render/residency/relief_maps.h"

#include <algorithm>
#include <bit>

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
