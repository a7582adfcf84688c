#include "engine/truth/geometric_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/core/parallel_for.h"
#include "engine/core/statistics.h"

namespace reljef::truth {
namespace {

constexpr double no_bound = std::numeric_limits<double>::infinity();
constexpr float no_error = std::numeric_limits<float>::quiet_NaN();

// Infinity for NaN and for values beyond float's range.
double bounded(double error) {
    return error <= std::numeric_limits<float>::max() ? error : no_bound;
}

bool is_before_eye(const scene::Camera& camera, double depth) {
    return camera.projection == scene::ProjectionKind::orthographic || depth > 0.0;
}

Result<void> check_frames(const HitBuffer& shown, const HitBuffer& truth) {
    if (shown.cols() != truth.cols() || shown.rows() != truth.rows()) {
        return Error{fmt::format("a frame of {}x{} pixels: {}x{} as in the true frame was expected",
                                 shown.cols(), shown.rows(), truth.cols(), truth.rows())};
    }
    if (!has_terrain(shown) && !has_terrain(truth)) {
        return Error{fmt::format("a frame of {}x{} pixels without terrain, true or shown: terrain "
                                 "at one pixel at least was expected",
                                 shown.cols(), shown.rows())};
    }
    return {};
}

Verdict verdict_on(const Hit& shown, const Hit& true_hit, double texels_off) {
    if (!shows_terrain(shown)) {
        return shows_terrain(true_hit) ? Verdict::hole : Verdict::no_terrain;
    }
    return shows_terrain(true_hit) && texels_off <= max_texels_off ? Verdict::right
                                                                   : Verdict::wrong;
}

GeometricErrors blank_errors(int cols, int rows) {
    GeometricErrors errors;
    errors.reprojection.map = Grid<float>(cols, rows, no_error);
    errors.hit.map = Grid<float>(cols, rows, no_error);
    errors.verdicts = Grid<Verdict>(cols, rows);
    return errors;
}

void judge_pixel(const PixelMeasure& measure, const HitBuffer& shown, const HitBuffer& truth,
                 glm::ivec2 pixel, GeometricErrors& errors) {
    const Hit& hit = shown(pixel.x, pixel.y);
    const Hit& true_hit = truth(pixel.x, pixel.y);
    double texels_off = no_bound;
    if (shows_terrain(hit)) {
        if (const auto pixels_off = measure.reprojection(pixel, hit)) {
            errors.reprojection.map(pixel.x, pixel.y) = static_cast<float>(bounded(*pixels_off));
        }
        if (shows_terrain(true_hit)) {
            texels_off = bounded(measure.hit(hit, true_hit));
            errors.hit.map(pixel.x, pixel.y) = static_cast<float>(texels_off);
        }
    }
    errors.verdicts(pixel.x, pixel.y) = verdict_on(hit, true_hit, texels_off);
}

Distribution distribution_of(std::span<const double> errors) {
    const Summary summary = summarize(errors);
    const double max = *std::max_element(errors.begin(), errors.end());
    double sum = 0.0;
    for (const double error : errors) {
        sum += error * error;
    }
    return {errors.size(), summary.median,
            summary.p95,   summary.p99,
            max,           std::sqrt(sum / static_cast<double>(errors.size()))};
}

void summarize_map(PixelErrors& errors) {
    std::vector<double> finite;
    finite.reserve(errors.map.size());
    for (const float error : errors.map.samples()) {
        if (std::isfinite(error)) {
            finite.push_back(error);
        } else if (std::isinf(error)) {
            ++errors.unbounded;
        }
    }
    if (!finite.empty()) {
        errors.distribution = distribution_of(finite);
    }
}

void count_verdicts(GeometricErrors& errors) {
    const auto verdicts = errors.verdicts.samples();
    const auto count = [&](Verdict verdict) {
        return static_cast<std::size_t>(std::count(verdicts.begin(), verdicts.end(), verdict));
    };
    errors.holes = count(Verdict::hole);
    errors.wrong = count(Verdict::wrong) + errors.holes;
    const auto wrong = static_cast<double>(errors.wrong);
    errors.wrong_percent = 100.0 * wrong / static_cast<double>(verdicts.size());
    const std::size_t terrain = verdicts.size() - count(Verdict::no_terrain);
    errors.wrong_of_terrain_percent =
        100.0 * wrong / static_cast<double>(std::max(terrain, std::size_t{1}));
}

} // namespace

bool shows_terrain(const Hit& hit) {
    return !hit.is_sky() && !(hit.col == -1.0F && hit.row == -1.0F);
}

bool has_terrain(const HitBuffer& hits) {
    return std::any_of(hits.samples().begin(), hits.samples().end(), shows_terrain);
}

double reprojection_error(const SurfaceView& view, glm::ivec2 size, glm::ivec2 pixel,
                          const Hit& hit) {
    const glm::dvec2 texel = hit.place();
    if (!std::isfinite(texel.x) || !std::isfinite(texel.y)) {
        return no_bound;
    }
    const double height = terrain::bilinear_height(view.heights, texel);
    const glm::dvec3 local = view.placement.world_from_sample({texel, height});
    const glm::dvec3 world(view.world_from_local * glm::dvec4(local, 1.0));
    return distance_to_pixel(view.camera, size, pixel, world);
}

double distance_to_pixel(const scene::Camera& camera, glm::ivec2 size, glm::ivec2 pixel,
                         glm::dvec3 world) {
    const scene::Projected projected = scene::project(camera, size, world);
    if (!is_before_eye(camera, projected.depth)) {
        return no_bound;
    }
    const glm::dvec2 offset = projected.pixel - (glm::dvec2(pixel) + 0.5);
    return bounded(std::hypot(offset.x, offset.y));
}

double hit_error(const Hit& shown, const Hit& true_hit) {
    return bounded(glm::distance(shown.place(), true_hit.place()));
}

namespace {

// hit_error() of a globe, whose columns begin anew and meet at the poles: metres along the ground,
// in texels of the middle.
double ground_error(const SurfaceView& view, const Hit& shown, const Hit& true_hit) {
    const auto world = [&](const Hit& hit) {
        return view.placement.world_from_sample({hit.place(), true_hit.height});
    };
    const glm::dvec2 spacing = view.placement.spacing();
    return bounded(glm::distance(world(shown), world(true_hit)) / std::min(spacing.x, spacing.y));
}

} // namespace

Result<GeometricErrors> geometric_errors(const SurfaceView& view, const HitBuffer& shown,
                                         const HitBuffer& truth, unsigned threads) {
    const glm::ivec2 size(shown.cols(), shown.rows());
    const auto reprojection = [&](glm::ivec2 pixel, const Hit& hit) {
        return reprojection_error(view, size, pixel, hit);
    };
    const bool is_globe = view.placement.kind() == terrain::PlacementKind::ellipsoid &&
                          view.placement.columns_all_around();
    const auto hit = [&](const Hit& here, const Hit& true_hit) {
        return is_globe ? ground_error(view, here, true_hit) : hit_error(here, true_hit);
    };
    return geometric_errors({reprojection, hit}, shown, truth, threads);
}

Result<GeometricErrors> geometric_errors(const PixelMeasure& measure, const HitBuffer& shown,
                                         const HitBuffer& truth, unsigned threads) {
    if (const auto fit = check_frames(shown, truth); !fit) {
        return fit.error();
    }
    GeometricErrors errors = blank_errors(shown.cols(), shown.rows());
    const auto judge_row = [&](int row) {
        for (int col = 0; col < shown.cols(); ++col) {
            judge_pixel(measure, shown, truth, {col, row}, errors);
        }
    };
    parallel_for(shown.rows(), judge_row, {threads, {}, {}});
    summarize_map(errors.reprojection);
    summarize_map(errors.hit);
    count_verdicts(errors);
    return errors;
}

} // namespace reljef::truth
