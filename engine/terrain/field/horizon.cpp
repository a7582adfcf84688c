#include "engine/terrain/field/horizon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>

#include "engine/terrain/field/surface_caster.h"

// A ray that begins above the ground and is below it later has passed through it. A stretch is the
// part of a sector between two radii a < b, with the lowest ground h. A ray of the slope s (height
// over distance) crosses all of it and is below h at one end at least if s is less than the slope
// of a place there: on a plane, with h from the eye's height, if s b < h for h < 0, else if s a <
// h.
//
// On the Earth, distances are those along the surface of a ball. The smallest radius of curvature
// of an ellipsoid with the axes a > b is b²/a. A ball of this radius that touches it from within
// lies inside of it (Blaschke's rolling theorem), and the ball that is larger by h inside of all
// places h above it (smaller, if h is below it). So what is inside of the larger ball is below
// ground that is higher than h. The ball's centre is on the eye's vertical. A ray stays in a plane
// through that vertical.

namespace reljef::terrain {
namespace {

constexpr double hides_nothing = -std::numeric_limits<double>::infinity();

// Metres. There the ground is far below a ray from any mountain.
constexpr double max_reach_on_earth = 1e6;
constexpr double max_latitude = 80.0; // degrees

// Metres by which a line of length L on the Earth is bent in samples: on a geographic grid L²
// tan(latitude) / (8 R). Twice that is assumed, and of other maps, too.
double bend_of(double length, double radius) {
    return length * length * std::tan(glm::radians(max_latitude)) / (4.0 * radius);
}

glm::dvec2 direction(double azimuth) {
    return {std::cos(azimuth), std::sin(azimuth)};
}

GroundRange ground_of(const Heightfield& heightfield, const MinMaxPyramid& pyramid,
                      const Placement& placement) {
    const glm::dvec2 last(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    return [=, &pyramid, exaggeration = placement.exaggeration()](
               const SampleRectangle& samples) -> std::optional<HeightRange> {
        if (!(samples.first.x >= 0.0 && samples.first.y >= 0.0 && samples.last.x <= last.x &&
              samples.last.y <= last.y)) {
            return std::nullopt;
        }
        const glm::ivec2 last_cell(last - 1.0);
        const MinMax range = pyramid.bounds(glm::min(glm::ivec2(samples.first), last_cell),
                                            glm::min(glm::ivec2(samples.last), last_cell));
        return HeightRange{exaggeration * range.low, exaggeration * range.high};
    };
}

struct SeenBox {
    double nearest = 0.0; // along the ground, metres
    double azimuth = 0.0; // of the middle
    double before = 0.0;  // radians from the middle to the ends
    double after = 0.0;
    double slope = 0.0; // of the highest ray to the box
};

std::array<glm::dvec3, 8> seen_corners(const EyeFrame& frame, const Box& box) {
    std::array<glm::dvec3, 8> corners{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners.at(i) = frame.seen({(i & 1U) == 0 ? box.low.x : box.high.x,
                                    (i & 2U) == 0 ? box.low.y : box.high.y,
                                    (i & 4U) == 0 ? box.low.z : box.high.z});
    }
    return corners;
}

// With the azimuths of a box within an angle `a` of its middle, a place p of it is at least
// p · m from the eye's vertical, where m is the direction to the middle, and at most p · m /
// cos(a). So its slope is at most z / (p · m) above the eye, and cos(a) times that below it. Both
// are largest at corners.
double highest_slope(std::span<const glm::dvec3> corners, const SeenBox& seen) {
    const glm::dvec2 middle = direction(seen.azimuth);
    const double cosine = std::max(std::cos(std::max(-seen.before, seen.after)), 0.0);
    double slope = -std::numeric_limits<double>::infinity();
    for (const glm::dvec3& corner : corners) {
        const double along = glm::dot(glm::dvec2(corner), middle);
        if (!(along > 0.0)) {
            return std::numeric_limits<double>::infinity();
        }
        slope = std::max(slope, corner.z / along * (corner.z < 0.0 ? cosine : 1.0));
    }
    return slope;
}

SeenBox seen_from(const EyeFrame& frame, const Box& box) {
    const std::array<glm::dvec3, 8> corners = seen_corners(frame, box);
    const glm::dvec3 center = frame.seen(box.center());
    Box around;
    SeenBox seen;
    seen.azimuth = std::atan2(center.y, center.x);
    const glm::dvec2 middle = direction(seen.azimuth);
    double aside = std::numeric_limits<double>::infinity();
    double farthest = 0.0;
    for (const glm::dvec3& corner : corners) {
        const double turn =
            std::remainder(std::atan2(corner.y, corner.x) - seen.azimuth, 2.0 * std::numbers::pi);
        seen.before = std::min(seen.before, turn);
        seen.after = std::max(seen.after, turn);
        aside = std::min(aside, glm::dot(glm::dvec2(corner), middle));
        farthest = std::max(farthest, glm::length(glm::dvec2(corner)));
        around.add(corner);
    }
    const double to_bounds =
        glm::length(glm::clamp(glm::dvec2(0.0), glm::dvec2(around.low), glm::dvec2(around.high)));
    const double nearest = std::max(aside, to_bounds);
    const double top = around.high.z;
    const double distance = top > 0.0 ? nearest : farthest;
    const double slope_of_top =
        distance > 0.0 ? top / distance : std::numeric_limits<double>::infinity();
    seen.slope = std::min(slope_of_top, highest_slope(corners, seen));
    seen.nearest = frame.along(nearest, top);
    return seen;
}

} // namespace

std::optional<EyeFrame> EyeFrame::create(const Placement& placement, glm::dvec3 eye) {
    EyeFrame frame(placement);
    frame.eye_ = eye;
    if (placement.frame() == nullptr) {
        frame.height_ = eye.z;
        return frame;
    }
    const geo::Geodetic place = placement.frame()->geodetic_from_local(eye);
    if (!(std::abs(place.latitude) <= max_latitude)) {
        return std::nullopt;
    }
    const glm::dvec3 up = placement.up(eye);
    const glm::dvec3 north = placement.north(eye);
    frame.axes_ = glm::transpose(glm::dmat3(glm::cross(north, up), north, up));
    frame.latitude_ = place.latitude;
    frame.height_ = place.height;
    frame.radius_ = geo::smallest_radius_of_earth();
    return frame;
}

double EyeFrame::max_reach() const {
    return is_on_plane() ? std::numeric_limits<double>::infinity()
                         : std::min(max_reach_on_earth,
                                    glm::radians(max_latitude - std::abs(latitude_)) * radius_);
}

double EyeFrame::along(double aside, double above) const {
    return is_on_plane() ? aside : radius_ * std::atan2(aside, radius_ + height_ + above);
}

double EyeFrame::slope_of(double along, double height) const {
    if (is_on_plane()) {
        return (height - height_) / along;
    }
    // Of the ball's centre, the place is so far along the eye's vertical and beside it. The
    // difference of heights is kept apart: the rest is small.
    const double angle = along / radius_;
    const double half = std::sin(0.5 * angle);
    const double above = height - height_ - 2.0 * (radius_ + height) * half * half;
    return above / ((radius_ + height) * std::sin(angle));
}

std::optional<glm::dvec2> EyeFrame::samples_a_metre(glm::dvec2 direction) const {
    const auto line =
        is_on_plane() ? sample_ray_on_plane(placement_, {eye_, glm::dvec3(direction, 0.0) * axes_})
                      : std::nullopt;
    return line ? std::optional(glm::dvec2(line->direction)) : std::nullopt;
}

std::optional<glm::dvec2> EyeFrame::sample_at(glm::dvec2 direction, double along) const {
    const double angle = is_on_plane() ? 0.0 : along / radius_;
    const double aside = is_on_plane() ? along : radius_ * std::sin(angle);
    const double half = std::sin(0.5 * angle);
    const double above = -height_ - 2.0 * radius_ * half * half;
    const glm::dvec3 seen(aside * direction, above);
    const auto sample = placement_.sample_from_world(eye_ + seen * axes_);
    return sample && glm::all(glm::equal(*sample, *sample)) ? std::optional(glm::dvec2(*sample))
                                                            : std::nullopt;
}

// The verticals of the ellipsoid turn by less than those of the ball: by their distance over a
// radius of curvature, at most a²/b.
double EyeFrame::drift(double along, double height) const {
    if (is_on_plane()) {
        return 0.0;
    }
    const glm::dvec2 radii = geo::radii_of_earth();
    const double curvature = 1.0 / radius_ - radii.y / (radii.x * radii.x);
    return along * curvature * height;
}

std::optional<SampleRectangle> EyeFrame::samples_around(double distance) const {
    Box box;
    for (int i = 0; i < 4; ++i) {
        const auto sample = sample_at(direction((i + 0.5) * 0.5 * std::numbers::pi),
                                      std::numbers::sqrt2 * distance);
        if (!sample) {
            return std::nullopt;
        }
        box.add(glm::dvec3(*sample, 0.0));
    }
    const double side = 2.0 * distance; // of the square, metres
    const glm::dvec2 more = is_on_plane()
                                ? glm::dvec2(0.0)
                                : bend_of(side, radius_) / side * glm::dvec2(box.high - box.low);
    return SampleRectangle{glm::dvec2(box.low) - more, glm::dvec2(box.high) + more};
}

std::optional<Horizon> Horizon::create(const Placement& placement, GroundRange ground,
                                       const HeightRange& below, const HorizonOptions& reach,
                                       const HorizonView& view) {
    auto frame = EyeFrame::create(placement, view.eye);
    const HeightRange zero = placement.zero_range();
    if (!frame || !(frame->height() - view.near > zero.high + below.high)) {
        return std::nullopt;
    }
    return Horizon(std::move(*frame), std::move(ground), reach, view, zero);
}

std::optional<Horizon> Horizon::create(const Heightfield& heightfield, const MinMaxPyramid& pyramid,
                                       const Placement& placement, const HorizonView& view) {
    GroundRange ground = ground_of(heightfield, pyramid, placement);
    const auto frame = EyeFrame::create(placement, view.eye);
    const auto under = frame ? frame->samples_around(view.near) : std::nullopt;
    const auto below = under ? ground(*under) : std::nullopt;
    if (!below) {
        return std::nullopt;
    }
    const glm::dvec2 last(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    const glm::dvec2 spacing = heightfield.spacing;
    const MinMax total = pyramid.total();
    HorizonOptions options{std::max(spacing.x, spacing.y), glm::length(last * spacing)};
    if (!frame->is_on_plane()) { // places on the Earth take longer
        options.sectors /= 2;
        options.growth = 1.0 + 2.0 * (options.growth - 1.0);
    }
    options.heights = {placement.exaggeration() * total.low, placement.exaggeration() * total.high};
    options.cell = 2.0 * glm::length(spacing); // cells in degrees widen towards the equator
    options.last_sample = last;
    return create(placement, std::move(ground), *below, options, view);
}

Horizon::Horizon(EyeFrame frame, GroundRange ground, const HorizonOptions& reach,
                 const HorizonView& view, HeightRange zero)
    : frame_(std::move(frame)), ground_(std::move(ground)), view_(view), lowest_zero_(zero.low),
      sagitta_(frame_.is_on_plane()
                   ? 0.0
                   : reach.cell * reach.cell / (8.0 * geo::smallest_radius_of_earth())),
      last_sample_(reach.last_sample), sector_angle_(2.0 * std::numbers::pi / reach.sectors),
      sectors_(static_cast<std::size_t>(reach.sectors)), has_ended_(sectors_.size(), false) {
    const double last = std::min(reach.last, frame_.max_reach());
    // Between the eye and a place, a ray is below both by the sagitta of the arc at most.
    const double sagitta =
        frame_.is_on_plane() ? 0.0 : last * last / (8.0 * geo::smallest_radius_of_earth());
    heights_apart_ = std::max({std::abs(frame_.height()), std::abs(reach.heights.low + zero.low),
                               std::abs(reach.heights.high + zero.high)}) +
                     sagitta;
    outside_ = 1.0 / std::cos(0.5 * sector_angle_);
    for (int border = 0; border <= reach.sectors; ++border) {
        const glm::dvec2 along = direction(border * sector_angle_);
        borders_.push_back({along, frame_.samples_a_metre(along)});
    }
    eye_sample_ = frame_.sample_at({1.0, 0.0}, 0.0);
    // The maximum is at 45 degrees.
    rectangle_growth_ =
        std::sqrt(2.0) * std::cos(0.25 * std::numbers::pi - 0.5 * sector_angle_) + 0x1p-10;
    for (double radius = std::max(reach.first, view.near); radius < reach.growth * last;
         radius *= reach.growth) {
        radii_.push_back(radius);
    }
}

bool Horizon::hides(const Box& box) {
    const SeenBox seen = seen_from(frame_, box);
    // The last stretch that ends before the box begins.
    const double end = seen.nearest / rectangle_growth_;
    const auto stretch = std::upper_bound(radii_.begin(), radii_.end(), end) - radii_.begin() - 2;
    const double angle = std::atan(seen.slope) + view_.margin;
    if (stretch < 0 || angle >= 0.5 * std::numbers::pi) {
        return false;
    }
    const double slope = std::tan(angle);
    const auto count = static_cast<int>(sectors_.size());
    // One more sector on each side, for rounding.
    const int first =
        static_cast<int>(std::floor((seen.azimuth + seen.before) / sector_angle_)) - 1;
    const int last = static_cast<int>(std::floor((seen.azimuth + seen.after) / sector_angle_)) + 1;
    for (int index = first; index <= last; ++index) {
        const int sector = (index % count + count) % count;
        if (!is_hidden(sector, static_cast<std::size_t>(stretch), slope)) {
            return false;
        }
    }
    return true;
}

// Whether the stretches 0 to `stretch` hide a slope. Looks no farther than to the first that does.
bool Horizon::is_hidden(int sector, std::size_t stretch, double slope) {
    std::vector<double>& slopes = sectors_[static_cast<std::size_t>(sector)];
    while (slopes.size() <= stretch && (slopes.empty() || !(slope < slopes.back()))) {
        const double before = slopes.empty() ? hides_nothing : slopes.back();
        auto has_ended = has_ended_[static_cast<std::size_t>(sector)];
        has_ended = has_ended || leaves_terrain(sector, slopes.size());
        const auto steepest = has_ended ? std::nullopt : slope_of(sector, slopes.size());
        slopes.push_back(std::max(before, steepest.value_or(hides_nothing)));
    }
    return slope < slopes[std::min(stretch, slopes.size() - 1)];
}

// On the Earth, a straight line may leave the terrain and come back, below its surface.
bool Horizon::leaves_terrain(int sector, std::size_t stretch) const {
    if (frame_.is_on_plane()) {
        return false;
    }
    const auto samples = samples_of(sector, stretch);
    return !samples || glm::any(glm::lessThan(samples->first, glm::dvec2(0.0))) ||
           glm::any(glm::greaterThan(samples->last, last_sample_));
}

// Empty if the ground does not cover the stretch.
std::optional<double> Horizon::slope_of(int sector, std::size_t stretch) const {
    const auto samples = samples_of(sector, stretch);
    const auto ground = samples ? ground_(*samples) : std::nullopt;
    if (!ground) {
        return std::nullopt;
    }
    const double height = lowest_zero_ + ground->low - sagitta_;
    return std::max(frame_.slope_of(radii_[stretch], height),
                    frame_.slope_of(radii_[stretch + 1], height));
}

std::optional<SampleRectangle> Horizon::samples_of(int sector, std::size_t stretch) const {
    const double inner = radii_[stretch];
    const double outer = outside_ * radii_[stretch + 1];
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high(-std::numeric_limits<double>::infinity());
    for (const int border : {sector, sector + 1}) {
        for (const double along : {inner, outer}) {
            const auto sample = sample_at(static_cast<std::size_t>(border), along);
            if (!sample) {
                return std::nullopt;
            }
            low = glm::min(low, *sample);
            high = glm::max(high, *sample);
        }
    }
    if (frame_.is_on_plane()) {
        return SampleRectangle{low, high};
    }
    // The stretch is `deep` and `wide`. Each axis of the samples spans at least its change along
    // both, so that it changes by at most this many samples per metre.
    const double deep = outer - inner;
    const double wide = outer * sector_angle_;
    const glm::dvec2 per_metre = std::hypot(1.0 / deep, 1.0 / wide) * (high - low);
    const double beside = bend_of(std::hypot(deep, wide), geo::smallest_radius_of_earth()) +
                          frame_.drift(outer, heights_apart_);
    return SampleRectangle{low - beside * per_metre, high + beside * per_metre};
}

std::optional<glm::dvec2> Horizon::sample_at(std::size_t border, double along) const {
    const Border& line = borders_[border];
    return line.samples_a_metre && eye_sample_
               ? std::optional(*eye_sample_ + along * *line.samples_a_metre)
               : frame_.sample_at(line.direction, along);
}

} // namespace reljef::terrain
