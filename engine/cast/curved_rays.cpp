#include "engine/cast/curved_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>

#include "engine/cast/packet/block_kernel.h"
#include "engine/cast/tile_nodes.h"
#include "engine/core/parallel_for.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {
namespace {

constexpr double chord_error = 0.005;  // pixels
constexpr double order_error = 0.002;  // where borders of tiles are passed in one direction
constexpr double largest_error = 0.25; // of beams
// Shares of the error that polynomials of the map and along rays may have; the chords have the
// rest.
constexpr double share_of_map = 0.2;
constexpr double share_of_track = 0.1;
constexpr double track_terms = 7.0;    // of a FanTrack's polynomials
constexpr double earth_radius = 6.4e6; // metres

constexpr double far_away = std::numeric_limits<double>::infinity();

// Blocks in which rays are not linear in the pixel are quartered, down to the pixels of beams.
constexpr glm::ivec2 smallest_block(beam_cols, beam_rows);
constexpr double fan_error = 0.005; // pixels, of larger blocks

bool has_eye(const scene::Camera& camera) {
    return camera.projection == scene::ProjectionKind::perspective;
}

// The largest tangent of a latitude: parallels bend by it. Of a globe's part, or of the box around
// a terrain: its own corners may be at a pole, far from what is seen.
double parallel_bend(const CurvedRays::Terrain& terrain) {
    const terrain::Placement& placement = terrain.placement;
    const bool is_globe = placement.columns_all_around().has_value();
    const Box& box = is_globe ? terrain.samples : terrain.local;
    double largest = 0.0;
    for (const double x : {box.low.x, box.high.x}) {
        for (const double y : {box.low.y, box.high.y}) {
            const glm::dvec3 corner(x, y, box.center().z);
            const auto place = placement.geodetic_from_world(
                is_globe ? placement.world_from_sample(corner) : corner);
            largest = std::max(largest, place ? std::abs(std::tan(glm::radians(place->latitude)))
                                              : far_away);
        }
    }
    return largest;
}

// Of a column, a row and a metre of height, at most.
glm::dvec3 metres_of(const terrain::Placement& placement, const Box& samples) {
    constexpr int steps = 16;
    constexpr double part = 0.5; // of a sample
    glm::dvec3 metres(0.0, 0.0, placement.exaggeration());
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j <= steps; ++j) {
            const glm::dvec3 at(glm::dvec2(samples.low) + glm::dvec2(samples.size()) *
                                                              glm::dvec2(i, j) /
                                                              static_cast<double>(steps),
                                samples.high.z);
            const glm::dvec3 here = placement.world_from_sample(at);
            for (int axis = 0; axis < 2; ++axis) {
                glm::dvec3 beside = at;
                beside[axis] += part;
                const double way = glm::distance(placement.world_from_sample(beside), here);
                metres[axis] = std::max(metres[axis], way / part);
            }
        }
    }
    return metres;
}

} // namespace

CurvedRays::CurvedRays(const scene::Camera& camera, glm::ivec2 size, const Terrain& terrain,
                       unsigned threads)
    : local_(local_rays(camera, size, terrain.world_from_local, terrain.local)), terrain_(terrain),
      depths_(depths_of(terrain.local, local_, has_eye(camera))),
      metres_(metres_of(terrain.placement, terrain.samples)),
      columns_around_(terrain.placement.columns_all_around().value_or(0.0)),
      pixel_(view::metres_a_pixel(camera, size)), cols_((size.x + block_side - 1) / block_side) {
    width_ = block_side * pixel_at(depths_.end);
    constexpr double share = share_of_map * chord_error;
    map_.emplace(terrain.placement,
                 SampleMap::Ground{terrain.local, terrain.samples, width_,
                                   has_eye(camera) ? local_.origin.first : terrain.local.center()},
                 SampleMap::Tolerance{share * pixel_.x, share * pixel_.y}, threads);
    const int rows = (size.y + block_side - 1) / block_side;
    const int count = cols_ * rows;
    blocks_.resize(static_cast<std::size_t>(count));
    parallel_for(count,
                 [&](int index) {
                     const glm::ivec2 first = block_side * glm::ivec2(index % cols_, index / cols_);
                     cut({first, glm::ivec2(block_side)}, blocks_[static_cast<std::size_t>(index)]);
                 },
                 {.threads = threads, .stop = {}, .progress = {}});
    for (const std::vector<RayPiece>& pieces : blocks_) {
        for (const RayPiece& piece : pieces) {
            error_ = std::max(error_, piece.error);
        }
    }
    error_ += (share_of_map + share_of_track) * chord_error + order_error;
}

glm::dvec2 CurvedRays::unseen_samples(double t) const {
    return order_error * pixel_at(t) / (std::numbers::sqrt2 * glm::dvec2(metres_));
}

std::optional<glm::dvec3> CurvedRays::sample_at(glm::dvec2 pixel, double t) const {
    const glm::dvec3 place = local_.origin.at(pixel) + t * local_.direction.at(pixel);
    return map_->at(place, share_of_map * chord_error * pixel_at(t));
}

double CurvedRays::tolerance_at(double t) const {
    return (1.0 - share_of_map - share_of_track) * chord_error * pixel_at(t);
}

double CurvedRays::pixel_at(double t) const {
    return pixel_.x + pixel_.y * std::max(t, 0.0);
}

// Of polynomials along rays.
bool CurvedRays::is_unseen(glm::dvec3 difference, double t) const {
    return glm::length(difference * metres_) <= share_of_track * chord_error * pixel_at(t);
}

// Of polynomials of this degree, on an Earth whose map is as smooth as it is itself.
double CurvedRays::track_length(double t) const {
    const double tolerance = share_of_track * chord_error * pixel_at(t);
    return 2.0 * earth_radius * std::pow(tolerance / earth_radius, 1.0 / track_terms);
}

// Cuts the rays of a block.
class CurvedRays::Pieces {
public:
    Pieces(const CurvedRays& rays, const PixelBlock& block)
        : rays_(rays), block_(block), surface_(rays.terrain_.samples) {}

    // Empty: smaller blocks are needed.
    std::optional<std::vector<RayPiece>> run(Interval range) {
        end_ = range.end;
        untracked_until_ = range.begin;
        from_ = fan_at(range.begin);
        length_ = first_length(range.begin);
        was_above_ = from_ && rays_.terrain_.begins_above && is_inside(from_->box);
        is_above_inside_ = was_above_ && is_over_ground(from_->box);
        while (range.begin < range.end && !is_done_) {
            range.begin = advance(range);
            if (is_too_large_ && degree_ == FanDegree::second) {
                return std::nullopt;
            }
            if (is_too_large_) {
                bend_from(range.begin);
            }
        }
        return std::move(pieces_);
    }

private:
    std::optional<RayFan> fan_at(double t) {
        if (!track_at(t) && t >= untracked_until_) {
            make_track(t);
        }
        const FanTrack* const track = track_at(t);
        std::optional<RayFan> fan =
            track != nullptr ? track->fan(t) : ray_fan(block_, degree_, t, sample_of_);
        if (fan) {
            col_ = fan->samples.front().x;
        }
        return fan;
    }

    [[nodiscard]] const FanTrack* track_at(double t) const {
        for (const std::optional<FanTrack>* const track : {&track_, &last_track_}) {
            if (*track && (*track)->has(t)) {
                return &**track;
            }
        }
        return nullptr;
    }

    // The last one is kept: pieces that become shorter may need it.
    void make_track(double begin) {
        constexpr int max_tries = 4;
        double length = std::min(rays_.track_length(begin), end_ - begin);
        last_track_ = track_;
        track_.reset();
        for (int i = 0; i < max_tries && !track_ && length > 0.0; ++i) {
            track_ = FanTrack::create(
                block_, degree_, {begin, begin + length}, sample_of_,
                [&](glm::dvec3 difference, double t) { return rays_.is_unseen(difference, t); });
            length *= 0.5;
        }
        untracked_until_ = track_ ? begin : begin + length;
    }

    // Rays are of second degree from here on.
    void bend_from(double t) {
        degree_ = FanDegree::second;
        is_too_large_ = false;
        track_.reset();
        last_track_.reset();
        untracked_until_ = t;
        from_ = fan_at(t);
    }

    // Returns where what is done ends.
    double advance(Interval range) {
        const double end = std::min(range.begin + length_, range.end);
        const auto halfway = fan_at(0.5 * (range.begin + end));
        const auto to = fan_at(end);
        const bool is_known = from_ && halfway && to;
        is_too_large_ = !is_known && !is_last();
        if (is_too_large_) {
            return range.begin;
        }
        const double min_length = shortest(end);
        const bool is_shortest = end - range.begin <= 1.01 * min_length; // despite rounding
        const bool is_done_there =
            is_known ? advance(*from_, *halfway, *to, is_shortest) : is_shortest;
        is_above_inside_ = is_known && is_above_inside_;
        length_ = std::max(is_known ? length_ : 0.5 * length_, min_length);
        if (!is_done_there) {
            return range.begin;
        }
        from_ = to;
        return end;
    }

    // No block is smaller, no degree higher.
    [[nodiscard]] bool is_last() const {
        return block_.size == smallest_block && degree_ == FanDegree::second;
    }

    [[nodiscard]] double first_length(double t) const {
        return std::sqrt(8.0 * earth_radius * rays_.tolerance_at(std::max(t, 1.0)));
    }
    [[nodiscard]] static double shortest(double t) { return 1e-3 * (1.0 + std::abs(t)); }

    // Whether all until `to` is done; else the length is shorter.
    bool advance(const RayFan& from, const RayFan& halfway, const RayFan& to, bool is_shortest) {
        const glm::dvec3 chord = chord_of(from, halfway, to);
        const glm::dvec3 off_samples =
            chord + glm::max(glm::max(from.misfit, halfway.misfit), to.misfit);
        Box box = from.box;
        box.add(halfway.box);
        box.add(to.box);
        const glm::dvec3 room = 2.0 * off_samples;
        box = {box.low - room, box.high + room};
        const Interval ground = rays_.terrain_.heights.within(box);
        const bool has_ground = ground.begin <= ground.end;
        const bool is_over_all = box.low.z > surface_.high.z;
        const bool is_above = is_over_all || box.low.z > ground.end;
        is_above_inside_ = has_ground && is_inside(box) && (is_above || is_above_inside_);
        if (is_above || is_beside(box)) {
            was_above_ = was_above_ || is_over_all;
            const bool rises =
                halfway.box.low.z > from.box.low.z && to.box.low.z > halfway.box.low.z;
            is_done_ = is_over_all && rises;
            length_ *= 2.0;
            return true;
        }
        is_done_ = has_ended(box, ground);
        if (is_done_) {
            return true;
        }
        const double off = glm::length(chord * metres_) / rays_.tolerance_at(halfway.t);
        if (off > 1.0 && !is_shortest) {
            length_ = (to.t - from.t) * std::clamp(0.9 / std::sqrt(off), 0.2, 0.8);
            return false;
        }
        is_too_large_ =
            !is_last() && std::max(degree_error_of(from), degree_error_of(to)) > fan_error;
        if (is_too_large_) {
            return false;
        }
        add(from, to, chord);
        length_ = (to.t - from.t) * std::clamp(0.9 / std::sqrt(off), 0.5, 4.0);
        return true;
    }

    // Whether rays that were above the ground are below it. `ground`: in the box.
    [[nodiscard]] bool has_ended(const Box& box, Interval ground) const {
        return (was_above_ && box.high.z < surface_.low.z) ||
               (is_above_inside_ && box.high.z < ground.begin);
    }

    // Between the chords of the rays and the rays halfway.
    [[nodiscard]] static glm::dvec3 chord_of(const RayFan& from, const RayFan& halfway,
                                             const RayFan& to) {
        glm::dvec3 largest(0.0);
        for (std::size_t i = 0; i < from.count; ++i) {
            const glm::dvec3 chord = 0.5 * (from.samples[i] + to.samples[i]);
            largest = glm::max(largest, glm::abs(chord - halfway.samples[i]));
        }
        return largest;
    }

    // Pixels. A chord is off by 4 s (1 - s) times its middle at the part s of its length.
    [[nodiscard]] double error_of(const RayFan& from, const RayFan& to, glm::dvec3 chord) const {
        const double near = rays_.pixel_at(from.t);
        const double far = rays_.pixel_at(to.t);
        const double off = glm::length(chord * metres_);
        return std::min(off / near, 4.0 * off / (far - near)) +
               std::max(misfit_of(from), misfit_of(to)) +
               std::max(unordered_of(from), unordered_of(to));
    }
    // Of bent rays: what their order by tiles misses, or by how much those of a beam that has none
    // are moved when they become linear.
    [[nodiscard]] double unordered_of(const RayFan& fan) const { // pixels
        const glm::dvec2 part = glm::dvec2(block_.size) / static_cast<double>(course_parts);
        const glm::dvec3 bulge =
            glm::max(fan.vectors.bulge(part), 0.5 * fan.vectors.bulge(glm::dvec2(smallest_block)));
        return glm::length(bulge * metres_) / rays_.pixel_at(fan.t);
    }
    [[nodiscard]] double misfit_of(const RayFan& fan) const { // pixels
        return glm::length(fan.misfit * metres_) / rays_.pixel_at(fan.t);
    }
    // Where the second degree is large, a fourth may not show at the places of a fan.
    [[nodiscard]] double degree_error_of(const RayFan& fan) const { // pixels
        constexpr double share = 1.0 / 128.0;
        const glm::dvec3 bulge = fan.vectors.bulge(glm::dvec2(block_.size));
        return std::max(misfit_of(fan),
                        share * glm::length(bulge * metres_) / rays_.pixel_at(fan.t));
    }

    // Over or under the surface.
    [[nodiscard]] bool is_inside(const Box& box) const {
        return glm::all(glm::greaterThan(glm::dvec2(box.low), glm::dvec2(surface_.low))) &&
               glm::all(glm::lessThan(glm::dvec2(box.high), glm::dvec2(surface_.high)));
    }

    [[nodiscard]] bool is_over_ground(const Box& box) const {
        const Interval ground = rays_.terrain_.heights.within(box);
        return ground.begin <= ground.end && box.low.z > ground.end;
    }

    [[nodiscard]] bool is_beside(const Box& box) const {
        return glm::any(glm::lessThan(glm::dvec2(box.high), glm::dvec2(surface_.low))) ||
               glm::any(glm::greaterThan(glm::dvec2(box.low), glm::dvec2(surface_.high)));
    }

    void add(const RayFan& from, const RayFan& to, glm::dvec3 chord) {
        RayPiece& piece = pieces_.emplace_back();
        piece.rays = straight_between(from.vectors, to.vectors, {from.t, to.t}, rays_.local_);
        piece.error = error_of(from, to, chord);
        piece.block = block_;
    }

    const CurvedRays& rays_;
    const PixelBlock& block_;
    // Columns of a globe are those next to the last ones.
    SampleOfRay sample_of_ = [this](glm::dvec2 pixel, double t) {
        auto sample = rays_.sample_at(pixel, t);
        if (sample && rays_.columns_around_ > 0.0) {
            col_ = col_.value_or(sample->x);
            sample->x -=
                rays_.columns_around_ * std::round((sample->x - *col_) / rays_.columns_around_);
        }
        return sample;
    };
    std::optional<double> col_;
    FanDegree degree_ = FanDegree::linear;
    const Box& surface_;
    glm::dvec3 metres_ = rays_.metres_;
    double length_ = 0.0;
    bool was_above_ = false;
    bool is_above_inside_ = false; // was above the ground, and beside none since
    bool is_done_ = false;
    bool is_too_large_ = false; // the block, for the degree
    double end_ = 0.0;          // of all depths
    std::optional<RayFan> from_;
    std::optional<FanTrack> track_;
    std::optional<FanTrack> last_track_;
    double untracked_until_ = 0.0; // depth
    std::vector<RayPiece> pieces_;
};

void CurvedRays::cut(const PixelBlock& block, std::vector<RayPiece>& pieces) const {
    const glm::dvec2 middle = glm::dvec2(block.first) + 0.5 * glm::dvec2(block.size);
    const double width = std::max(block.size.x, block.size.y) * pixel_at(depths_.end);
    const Interval depths{std::max(local_.range.begin, local_.anchor),
                          std::min(local_.range.end, depths_.end + width)};
    const Box wider{terrain_.local.low - width, terrain_.local.high + width};
    const auto range =
        intersect({local_.origin.at(middle), local_.direction.at(middle)}, wider, depths);
    if (!range) {
        return;
    }
    if (auto found = Pieces(*this, block).run(*range)) {
        pieces.insert(pieces.end(), found->begin(), found->end());
        return;
    }
    const glm::ivec2 size = glm::max(block.size / 2, smallest_block);
    for (int row = 0; row < block.size.y; row += size.y) {
        for (int col = 0; col < block.size.x; col += size.x) {
            cut({block.first + glm::ivec2(col, row), size}, pieces);
        }
    }
}

bool show_little_bend(const scene::Camera& camera, glm::ivec2 size,
                      const CurvedRays::Terrain& terrain) {
    const PictureRays rays = local_rays(camera, size, terrain.world_from_local, terrain.local);
    const glm::dvec2 pixel(view::metres_a_pixel(camera, size));
    const double depth = depths_of(terrain.local, rays, has_eye(camera)).end;
    const double width = smallest_block.x * (pixel.x + pixel.y * std::max(depth, 0.0));
    // The middle of a block above the chord between its sides, and beside that of a parallel. Rays
    // of second degree follow it, but for about a third of the angle by which it bends.
    const double angle = (1.0 + parallel_bend(terrain)) * width / earth_radius;
    const double off = angle * smallest_block.x / 8.0;
    return off * std::min(angle / 3.0, 1.0) <= largest_error;
}

} // namespace reljef::cast
