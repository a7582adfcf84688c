#include "engine/terrain/field/surface_caster.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace reljef::terrain {
namespace {

constexpr double bend_tolerance = 1e-3;    // samples, and metres of height
constexpr double quartic_tolerance = 1e-5; // the same
constexpr int max_halvings = 24;
constexpr int max_halvings_unmapped = 8; // of a stretch outside the map's domain

struct RayPlace {
    double t = 0.0;
    std::optional<glm::dvec3> sample; // empty outside the map's domain
};

// Distance of the middle of a stretch from its chord: samples, and metres of height.
struct Bend {
    double across = 0.0;
    double height = 0.0;
};

Bend bend_of(glm::dvec3 from, glm::dvec3 halfway, glm::dvec3 to) {
    const glm::dvec3 off = halfway - 0.5 * (from + to);
    return {glm::length(glm::dvec2(off)), std::abs(off.z)};
}

// A bounding box of a stretch with a margin of twice its bend. Empty for a strongly bent stretch.
std::optional<Box> box_around(glm::dvec3 from, glm::dvec3 halfway, glm::dvec3 to) {
    constexpr double max_bend = 0.25; // of the chord
    const Bend bend = bend_of(from, halfway, to);
    if (bend.across > max_bend * glm::distance(glm::dvec2(from), glm::dvec2(to))) {
        return std::nullopt;
    }
    Box box;
    box.add(from);
    box.add(halfway);
    box.add(to);
    const glm::dvec3 room = 2.0 * glm::dvec3(bend.across, bend.across, bend.height);
    return Box{box.low - room, box.high + room};
}

// Bounds of the surface below a box; empty if the box is not over the grid.
std::optional<MinMax> bounds_below(const MinMaxPyramid& pyramid, const Box& box) {
    const glm::dvec2 cells(pyramid.level(0).cols(), pyramid.level(0).rows());
    if (box.high.x < 0.0 || box.high.y < 0.0 || box.low.x > cells.x || box.low.y > cells.y) {
        return std::nullopt;
    }
    const glm::dvec2 low = glm::clamp(glm::dvec2(box.low), glm::dvec2(0.0), cells - 1.0);
    const glm::dvec2 high = glm::clamp(glm::dvec2(box.high), glm::dvec2(0.0), cells - 1.0);
    return pyramid.bounds(glm::ivec2(low), glm::ivec2(high));
}

// Interpolates five points of a ray, evenly spaced in t (Newton's form). It is accurate over 100 km
// and 100 times as fast as the map.
class Quartic {
public:
    explicit Quartic(const std::array<RayPlace, 5>& places)
        : begin_(places[0].t), step_(places[1].t - places[0].t) {
        std::transform(places.begin(), places.end(), differences_.begin(),
                       [](const RayPlace& place) { return *place.sample; });
        for (std::size_t order = 1; order < differences_.size(); ++order) {
            for (std::size_t i = differences_.size() - 1; i >= order; --i) {
                differences_[i] =
                    (differences_[i] - differences_[i - 1]) / static_cast<double>(order);
            }
        }
    }

    [[nodiscard]] RayPlace at(double t) const {
        const double u = (t - begin_) / step_;
        glm::dvec3 sample = differences_[4];
        for (int i = 3; i >= 0; --i) {
            sample = sample * (u - i) + differences_[static_cast<std::size_t>(i)];
        }
        return {t, sample};
    }

    // Whether it interpolates this point, too.
    [[nodiscard]] bool meets(const RayPlace& place) const {
        if (!place.sample) {
            return false;
        }
        const glm::dvec3 miss = glm::abs(*at(place.t).sample - *place.sample);
        return std::max({miss.x, miss.y, miss.z}) <= quartic_tolerance;
    }

private:
    double begin_;
    double step_;
    std::array<glm::dvec3, 5> differences_; // divided, of order 0 to 4
};

// A world ray in sample coordinates, followed front to back.
class BentRay {
public:
    BentRay(GridView<const float> heights, const MinMaxPyramid& pyramid, const Placement& placement,
            const Ray& ray)
        : heights_(heights), pyramid_(pyramid), placement_(placement), ray_(ray) {}

    std::optional<SurfaceHit> first_hit(Interval range) {
        const RayPlace from = place_at(range.begin);
        const RayPlace to = place_at(range.end);
        if (placement_.kind() == PlacementKind::plane) {
            return first_hit_on_chord(from, to);
        }
        return first_hit_between(from, place_at(middle_of(from, to)), to, max_halvings);
    }

private:
    [[nodiscard]] RayPlace place_at(double t) const {
        return {t, placement_.sample_from_world(ray_.at(t))};
    }

    [[nodiscard]] static double middle_of(const RayPlace& from, const RayPlace& to) {
        return 0.5 * (from.t + to.t);
    }

    std::optional<SurfaceHit> first_hit_between(const RayPlace& from, const RayPlace& halfway,
                                                const RayPlace& to, int halvings) {
        const bool mapped = from.sample && halfway.sample && to.sample;
        if (mapped && clears_surface(*from.sample, *halfway.sample, *to.sample)) {
            return std::nullopt;
        }
        if (mapped && is_straight(from, halfway, to)) {
            return first_hit_near_chord(from, to);
        }
        const bool unmapped = !from.sample && !halfway.sample && !to.sample;
        if (halvings <= (unmapped ? max_halvings - max_halvings_unmapped : 0)) {
            return first_hit_on_chord(from, to);
        }
        const RayPlace before = place_at(middle_of(from, halfway));
        const RayPlace after = place_at(middle_of(halfway, to));
        if (mapped && before.sample && after.sample) {
            const Quartic quartic({from, before, halfway, after, to});
            // The error is largest near the ends.
            if (quartic.meets(place_at(middle_of(from, before))) &&
                quartic.meets(place_at(middle_of(after, to)))) {
                return first_hit_on(quartic, from, to, halvings);
            }
        }
        const auto hit = first_hit_between(from, before, halfway, halvings - 1);
        return hit ? hit : first_hit_between(halfway, after, to, halvings - 1);
    }

    // As first_hit_between(), with the quartic instead of the map.
    std::optional<SurfaceHit> first_hit_on(const Quartic& quartic, const RayPlace& from,
                                           const RayPlace& to, int halvings) {
        const RayPlace halfway = quartic.at(middle_of(from, to));
        if (clears_surface(*from.sample, *halfway.sample, *to.sample)) {
            return std::nullopt;
        }
        if (halvings == 0 || is_straight(from, halfway, to)) {
            return first_hit_near_chord(from, to);
        }
        const auto hit = first_hit_on(quartic, from, halfway, halvings - 1);
        return hit ? hit : first_hit_on(quartic, halfway, to, halvings - 1);
    }

    [[nodiscard]] static bool is_straight(const RayPlace& from, const RayPlace& halfway,
                                          const RayPlace& to) {
        const Bend bend = bend_of(*from.sample, *halfway.sample, *to.sample);
        return std::max(bend.across, bend.height) <= bend_tolerance;
    }

    std::optional<SurfaceHit> first_hit_near_chord(const RayPlace& from, const RayPlace& to) {
        const auto hit = first_hit_on_chord(from, to);
        return hit ? std::optional(moved_onto_surface(*hit, from, to)) : std::nullopt;
    }

    // Whether all of a stretch lies above, below or beside the surface.
    bool clears_surface(glm::dvec3 from, glm::dvec3 halfway, glm::dvec3 to) {
        const std::optional<Box> box = box_around(from, halfway, to);
        if (!box) {
            return false;
        }
        const std::optional<MinMax> surface = bounds_below(pyramid_, *box);
        const bool below = surface && box->high.z < surface->low;
        if (surface && !below && box->low.z <= surface->high) {
            return false;
        }
        if (below && side_ == Side::above) {
            return false; // it passed through the surface between two stretches
        }
        // Beyond the border the ray is neither above nor below.
        const bool over = surface && is_over_surface(to);
        side_ = !over ? Side::unknown : below ? Side::below : Side::above;
        return true;
    }

    // On the straight line between two places.
    std::optional<SurfaceHit> first_hit_on_chord(const RayPlace& from, const RayPlace& to) {
        if (!from.sample || !to.sample) {
            side_ = Side::unknown;
            return std::nullopt;
        }
        const Ray chord{*from.sample, *to.sample - *from.sample};
        Stretch stretch = follow(heights_, pyramid_, chord, {0.0, 1.0}, side_);
        side_ = is_over_surface(*to.sample) ? stretch.side : Side::unknown;
        if (stretch.hit) {
            stretch.hit->t = from.t + stretch.hit->t * (to.t - from.t);
        }
        return stretch.hit;
    }

    // Moves a hit of the chord along the ray onto the surface: first by the slope of the chord over
    // the surface, then by secants, while the clearance falls.
    [[nodiscard]] SurfaceHit moved_onto_surface(const SurfaceHit& hit, const RayPlace& from,
                                                const RayPlace& to) const {
        constexpr int max_secants = 4;
        constexpr double close_enough = 1e-8; // metres of height
        RayPlace best = place_at(hit.t);
        double best_miss = clearance(best);
        double step = -best_miss / slope_over_surface(hit, from, to);
        for (int i = 0; i < max_secants && std::abs(best_miss) > close_enough; ++i) {
            const RayPlace next = place_at(best.t + step);
            const double miss = clearance(next);
            if (!(std::abs(miss) < std::abs(best_miss))) {
                break;
            }
            step *= -miss / (miss - best_miss);
            best = next;
            best_miss = miss;
        }
        return best.sample ? SurfaceHit{best.t, *best.sample} : hit;
    }

    [[nodiscard]] double slope_over_surface(const SurfaceHit& hit, const RayPlace& from,
                                            const RayPlace& to) const {
        constexpr double part = 1e-3; // of the chord
        const double step = part * (to.t - from.t);
        const glm::dvec3 ahead = hit.sample + part * (*to.sample - *from.sample);
        return (clearance({hit.t + step, ahead}) - clearance({hit.t, hit.sample})) / step;
    }

    // Height above the surface, metres; NaN off the grid.
    [[nodiscard]] double clearance(const RayPlace& place) const {
        if (!place.sample || !is_over_surface(*place.sample)) {
            return std::numeric_limits<double>::quiet_NaN();
        }
        return place.sample->z - bilinear_height(heights_, glm::dvec2(*place.sample));
    }

    [[nodiscard]] bool is_over_surface(glm::dvec3 sample) const {
        return sample.x >= 0.0 && sample.y >= 0.0 && sample.x <= heights_.cols() - 1 &&
               sample.y <= heights_.rows() - 1;
    }

    GridView<const float> heights_;
    const MinMaxPyramid& pyramid_;
    const Placement& placement_;
    Ray ray_;
    Side side_ = Side::unknown;
};

// A bounding box of the placed surface: 17² points of it, with a margin for the Earth's curvature.
Box reach(GridView<const float> heights, const MinMaxPyramid& pyramid, const Placement& placement) {
    Box box;
    const MinMax total = pyramid.total();
    constexpr int steps = 16;
    for (int j = 0; j <= steps; ++j) {
        for (int i = 0; i <= steps; ++i) {
            const double col = (heights.cols() - 1) * (static_cast<double>(i) / steps);
            const double row = (heights.rows() - 1) * (static_cast<double>(j) / steps);
            box.add(placement.world_from_sample({col, row, total.low}));
            box.add(placement.world_from_sample({col, row, total.high}));
        }
    }
    // Not far beyond small terrains: the map's extrapolation is cubic, so its rounding errors grow
    // by the cube of the distance.
    constexpr double part = 0.02;
    constexpr double max_rest = 1.0; // metres
    const glm::dvec3 size = box.size();
    const double rest = std::min(max_rest, part * std::max(size.x, size.y));
    const glm::dvec3 margin = part * size + glm::dvec3(rest);
    return {box.low - margin, box.high + margin};
}

} // namespace

SurfaceCaster::SurfaceCaster(GridView<const float> heights, const MinMaxPyramid& pyramid,
                             const Placement& placement)
    : heights_(heights), pyramid_(pyramid), placement_(placement),
      reach_(reach(heights, pyramid, placement)) {}

std::optional<SurfaceHit> SurfaceCaster::first_hit(const Ray& world_ray, Interval range) const {
    if (!is_finite(world_ray)) {
        return std::nullopt;
    }
    const auto inside = intersect(world_ray, reach_, range);
    if (!inside || !std::isfinite(inside->end)) {
        return std::nullopt;
    }
    return BentRay(heights_, pyramid_, placement_, world_ray).first_hit(*inside);
}

} // namespace reljef::terrain
