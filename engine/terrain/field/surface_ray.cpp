#include "engine/terrain/field/surface_ray.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/terrain/field/heightfield.h"

namespace reljef::terrain {
namespace {

constexpr double bend_tolerance = 1e-3;    // samples, and metres of height
constexpr double quartic_tolerance = 1e-5; // the same
constexpr int max_halvings = 24;
constexpr int max_halvings_unmapped = 8; // of a stretch outside the map's domain

// Distance of the middle of a stretch from its chord: samples, and metres of height.
struct Bend {
    double across = 0.0;
    double height = 0.0;
};

Bend bend_of(glm::dvec3 from, glm::dvec3 halfway, glm::dvec3 to) {
    const glm::dvec3 off = halfway - 0.5 * (from + to);
    return {glm::length(glm::dvec2(off)), std::abs(off.z)};
}

bool is_straight(const RayPlace& from, const RayPlace& halfway, const RayPlace& to) {
    const Bend bend = bend_of(*from.sample, *halfway.sample, *to.sample);
    return std::max(bend.across, bend.height) <= bend_tolerance;
}

double middle_of(const RayPlace& from, const RayPlace& to) {
    return 0.5 * (from.t + to.t);
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

// Bounds of the cells `first` to `last`, as far as they are in a tile; empty if they are unknown.
std::optional<MinMax> bounds_in_tile(const TiledSurface& surface, glm::ivec2 at, glm::ivec2 first,
                                     glm::ivec2 last) {
    const SurfaceTile* tile = surface.tile(at);
    if (tile == nullptr) {
        return surface.range(at);
    }
    const glm::ivec2 far(tile->heights.cols() - 2, tile->heights.rows() - 2); // cell
    return tile->pyramid->bounds(glm::clamp(first - tile->first, glm::ivec2(0), far),
                                 glm::clamp(last - tile->first, glm::ivec2(0), far));
}

struct BoundsBelow {
    bool is_over = false;          // false: the box lies beside the surface
    std::optional<MinMax> heights; // empty: unknown
};

// Bounds of the surface below a box.
BoundsBelow bounds_below(const TiledSurface& surface, const Box& box) {
    constexpr int max_tiles = 64;
    const glm::dvec2 cells(surface.last_sample());
    if (box.high.x < 0.0 || box.high.y < 0.0 || box.low.x > cells.x || box.low.y > cells.y) {
        return {};
    }
    const glm::ivec2 first(glm::clamp(glm::dvec2(box.low), glm::dvec2(0.0), cells - 1.0));
    const glm::ivec2 last(glm::clamp(glm::dvec2(box.high), glm::dvec2(0.0), cells - 1.0));
    const glm::ivec2 from = first / surface.tile_cells();
    const glm::ivec2 to = last / surface.tile_cells();
    const glm::ivec2 count = to - from + 1;
    BoundsBelow below{true, {}};
    if (count.x > max_tiles || count.y > max_tiles || count.x * count.y > max_tiles) {
        return below;
    }
    for (int i = 0; i < count.x * count.y; ++i) {
        const auto part =
            bounds_in_tile(surface, from + glm::ivec2(i % count.x, i / count.x), first, last);
        if (!part) {
            return {true, {}};
        }
        const MinMax& all = below.heights.value_or(*part);
        below.heights = {std::min(all.low, part->low), std::max(all.high, part->high)};
    }
    return below;
}

// Empty if it would be off the ray, or if the map has no such places.
template <class PlaceAt>
std::optional<Quartic> quartic_over(const std::array<RayPlace, 5>& places,
                                    const PlaceAt& place_at) {
    if (!std::all_of(places.begin(), places.end(),
                     [](const RayPlace& place) { return place.sample.has_value(); })) {
        return std::nullopt;
    }
    const Quartic quartic(places);
    // The error is largest near the ends.
    const bool fits = quartic.meets(place_at(middle_of(places[0], places[1]))) &&
                      quartic.meets(place_at(middle_of(places[3], places[4])));
    return fits ? std::optional(quartic) : std::nullopt;
}

} // namespace

Quartic::Quartic(const std::array<RayPlace, 5>& places)
    : begin_(places[0].t), step_(places[1].t - places[0].t) {
    std::transform(places.begin(), places.end(), differences_.begin(),
                   [](const RayPlace& place) { return *place.sample; });
    for (std::size_t order = 1; order < differences_.size(); ++order) {
        for (std::size_t i = differences_.size() - 1; i >= order; --i) {
            differences_[i] = (differences_[i] - differences_[i - 1]) / static_cast<double>(order);
        }
    }
}

RayPlace Quartic::at(double t) const {
    const double u = (t - begin_) / step_;
    glm::dvec3 sample = differences_[4];
    for (int i = 3; i >= 0; --i) {
        sample = sample * (u - i) + differences_[static_cast<std::size_t>(i)];
    }
    return {t, sample};
}

bool Quartic::meets(const RayPlace& place) const {
    if (!place.sample) {
        return false;
    }
    const glm::dvec3 miss = glm::abs(*at(place.t).sample - *place.sample);
    return std::max({miss.x, miss.y, miss.z}) <= quartic_tolerance;
}

Box reach(const TiledSurface& surface, MinMax heights) {
    Box box;
    constexpr int steps = 16;
    const glm::dvec2 last(surface.last_sample());
    for (int j = 0; j <= steps; ++j) {
        for (int i = 0; i <= steps; ++i) {
            const glm::dvec2 at = last * (glm::dvec2(i, j) / static_cast<double>(steps));
            box.add(surface.world_from_sample({at, heights.low}));
            box.add(surface.world_from_sample({at, heights.high}));
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

void SurfaceRay::advance(const TiledSurface& surface) {
    surface_ = &surface;
    needed_.reset();
    if (const auto straight = surface.sample_ray(ray_)) {
        walk(*straight, limits_.range, nullptr);
        return;
    }
    if (span_) {
        search_span(span_->from, span_->to, span_->halvings);
        if (is_done()) {
            return;
        }
        t_ = span_->to.t;
        span_.reset();
    }
    if (t_ < limits_.range.end) {
        const RayPlace from = place_at(limits_.range.begin);
        const RayPlace to = place_at(limits_.range.end);
        search(from, place_at(middle_of(from, to)), to, max_halvings);
    }
}

RayPlace SurfaceRay::place_at(double t) const {
    return {t, surface_->sample_from_world(ray_.at(t))};
}

bool SurfaceRay::is_outside(const RayPlace& from, const RayPlace& to) const {
    return to.t <= t_ || to.t < limits_.window.begin || from.t > limits_.window.end;
}

// Whether nothing of the piece is done.
bool SurfaceRay::is_new(const RayPlace& from) const {
    return from.t > t_ || (from.t == t_ && !tile_);
}

// Where a piece is divided depends on the ray alone. What is in memory, and what the surface
// clears, only skips pieces.
void SurfaceRay::search(const RayPlace& from, const RayPlace& halfway, const RayPlace& to,
                        int halvings) {
    if (is_outside(from, to)) {
        return;
    }
    const bool mapped = from.sample && halfway.sample && to.sample;
    if (mapped && is_new(from) && clears_surface(from, halfway, to)) {
        return;
    }
    if (mapped && is_straight(from, halfway, to)) {
        search_chord(from, to, true);
        return;
    }
    const bool unmapped = !from.sample && !halfway.sample && !to.sample;
    if (halvings <= (unmapped ? max_halvings - max_halvings_unmapped : 0)) {
        search_chord(from, to, false);
        return;
    }
    const RayPlace before = place_at(middle_of(from, halfway));
    const RayPlace after = place_at(middle_of(halfway, to));
    const auto quartic =
        quartic_over({from, before, halfway, after, to}, [this](double t) { return place_at(t); });
    if (quartic) {
        span_.emplace(Span{*quartic, from, to, halvings});
        search_span(from, to, halvings);
        t_ = is_done() ? t_ : to.t;
        span_ = is_done() ? span_ : std::nullopt;
        return;
    }
    search(from, before, halfway, halvings - 1);
    if (!is_done()) {
        search(halfway, after, to, halvings - 1);
    }
}

// As search(), with the quartic instead of the map.
void SurfaceRay::search_span(const RayPlace& from, const RayPlace& to, int halvings) {
    if (is_outside(from, to)) {
        return;
    }
    const RayPlace halfway = span_->quartic.at(middle_of(from, to));
    if (is_new(from) && (clears_surface(from, halfway, to) || waits_at(from))) {
        return;
    }
    if (halvings == 0 || is_straight(from, halfway, to)) {
        search_chord(from, to, true);
        return;
    }
    search_span(from, halfway, halvings - 1);
    if (!is_done()) {
        search_span(halfway, to, halvings - 1);
    }
}

// Whether all of a piece lies above, below or beside the surface. Then it is done.
bool SurfaceRay::clears_surface(const RayPlace& from, const RayPlace& halfway, const RayPlace& to) {
    const std::optional<Box> box = box_around(*from.sample, *halfway.sample, *to.sample);
    if (!box) {
        return false;
    }
    const BoundsBelow surface = bounds_below(*surface_, *box);
    if (surface.is_over && !surface.heights) {
        return false;
    }
    const bool below = surface.is_over && box->high.z < surface.heights->low;
    if (surface.is_over && !below && box->low.z <= surface.heights->high) {
        return false;
    }
    if (below && side_ == Side::above) {
        return false; // it passed through the surface between two pieces
    }
    // Beyond the border the ray is neither above nor below.
    const bool over = surface.is_over && surface_->is_over(*to.sample);
    side_ = !over ? Side::unknown : below ? Side::below : Side::above;
    t_ = to.t;
    return true;
}

// Whether nothing is known of the tile below a place. The ray waits for it.
bool SurfaceRay::waits_at(const RayPlace& place) {
    if (!surface_->is_over(*place.sample)) {
        return false;
    }
    const glm::ivec2 at = surface_->tile_at(glm::dvec2(*place.sample));
    if (surface_->tile(at) != nullptr || surface_->range(at)) {
        return false;
    }
    needed_ = at;
    t_ = place.t;
    return true;
}

// On the straight line between two places.
void SurfaceRay::search_chord(const RayPlace& from, const RayPlace& to, bool moves_hit) {
    if (!from.sample || !to.sample || (!moves_hit && passes_beside(from, to))) {
        side_ = Side::unknown;
    } else if (crosses_seam(from, to)) {
        search_across_seam(from, to);
        return;
    } else {
        const Chord chord{from, to, moves_hit};
        walk({*from.sample, *to.sample - *from.sample}, {0.0, 1.0}, &chord);
        if (is_done()) {
            t_ = from.t;
            return;
        }
        side_ = surface_->is_over(*to.sample) ? side_ : Side::unknown;
    }
    t_ = to.t;
}

bool SurfaceRay::crosses_seam(const RayPlace& from, const RayPlace& to) const {
    const auto around = surface_->columns_all_around();
    return around && std::abs(to.sample->x - from.sample->x) > 0.5 * *around;
}

// A piece too short to be divided, from beyond one end of the columns to beyond the other: behind
// the Earth's other side, where longitudes begin anew.
bool SurfaceRay::passes_beside(const RayPlace& from, const RayPlace& to) const {
    const double last = surface_->last_sample().x;
    return !surface_->columns_all_around() && ((from.sample->x > last && to.sample->x < 0.0) ||
                                               (from.sample->x < 0.0 && to.sample->x > last));
}

// The shorter way around the globe, from each of its ends: beyond the seam there are no columns. It
// starts anew after waiting, because a tile does not say from which end the ray came to it.
void SurfaceRay::search_across_seam(const RayPlace& from, const RayPlace& to) {
    const double around = *surface_->columns_all_around();
    const bool eastward = to.sample->x < from.sample->x;
    const glm::dvec3 turn(eastward ? around : -around, 0.0, 0.0);
    const glm::dvec3 way = *to.sample + turn - *from.sample;
    const Chord before_seam{from, {to.t, *from.sample + way}, false};
    const Chord behind_seam{{from.t, *to.sample - way}, to, false};
    const Side side = side_;
    tile_.reset();
    walk({*before_seam.from.sample, way}, {0.0, 1.0}, &before_seam);
    if (!is_done()) {
        walk({*behind_seam.from.sample, way}, {0.0, 1.0}, &behind_seam);
    }
    if (needed_) {
        side_ = side;
        tile_.reset();
    }
    t_ = is_done() ? from.t : to.t;
    side_ = is_done() || surface_->is_over(*to.sample) ? side_ : Side::unknown;
}

// Through the tiles from tile_ on.
void SurfaceRay::walk(const Ray& sample_ray, Interval range, const Chord* chord) {
    TileWalk walk(*surface_, sample_ray, range);
    if (tile_) {
        walk.resume_at(*tile_);
        tile_.reset();
    }
    for (; walk.is_inside(); walk.advance()) {
        const SurfaceTile* tile = surface_->tile(walk.tile());
        if (tile == nullptr) {
            if (passes(walk, sample_ray)) {
                continue;
            }
            needed_ = tile_ = walk.tile();
            t_ = walk.stretch().begin;
            return;
        }
        const Stretch stretch = follow(*tile, sample_ray, range, side_);
        if (stretch.hit) {
            hit_ = chord != nullptr ? on_ray(*stretch.hit, *chord) : stretch.hit;
            if (needed_) {
                tile_ = walk.tile(); // to be hit again
                hit_.reset();
            }
            return;
        }
        side_ = stretch.side;
    }
}

// Whether a ray stays above or below a tile that is not in memory.
bool SurfaceRay::passes(const TileWalk& walk, const Ray& sample_ray) {
    const Interval part = walk.stretch();
    if (!(part.begin < part.end)) {
        return true;
    }
    const auto heights = surface_->range(walk.tile());
    if (!heights) {
        return false;
    }
    const double enters = sample_ray.at(part.begin).z;
    const double leaves = sample_ray.at(part.end).z;
    if (std::min(enters, leaves) > heights->high) {
        side_ = Side::above;
        return true;
    }
    if (std::max(enters, leaves) < heights->low && side_ != Side::above) {
        side_ = Side::below;
        return true;
    }
    return false;
}

SurfaceHit SurfaceRay::on_ray(const SurfaceHit& chord_hit, const Chord& chord) {
    const double t = chord.from.t + chord_hit.t * (chord.to.t - chord.from.t);
    const SurfaceHit hit{t, chord_hit.sample};
    return chord.moves_hit ? moved_onto_surface(hit, chord) : hit;
}

// Moves a hit of the chord along the ray onto the surface: first by the slope of the chord over
// the surface, then by secants, while the clearance falls.
SurfaceHit SurfaceRay::moved_onto_surface(const SurfaceHit& hit, const Chord& chord) {
    constexpr int max_secants = 4;
    constexpr double close_enough = 1e-8; // metres of height
    RayPlace best = place_at(hit.t);
    double best_miss = clearance(best);
    double step = -best_miss / slope_over_surface(hit, chord);
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

double SurfaceRay::slope_over_surface(const SurfaceHit& hit, const Chord& chord) {
    constexpr double part = 1e-3; // of the chord
    const double step = part * (chord.to.t - chord.from.t);
    const glm::dvec3 ahead = hit.sample + part * (*chord.to.sample - *chord.from.sample);
    return (clearance({hit.t + step, ahead}) - clearance({hit.t, hit.sample})) / step;
}

// Height above the surface, metres; NaN off the grid, and if the ray must wait for a tile.
double SurfaceRay::clearance(const RayPlace& place) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (!place.sample || !surface_->is_over(*place.sample)) {
        return none;
    }
    const glm::dvec2 sample(*place.sample);
    const glm::ivec2 at = surface_->tile_at(sample);
    const SurfaceTile* tile = surface_->tile(at);
    if (tile == nullptr) {
        needed_ = at;
        return none;
    }
    return place.sample->z - bilinear_height(tile->heights, sample - glm::dvec2(tile->first));
}

} // namespace reljef::terrain
