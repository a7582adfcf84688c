#include "engine/session/picture/faded_contours.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/terrain/field/surface_caster.h"
#include "engine/view/draw_list.h"
#include "engine/view/picture/contour_labels.h"
#include "engine/view/picture/scale_bar.h"

namespace reljef::session {
namespace {

constexpr glm::ivec2 probes{20, 15}; // of a picture

// A place of sloping ground in view.
struct ContourProbe {
    double change = 0.0; // of the height from a pixel to its neighbours, metres
    double distance = 0.0;
};

// As shaders/terrain/contours.glsl.
std::optional<ContourProbe> probe_of(const scene::TerrainSurface& surface, const Ray& ray,
                                     const terrain::SurfaceHit& hit, glm::dvec2 metres_a_pixel) {
    const terrain::Placement& placement = surface.placement();
    const auto& heights = surface.heightfield().heights;
    const glm::dvec2 last(heights.cols() - 1, heights.rows() - 1);
    const auto place = [&](glm::dvec2 sample) {
        const glm::dvec2 inside = glm::clamp(sample, glm::dvec2(0.0), last);
        return placement.world_from_sample(
            {inside, terrain::bilinear_height(heights.view(), inside)});
    };
    const glm::dvec2 at(hit.sample);
    const glm::dvec3 across = place(at + glm::dvec2(0.5, 0.0)) - place(at - glm::dvec2(0.5, 0.0));
    const glm::dvec3 down = place(at + glm::dvec2(0.0, 0.5)) - place(at - glm::dvec2(0.0, 0.5));
    const glm::dvec3 world = ray.at(hit.t);
    const glm::dvec3 up = placement.up(world);
    const glm::dvec3 normal = glm::normalize(glm::cross(down, across));
    const glm::dvec3 view = glm::normalize(ray.direction);
    const double facing = glm::dot(normal, view);
    const double distance = glm::distance(world, ray.origin);
    const double pixel = metres_a_pixel.x + metres_a_pixel.y * distance;
    const glm::dvec3 rise = up - normal * (glm::dot(up, view) / facing);
    const double change = pixel * glm::length(rise) / placement.exaggeration();
    const bool is_sloping = change > std::abs(hit.sample.z) * view::contour_ink().height_rounding;
    return is_sloping && std::isfinite(change) ? std::optional(ContourProbe{change, distance})
                                               : std::nullopt;
}

std::vector<ContourProbe> probes_of(const TerrainScene& scene, glm::ivec2 size) {
    const scene::TerrainSurface& surface = *scene.terrain->get<scene::TerrainNode>()->surface;
    const scene::Camera& camera = *scene.camera->get<scene::Camera>();
    const terrain::SurfaceCaster caster(surface.heightfield().heights.view(), surface.pyramid(),
                                        surface.placement());
    const glm::dvec2 metres(scene::metres_a_pixel(camera, size));
    std::vector<ContourProbe> found;
    for (int row = 0; row < probes.y; ++row) {
        for (int col = 0; col < probes.x; ++col) {
            const glm::dvec2 pixel =
                (glm::dvec2(col, row) + 0.5) * glm::dvec2(size) / glm::dvec2(probes);
            const Ray ray = scene::view_ray(camera, size, pixel);
            const auto hit = caster.first_hit(ray);
            if (const auto probe = hit ? probe_of(surface, ray, *hit, metres) : std::nullopt) {
                found.push_back(*probe);
            }
        }
    }
    return found;
}

// `share`: of the numbers that are not larger.
double quantile(std::vector<double> numbers, double share) {
    const auto place = numbers.begin() +
                       static_cast<std::ptrdiff_t>(share * static_cast<double>(numbers.size() - 1));
    std::nth_element(numbers.begin(), place, numbers.end());
    return *place;
}

bool draws_contours(const TerrainScene& scene) {
    const auto& node = *scene.terrain->get<scene::TerrainNode>();
    return scene.models.empty() && scene::shown_contours(node) > 0.0 &&
           scene::shows_heights(node.material.technique) && !node.material.wireframe;
}

std::string rounded_length(double metres) {
    const double step = std::pow(10.0, std::floor(std::log10(metres)) - 1.0);
    const double rounded = std::floor(metres / step) * step; // two digits
    const bool is_near = rounded < 1000.0;
    const double shown = is_near ? rounded : rounded / 1000.0;
    return fmt::format("{:.{}f} {}", shown, shown < 10.0 ? 1 : 0, is_near ? "m" : "km");
}

} // namespace

std::optional<FadedContours> faded_contours(const TerrainScene& scene, glm::ivec2 size) {
    constexpr double half = 0.5;
    if (!draws_contours(scene) || size.x <= 0 || size.y <= 0) {
        return std::nullopt;
    }
    const auto seen = probes_of(scene, size);
    if (seen.empty()) {
        return std::nullopt;
    }
    const scene::Camera& camera = *scene.camera->get<scene::Camera>();
    const double scale = view::contour_scale(camera, size);
    const view::ContourInk ink = view::contour_ink();
    std::vector<double> intervals; // that have half of their ink
    std::vector<double> distances; // from which the chosen ones have it
    const double interval = scene::shown_contours(*scene.terrain->get<scene::TerrainNode>());
    for (const ContourProbe& probe : seen) {
        intervals.push_back(ink.half_pixels * scale * probe.change);
        distances.push_back(probe.distance * interval / intervals.back());
    }
    const double needed = quantile(intervals, half);
    if (needed <= interval) {
        return std::nullopt;
    }
    FadedContours faded;
    faded.shows_bold = needed <= ink.bold_every * interval;
    faded.shown_interval = view::round_step(needed);
    if (camera.projection == scene::ProjectionKind::perspective) {
        faded.shown_distance = quantile(distances, half);
    }
    return faded;
}

std::string faded_text(const FadedContours& faded, double interval) {
    return fmt::format(
        "contours every {} m are too close together to show on most of this view{}: every {} m "
        "would show here, every {} m {}",
        interval, faded.shows_bold ? " (only every fifth one shows)" : "", faded.shown_interval,
        interval,
        faded.shown_distance
            ? fmt::format("from within {} of the ground", rounded_length(*faded.shown_distance))
            : std::string("on a closer map"));
}

} // namespace reljef::session
