#include "engine/view/choice/typical_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/bilinear.h"
#include "engine/view/relief_samples.h"

namespace reljef::view {
namespace {

// Secant steps meet smooth ground in fewer steps than bisection, which is nearer on walls.
constexpr std::array interval_steps{4, 8, 16, 32};
constexpr std::array relief_steps{8, 16, 32};
constexpr int secant_steps = 2;
constexpr int bisection_steps = 8;

} // namespace

// From the entry of a ray, or the near plane, to where it leaves; heights in [0,1] of the range.
struct TypicalSearch::RaySpan {
    glm::dvec3 start;
    glm::dvec3 span;

    [[nodiscard]] glm::dvec3 at(double part) const { return start + part * span; }
};

std::vector<scene::Technique> typical_searches() {
    std::vector<scene::Technique> found{scene::make_technique(scene::TechniqueId::parallax)};
    for (const int steps : interval_steps) {
        found.push_back({scene::Interval{.linear_steps = steps, .secant_steps = secant_steps}});
    }
    for (const int steps : relief_steps) {
        found.push_back({scene::Relief{.linear_steps = steps, .bisection_steps = bisection_steps}});
    }
    return found;
}

TypicalSearch::TypicalSearch(const View& view, const scene::TerrainSurface& surface)
    : view_(view), surface_(surface),
      caster_(surface.heightfield().heights.view(), surface.pyramid(), surface.placement()) {
    const terrain::MinMax heights = surface.pyramid().total();
    lowest_ = heights.low;
    range_ = heights.high > heights.low ? double{heights.high} - heights.low : 1.0;
}

double TypicalSearch::height_at(glm::dvec2 place) const {
    const Grid<float>& heights = surface_.heightfield().heights;
    const glm::dvec2 last(heights.cols() - 1, heights.rows() - 1);
    const float height = bilinear(heights, glm::clamp(place, glm::dvec2(0.0), last),
                                  [](float sample) { return sample; });
    return (height - lowest_) / range_;
}

bool TypicalSearch::is_on_surface(glm::dvec2 place) const {
    const Grid<float>& heights = surface_.heightfield().heights;
    return place.x >= 0.0 && place.y >= 0.0 && place.x <= heights.cols() - 1.0 &&
           place.y <= heights.rows() - 1.0;
}

std::optional<TypicalSearch::RaySpan> TypicalSearch::span_in_box(const Ray& ray) const {
    const auto samples = terrain::sample_ray_on_plane(surface_.placement(), ray);
    const Grid<float>& heights = surface_.heightfield().heights;
    const double margin = relief_margin * range_;
    const Box box{{0.0, 0.0, lowest_ - margin},
                  {heights.cols() - 1.0, heights.rows() - 1.0, lowest_ + range_ + margin}};
    const auto part = samples ? intersect(*samples, box, {view_.camera.near, 1e300}) : std::nullopt;
    if (!part) {
        return std::nullopt;
    }
    const auto unit = [&](glm::dvec3 sample) {
        return glm::dvec3(sample.x, sample.y, (sample.z - lowest_) / range_);
    };
    const glm::dvec3 start = unit(samples->at(part->begin));
    return RaySpan{start, unit(samples->at(part->end)) - start};
}

// Down to the highest ground near the hit that rays through the pixels around may meet.
TypicalSearch::RaySpan TypicalSearch::after_beam(const RaySpan& way, const ProbeRay& probe) const {
    const Grid<float>& heights = surface_.heightfield().heights;
    const glm::dvec2 last_cell(heights.cols() - 2, heights.rows() - 2);
    if (!probe.hit || way.span.z >= 0.0) {
        return way;
    }
    glm::dvec2 low(*probe.hit);
    glm::dvec2 high = low;
    for (const glm::dvec2 corner : {glm::dvec2(-1.0, -1.0), {1.0, -1.0}, {-1.0, 1.0}, {1.0, 1.0}}) {
        Ray ray =
            scene::view_ray(view_.camera, view_.size, probe.pixel + double{pixels_a_beam} * corner);
        ray.origin -= view_.offset;
        const auto samples = terrain::sample_ray_on_plane(surface_.placement(), ray);
        const double part = (probe.hit->z - samples->origin.z) / samples->direction.z;
        if (!(part > 0.0 && std::isfinite(part))) {
            return way; // above the horizon
        }
        low = glm::min(low, glm::dvec2(samples->at(part)));
        high = glm::max(high, glm::dvec2(samples->at(part)));
    }
    const auto cell = [&](glm::dvec2 place) {
        return glm::ivec2(glm::clamp(glm::floor(place), glm::dvec2(0.0), last_cell));
    };
    const double highest = surface_.pyramid().bounds(cell(low), cell(high)).high;
    const double part = ((highest - lowest_) / range_ - way.start.z) / way.span.z;
    const double begin = std::clamp(part, 0.0, 1.0);
    return {way.at(begin), (1.0 - begin) * way.span};
}

TypicalSearch::Found TypicalSearch::find(const scene::Technique& technique,
                                         const ProbeRay& probe) const {
    const auto way = span_in_box(probe.ray);
    if (!way) {
        return {};
    }
    const auto& parameters = technique.parameters;
    if (const auto* const interval = std::get_if<scene::Interval>(&parameters)) {
        return find_by(*interval, after_beam(*way, probe));
    }
    if (const auto* const relief = std::get_if<scene::Relief>(&parameters)) {
        return find_by(*relief, *way);
    }
    return find_by(std::get<scene::Parallax>(parameters), *way);
}

TypicalSearch::Found TypicalSearch::find_by(const scene::Parallax& parallax,
                                            const RaySpan& way) const {
    const double plane = -parallax.offset;
    const double part = (plane - way.start.z) / way.span.z;
    if (!(part >= 0.0 && part <= 1.0 && way.span.z < 0.0)) {
        return {};
    }
    const glm::dvec2 entry(way.at(part));
    const glm::dvec2 place = entry + (height_at(entry) - plane) * glm::dvec2(way.span) / way.span.z;
    return is_on_surface(place) ? Found{place, 0} : Found{};
}

double TypicalSearch::clearance(const RaySpan& way, double part) const {
    const glm::dvec3 point = way.at(part);
    return point.z - height_at(glm::dvec2(point));
}

std::optional<TypicalSearch::Crossing> TypicalSearch::first_crossing(const RaySpan& way,
                                                                     int steps) const {
    Crossing crossing{.part = 0.0, .over = clearance(way, 0.0)};
    for (crossing.step = 1; crossing.step <= steps; ++crossing.step) {
        const double next = static_cast<double>(crossing.step) / steps;
        const double now = clearance(way, next);
        if (now < 0.0 && crossing.over >= 0.0) {
            crossing.low_part = next;
            crossing.under = now;
            return crossing;
        }
        crossing.part = next;
        crossing.over = now;
    }
    return std::nullopt;
}

TypicalSearch::Found TypicalSearch::find_by(const scene::Interval& interval,
                                            const RaySpan& way) const {
    auto at = first_crossing(way, interval.linear_steps);
    if (!at) {
        return {std::nullopt, interval.linear_steps};
    }
    const auto secant = [&] {
        return glm::mix(at->part, at->low_part, at->over / (at->over - at->under));
    };
    for (int round = 1; round < interval.secant_steps; ++round) {
        const double guess = secant();
        const double above = clearance(way, guess);
        (above < 0.0 ? at->low_part : at->part) = guess;
        (above < 0.0 ? at->under : at->over) = above;
    }
    return {glm::dvec2(way.at(secant())), at->step + interval.secant_steps - 1};
}

TypicalSearch::Found TypicalSearch::find_by(const scene::Relief& relief, const RaySpan& way) const {
    auto at = first_crossing(way, relief.linear_steps);
    if (!at) {
        return {std::nullopt, relief.linear_steps};
    }
    for (int round = 0; round < relief.bisection_steps; ++round) {
        const double middle = 0.5 * (at->part + at->low_part);
        (clearance(way, middle) < 0.0 ? at->low_part : at->part) = middle;
    }
    return {glm::dvec2(way.at(at->low_part)), at->step + relief.bisection_steps};
}

bool TypicalSearch::is_within(const ProbeRay& probe, glm::dvec2 place, double bound) const {
    const glm::dvec3 point =
        surface_.placement().world_from_sample({place, lowest_ + range_ * height_at(place)});
    const scene::Projected shown = scene::project(view_.camera, view_.size, point + view_.offset);
    if (!(shown.depth > 0.0) || !(glm::distance(shown.pixel, probe.pixel) <= bound)) {
        return false;
    }
    const auto is_near = [&](glm::dvec3 hit) {
        return glm::distance(glm::dvec2(hit), place) <= 1.0;
    };
    if (probe.hit && is_near(*probe.hit)) {
        return true;
    }
    const auto hit = caster_.first_hit({probe.ray.origin, point - probe.ray.origin});
    return !hit || is_near(hit->sample);
}

std::optional<SearchTrial> TypicalSearch::try_along(const scene::Technique& technique,
                                                    const std::vector<ProbeRay>& probes,
                                                    const Demand& demand) const {
    const auto count = static_cast<double>(probes.size());
    SearchTrial trial;
    for (const ProbeRay& probe : probes) {
        const Found found = find(technique, probe);
        trial.steps += found.steps / count;
        if (found.place || probe.hit) {
            const bool both = found.place && probe.hit;
            ++trial.terrain_probes;
            trial.within += both && is_within(probe, *found.place, demand.bound) ? 1 : 0;
        }
        if (trial.terrain_probes - trial.within > (1.0 - demand.share) * count) {
            return std::nullopt;
        }
    }
    const bool is_enough = trial.terrain_probes >= demand.probes && trial.share() >= demand.share;
    return is_enough ? std::optional(trial) : std::nullopt;
}

} // namespace reljef::view
