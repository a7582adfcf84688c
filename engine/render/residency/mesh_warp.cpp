#include "engine/render/residency/mesh_warp.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/core/parallel_for.h"
#include "engine/render/residency/prewarp.h"

namespace reljef::render {
namespace {

struct WarpGrid {
    glm::ivec2 count{1};
    glm::dvec2 low{0.0};
    glm::dvec2 size{1.0};

    [[nodiscard]] glm::dvec2 coordinate(glm::dvec2 place) const {
        return low + (place + 0.5) / glm::dvec2(count) * size;
    }
    [[nodiscard]] glm::dvec2 place(glm::dvec2 coordinate) const {
        return (coordinate - low) / size * glm::dvec2(count) - 0.5;
    }
};

WarpGrid warp_grid(const scene::TexturePlane& plane, const scene::SurfaceDetail& detail) {
    const Grid<float>& heights = detail.set->heights;
    const glm::dvec2 size = plane.high - plane.low;
    const glm::dvec2 texels =
        size * glm::dvec2(detail.repeats) * glm::dvec2(heights.cols(), heights.rows());
    const double share = std::min(std::sqrt(max_warp_samples / (texels.x * texels.y)), 1.0);
    const glm::dvec2 count = glm::clamp(glm::floor(texels * share), 2.0, 16384.0);
    return {glm::ivec2(count), plane.low, size};
}

Grid<float> heights_above(const WarpGrid& grid, const scene::SurfaceDetail& detail) {
    Grid<float> above(grid.count.x, grid.count.y);
    parallel_for(grid.count.y, [&](int row) {
        for (int col = 0; col < above.cols(); ++col) {
            const glm::dvec2 tile =
                grid.coordinate(glm::dvec2(col, row)) * glm::dvec2(detail.repeats);
            above(col, row) =
                static_cast<float>(scene::tile_height(*detail.set, tile, detail.border)) +
                detail.offset;
        }
    });
    return above;
}

glm::dvec4 eye_on_grid(const WarpGrid& grid, const scene::TexturePlane& plane, double lift,
                       glm::dvec4 local_eye) {
    const glm::dmat3 local_from_plane(plane.along_u, plane.along_v, lift * plane.normal);
    const bool is_near = local_eye.w > 0.0;
    const glm::dvec3 offset = glm::dvec3(local_eye) - (is_near ? plane.origin : glm::dvec3(0.0));
    const glm::dvec3 eye = glm::inverse(local_from_plane) * offset;
    const glm::dvec2 on_grid = is_near ? grid.place(glm::dvec2(eye))
                                       : glm::dvec2(eye) / grid.size * glm::dvec2(grid.count);
    return {on_grid, eye.z, local_eye.w};
}

} // namespace

Grid<glm::vec4> warped_tile(const scene::TexturePlane& plane, const scene::SurfaceDetail& detail,
                            double lift, glm::dvec4 local_eye) {
    const WarpGrid grid = warp_grid(plane, detail);
    const Grid<float> above = heights_above(grid, detail);
    const Grid<glm::vec2> places =
        prewarped(above.view(), Warp(eye_on_grid(grid, plane, lift, local_eye)));
    Grid<glm::vec4> shown(places.cols(), places.rows(), glm::vec4(0.0F));
    parallel_for(places.rows(), [&](int row) {
        for (int col = 0; col < places.cols(); ++col) {
            const glm::dvec2 place(places(col, row));
            if (place.x >= 0.0) {
                const glm::dvec2 tile = grid.coordinate(place) * glm::dvec2(detail.repeats);
                const double height = scene::tile_height(*detail.set, tile, detail.border);
                shown(col, row) = glm::vec4(tile, height, 1.0);
            }
        }
    });
    return shown;
}

} // namespace reljef::render
