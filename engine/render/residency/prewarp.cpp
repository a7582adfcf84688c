#include "engine/render/residency/prewarp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "engine/render/residency/relief_maps.h"

namespace reljef::render {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A warped sample: its position along the line, and its values.
struct Warped {
    double at = std::numeric_limits<double>::quiet_NaN(); // empty
    glm::dvec2 values{0.0};
};

// Calls `visit(i)` for the pairs (i, i + 1) of a line, far from `nearest` first.
template <class Visit> void far_pairs_first(int count, double nearest, const Visit& visit) {
    const int middle = static_cast<int>(std::floor(std::clamp(nearest, -1.0, count + 0.0)));
    for (int i = 0; i < std::min(middle, count - 1); ++i) {
        visit(i);
    }
    for (int i = count - 2; i >= std::max(middle, 0); --i) {
        visit(i);
    }
}

// Resamples a line at integer positions: `put(place, values)`.
template <class Put> void resample(std::span<const Warped> line, double nearest, const Put& put) {
    const int count = static_cast<int>(line.size());
    far_pairs_first(count, nearest, [&](int i) {
        const Warped& a = line[static_cast<std::size_t>(i)];
        const Warped& b = line[static_cast<std::size_t>(i) + 1];
        const double low = std::max(std::ceil(std::min(a.at, b.at)), 0.0);
        const double high = std::min(std::floor(std::max(a.at, b.at)), count - 1.0);
        if (!std::isfinite(a.at) || !std::isfinite(b.at) || low > high) {
            return;
        }
        for (int place = static_cast<int>(low); place <= static_cast<int>(high); ++place) {
            const double part = a.at == b.at ? 0.0 : (place - a.at) / (b.at - a.at);
            put(place, glm::mix(a.values, b.values, part));
        }
    });
}

// Warps a row. The values are the new row and the original column.
void warp_row(GridView<const float> heights, int row, const Warp& warp, Grid<Warped>& rows) {
    std::vector<Warped> line(static_cast<std::size_t>(heights.cols()));
    for (int col = 0; col < heights.cols(); ++col) {
        if (const auto seen = warp.at(glm::dvec2(col, row), heights(col, row))) {
            line[static_cast<std::size_t>(col)] = {seen->x, {seen->y, col}};
        }
    }
    resample(line, warp.nearest().x, [&](int place, glm::dvec2 values) {
        rows(place, row) = {values.x, {values.y, row}};
    });
}

void warp_column(const Grid<Warped>& rows, int col, const Warp& warp, Grid<glm::vec2>& places) {
    std::vector<Warped> line(static_cast<std::size_t>(rows.rows()));
    for (int row = 0; row < rows.rows(); ++row) {
        line[static_cast<std::size_t>(row)] = rows(col, row);
    }
    resample(line, warp.nearest().y,
             [&](int place, glm::dvec2 values) { places(col, place) = glm::vec2(values); });
}

} // namespace

Warp::Warp(glm::dvec4 eye) : sees_(eye.z > 0.0) {
    if (!sees_) {
        return;
    }
    k_ = -glm::dvec3(eye.x, eye.y, eye.w) / eye.z;
    const auto toward_infinity = [](double along) {
        return along > 0.0 ? infinity : (along < 0.0 ? -infinity : 0.0);
    };
    nearest_ =
        eye.w > 0.0 ? glm::dvec2(eye) : glm::dvec2(toward_infinity(eye.x), toward_infinity(eye.y));
}

std::optional<glm::dvec2> Warp::at(glm::dvec2 place, double height) const {
    const double share = 1.0 + k_.z * height;
    if (!sees_ || !(share > 0.0)) {
        return std::nullopt;
    }
    return (place + glm::dvec2(k_) * height) / share;
}

glm::dvec4 warp_eye(const scene::Camera& camera, const glm::dmat4& world_from_local) {
    const glm::dvec4 eye = camera.projection == scene::ProjectionKind::perspective
                               ? glm::dvec4(camera.eye, 1.0)
                               : glm::dvec4(-scene::view_axes(camera).forward, 0.0);
    return glm::inverse(world_from_local) * eye;
}

Grid<glm::vec2> prewarped(GridView<const float> heights, const Warp& warp,
                          const ParallelOptions& parallel) {
    Grid<Warped> rows(heights.cols(), heights.rows());
    parallel_for(
        heights.rows(), [&](int row) { warp_row(heights, row, warp, rows); }, parallel);
    Grid<glm::vec2> places(heights.cols(), heights.rows(), glm::vec2(-1.0F));
    parallel_for(
        heights.cols(), [&](int col) { warp_column(rows, col, warp, places); }, parallel);
    return places;
}

Grid<glm::vec4> warped_places(const scene::TerrainSurface& surface, glm::dvec4 local_eye) {
    const Grid<float>& heights = surface.heightfield().heights;
    const ReliefSpace space = relief_space(surface);
    const double plane = terrain::reference_height(surface.heightfield());
    const auto above_plane = static_cast<float>((plane - space.lowest) / space.range);
    Grid<float> above = terrain::unit_heights(heights.view());
    for (float& height : above.samples()) {
        height -= above_plane;
    }
    glm::dvec3 eye = space.space_from_local * glm::dvec3(local_eye);
    if (local_eye.w > 0.0) {
        eye += space.space_of_origin - glm::dvec3(0.0, 0.0, above_plane);
    }
    const Grid<glm::vec2> places = prewarped(above.view(), Warp(glm::dvec4(eye, local_eye.w)));
    Grid<glm::vec4> shown(places.cols(), places.rows(), glm::vec4(-1.0F));
    parallel_for(places.rows(), [&](int row) {
        for (int col = 0; col < places.cols(); ++col) {
            const glm::vec2 place = places(col, row);
            if (place.x >= 0.0F) {
                const double height = terrain::bilinear_height(heights.view(), glm::dvec2(place));
                shown(col, row) = glm::vec4(place, height, 0.0);
            }
        }
    });
    return shown;
}

} // namespace reljef::render
