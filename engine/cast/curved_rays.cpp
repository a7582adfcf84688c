#include "engine/cast/curved_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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

constexpr double chord_error = 0.005; // pixels
constexpr double order_error = 0.002; // where borders of tiles are passed in one direction
// Shares of the error that polynomials of the map and along rays may have; the chords have the
// rest.
constexpr double share_of_map = 0.2;
constexpr double share_of_track = 0.1;
constexpr double track_terms = 7.0;    // of a FanTrack's polynomials
constexpr double earth_radius = 6.4e6; // metres

// Pixels by which rays that depend on the pixel may be off in blocks of several, and in one: there,
// one ray for all of the pixel is off by 0.7.
constexpr double fan_error = 0.005;
constexpr double fan_error_in_pixel = 0.1;

// Of pieces, parts of the depth and a metre: a hundredth of a pixel, and where rays have no sample,
// a pixel.
constexpr double shortest = 1e-5;
constexpr double shortest_unknown = 1e-3;

bool has_eye(const scene::Camera& camera) {
    return camera.projection == scene::ProjectionKind::perspective;
}

} // namespace

CurvedRays::CurvedRays(const scene::Camera& camera, glm::ivec2 size, const Terrain& terrain,
                       const Options& options)
    : local_(local_rays(camera, size, terrain.world_from_local, terrain.local)), terrain_(terrain),
      middles_only_(options.middles_only),
      depths_(depths_of(terrain.local, local_, has_eye(camera))),
      earth_(terrain.placement, terrain.rows, terrain.samples),
      is_globe_(terrain.placement.columns_all_around().has_value()),
      columns_around_(terrain.placement.columns_all_around().value_or(earth_.columns_around())),
      pixel_(scene::metres_a_pixel(camera, size)), cols_((size.x + block_side - 1) / block_side) {
    width_ = block_side * pixel_at(depths_.end);
    constexpr double share = share_of_map * chord_error;
    map_.emplace(earth_,
                 SampleMap::Ground{terrain.local, terrain.samples, width_,
                                   has_eye(camera) ? local_.origin.first : terrain.local.center()},
                 SampleMap::Tolerance{share * pixel_.x, share * pixel_.y}, options.threads);
    const int rows = (size.y + block_side - 1) / block_side;
    const int count = cols_ * rows;
    blocks_.resize(static_cast<std::size_t>(count));
    parallel_for(count,
                 [&](int index) {
                     const glm::ivec2 first = block_side * glm::ivec2(index % cols_, index / cols_);
                     cut({first, glm::ivec2(block_side)}, blocks_[static_cast<std::size_t>(index)]);
                 },
                 {.threads = options.threads, .stop = {}, .progress = {}});
    for (const std::vector<RayPiece>& pieces : blocks_) {
        for (const RayPiece& piece : pieces) {
            error_ = std::max(error_, piece.error);
        }
    }
    // Rays may be moved twice: to be linear, and to have an order.
    error_ += (share_of_map + share_of_track) * chord_error + 2.0 * order_error;
}

glm::dvec2 CurvedRays::unseen_samples(const RayPiece& piece, double t) const {
    return order_error * pixel_at(t) / (std::numbers::sqrt2 * glm::dvec2(piece.metres));
}

bool CurvedRays::is_linear(const RayPiece& piece) const {
    const auto off = [&](double t) {
        const glm::dvec3 bulge = places_at(piece.rays, t).bulge(glm::dvec2(piece.block.size));
        return glm::length(bulge * piece.metres) / pixel_at(t);
    };
    const Interval depths = piece.rays.range;
    return std::max(off(depths.begin), off(depths.end)) <= order_error;
}

std::optional<glm::dvec3> CurvedRays::sample_at(glm::dvec2 pixel, double t) const {
    const glm::dvec3 place = local_.origin.at(pixel) + t * local_.direction.at(pixel);
    return map_->at(place, share_of_map * chord_error * pixel_at(t));
}

// Columns around the Earth between a box and the terrain: the first and the last turn. No ray
// passes more than half of one, but bounds may be wider. Tiles of a globe follow its turns by
// themselves.
Interval CurvedRays::turns_of(const Box& box) const {
    if (is_globe_ || !(columns_around_ > 0.0)) {
        return {0.0, 0.0};
    }
    const auto turn_at = [&](double col) {
        return columns_around_ * std::round((col - terrain_.samples.center().x) / columns_around_);
    };
    const double middle = turn_at(box.center().x);
    return {std::max(turn_at(box.low.x), middle - columns_around_),
            std::min(turn_at(box.high.x), middle + columns_around_)};
}

double CurvedRays::tolerance_at(double t) const {
    return (1.0 - share_of_map - share_of_track) * chord_error * pixel_at(t);
}

double CurvedRays::pixel_at(double t) const {
    return pixel_.x + pixel_.y * std::max(t, 0.0);
}

// Of polynomials along rays.
bool CurvedRays::is_unseen(glm::dvec3 found, glm::dvec3 sample, double t) const {
    const Interval rows{std::min(found.y, sample.y), std::max(found.y, sample.y)};
    return glm::length((found - sample) * earth_.metres_a_sample(rows)) <=
           share_of_track * chord_error * pixel_at(t);
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
        : rays_(rays), block_(block),
          middle_(glm::dvec2(block.first) + 0.5 * glm::dvec2(block.size)),
          surface_(rays.terrain_.samples) {
        if (block.size != glm::ivec2(block_side)) { // a part, as two degrees were not enough
            degree_ = degree_after(FanDegree::linear);
        }
    }

    // Empty: smaller blocks are needed.
    std::optional<std::vector<RayPiece>> run(Interval range) {
        end_ = range.end;
        untracked_until_ = range.begin;
        col_ = surface_.center().x;
        if (const auto middle = sample_of_(middle_, range.begin)) {
            col_ = middle->x;
        }
        begin_at(fan_at(range.begin));
        length_ = first_length(range.begin);
        if (from_ && rays_.terrain_.begins_above) {
            const Interval turns = rays_.turns_of(from_->box);
            was_above_ = is_inside(from_->box, turns);
            is_above_inside_ = was_above_ && is_over_ground(from_->box, turns);
        }
        while (range.begin < range.end && !is_done_) {
            range.begin = advance(range);
            if (is_too_large_ && degree_ == FanDegree::second && !is_pixel()) {
                return std::nullopt;
            }
            if (is_too_large_) {
                change_degree(range.begin);
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
        return track != nullptr ? track->fan(t) : ray_fan(block_, degree_, t, sample_of_);
    }

    // Columns continue those of the ray in the middle: rays at the border of a block may pass a
    // pole exactly.
    void begin_at(const std::optional<RayFan>& fan) {
        from_ = fan;
        if (from_) {
            col_ = from_->samples[from_->middle()].x;
        }
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
            track_ = FanTrack::create(block_, degree_, {begin, begin + length}, sample_of_,
                                      [&](glm::dvec3 found, glm::dvec3 sample, double t) {
                                          return rays_.is_unseen(found, sample, t);
                                      });
            length *= 0.5;
        }
        untracked_until_ = track_ ? begin : begin + length;
    }

    [[nodiscard]] bool is_pixel() const { return block_.size == glm::ivec2(1); }

    [[nodiscard]] FanDegree degree_after(FanDegree degree) const {
        const bool is_bent = degree == FanDegree::second || (is_pixel() && rays_.middles_only_);
        return is_bent ? FanDegree::constant : FanDegree::second;
    }

    // Rays have another degree from a depth on.
    void change_degree(double t) {
        degree_ = degree_after(degree_);
        is_too_large_ = false;
        track_.reset();
        last_track_.reset();
        untracked_until_ = t;
        begin_at(fan_at(t));
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
        const double min_length = (is_known ? shortest : shortest_unknown) * (1.0 + std::abs(end));
        constexpr double despite_rounding = 1.01;
        const bool is_shortest = end - range.begin <= despite_rounding * min_length;
        const bool is_done_there =
            is_known ? advance(*from_, *halfway, *to, is_shortest) : is_shortest;
        is_above_inside_ = is_known && is_above_inside_;
        length_ = std::max(is_known ? length_ : 0.5 * length_, min_length);
        if (!is_done_there) {
            return range.begin;
        }
        begin_at(to);
        return end;
    }

    // No rays follow the Earth better.
    [[nodiscard]] bool is_last() const { return degree_ == FanDegree::constant; }

    [[nodiscard]] double first_length(double t) const {
        return std::sqrt(8.0 * earth_radius * rays_.tolerance_at(std::max(t, 1.0)));
    }

    // Whether all until `to` is done; else the length is shorter.
    bool advance(const RayFan& from, const RayFan& halfway, const RayFan& to, bool is_shortest) {
        const glm::dvec3 chord = chord_of(from, halfway, to);
        const Box box = box_around(from, halfway, to, chord);
        const Interval turns = rays_.turns_of(box);
        const Interval ground = ground_in(box, turns);
        const bool has_ground = ground.begin <= ground.end;
        const bool is_over_all = box.low.z > surface_.high.z;
        const bool is_above = is_over_all || box.low.z > ground.end;
        is_above_inside_ = has_ground && is_inside(box, turns) && (is_above || is_above_inside_);
        if (is_above || is_beside(box, turns)) {
            was_above_ = was_above_ || is_over_all;
            const bool rises =
                halfway.box.low.z > from.box.low.z && to.box.low.z > halfway.box.low.z;
            is_done_ = is_over_all && rises;
            length_ *= 2.0;
            return true;
        }
        is_done_ = has_ended(box, ground);
        return is_done_ ||
               add(from, to, {chord, rays_.earth_.metres_a_sample({box.low.y, box.high.y})}, turns,
                   is_shortest);
    }

    // Around all rays of a piece.
    [[nodiscard]] static Box box_around(const RayFan& from, const RayFan& halfway, const RayFan& to,
                                        glm::dvec3 chord) {
        const glm::dvec3 off = chord + glm::max(glm::max(from.misfit, halfway.misfit), to.misfit);
        Box box = from.box;
        box.add(halfway.box);
        box.add(to.box);
        const glm::dvec3 room = 2.0 * off;
        return {box.low - room, box.high + room};
    }

    struct Chord {
        glm::dvec3 off{0.0};    // in its middle, samples
        glm::dvec3 metres{1.0}; // of these
    };

    // Adds a piece, unless it is too long, or the rays bend too much.
    bool add(const RayFan& from, const RayFan& to, const Chord& chord, Interval turns,
             bool is_shortest) {
        const double middle = 0.5 * (from.t + to.t);
        const double off = glm::length(chord.off * chord.metres) / rays_.tolerance_at(middle);
        if (off > 1.0 && !is_shortest) {
            length_ = (to.t - from.t) * std::clamp(0.9 / std::sqrt(off), 0.2, 0.8);
            return false;
        }
        is_too_large_ = !is_last() && std::max(degree_error_of(from, chord.metres),
                                               degree_error_of(to, chord.metres)) >
                                          (is_pixel() ? fan_error_in_pixel : fan_error);
        if (is_too_large_) {
            return false;
        }
        const bool is_east = to.samples[to.middle()].x > from.samples[from.middle()].x;
        for (const double turn : turns_between(turns, is_east)) {
            add_piece(from, to, chord, turn);
        }
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
    [[nodiscard]] double error_of(const RayFan& from, const RayFan& to, const Chord& chord) const {
        const double near = rays_.pixel_at(from.t);
        const double far = rays_.pixel_at(to.t);
        const double off = glm::length(chord.off * chord.metres);
        const double of_chord =
            far > near ? std::min(off / near, 4.0 * off / (far - near)) : off / near;
        if (degree_ == FanDegree::constant) {
            const double in_pixel = 0.5 * std::numbers::sqrt2; // from its middle to its corner
            return of_chord + (rays_.middles_only_ ? 0.0 : in_pixel);
        }
        return of_chord +
               std::max(in_pixels(from, from.misfit, chord.metres),
                        in_pixels(to, to.misfit, chord.metres)) +
               std::max(unordered_of(from, chord.metres), unordered_of(to, chord.metres));
    }
    [[nodiscard]] double in_pixels(const RayFan& fan, glm::dvec3 samples, glm::dvec3 metres) const {
        return glm::length(samples * metres) / rays_.pixel_at(fan.t);
    }
    // Pixels, of bent rays: what their order by tiles misses, or by how much those of a pixel are
    // moved when they become linear.
    [[nodiscard]] double unordered_of(const RayFan& fan, glm::dvec3 metres) const {
        const glm::dvec2 part = glm::dvec2(block_.size) / static_cast<double>(course_parts);
        return in_pixels(fan, glm::max(fan.vectors.bulge(part), fan.vectors.bulge(glm::dvec2(1.0))),
                         metres);
    }
    // Pixels. Where the second degree is large, a fourth may not show at the places of a fan.
    [[nodiscard]] double degree_error_of(const RayFan& fan, glm::dvec3 metres) const {
        constexpr double share = 1.0 / 128.0;
        const glm::dvec3 bulge = fan.vectors.bulge(glm::dvec2(block_.size));
        return std::max(in_pixels(fan, fan.misfit, metres), share * in_pixels(fan, bulge, metres));
    }

    // A box among the terrain's own columns.
    [[nodiscard]] static Box without_turn(const Box& box, double turn) {
        const glm::dvec3 by(turn, 0.0, 0.0);
        return {box.low - by, box.high - by};
    }

    // In the order of rays that lead east, or west.
    [[nodiscard]] std::vector<double> turns_between(Interval turns, bool is_east) const {
        std::vector<double> between{turns.begin};
        while (between.back() < turns.end) {
            between.push_back(std::min(between.back() + rays_.columns_around_, turns.end));
        }
        if (!is_east) {
            std::reverse(between.begin(), between.end());
        }
        return between;
    }

    // Bounds of the ground that a box may meet.
    [[nodiscard]] Interval ground_in(const Box& box, Interval turns) const {
        const HeightBounds& heights = rays_.terrain_.heights;
        Interval ground = heights.within(without_turn(box, turns.begin));
        for (double turn = turns.begin; turn < turns.end;) {
            turn = std::min(turn + rays_.columns_around_, turns.end);
            const Interval found = heights.within(without_turn(box, turn));
            ground = {std::min(ground.begin, found.begin), std::max(ground.end, found.end)};
        }
        return ground;
    }

    // Over or under the surface.
    [[nodiscard]] bool is_inside(const Box& box, Interval turns) const {
        const Box own = without_turn(box, turns.begin);
        return turns.begin == turns.end &&
               glm::all(glm::greaterThan(glm::dvec2(own.low), glm::dvec2(surface_.low))) &&
               glm::all(glm::lessThan(glm::dvec2(own.high), glm::dvec2(surface_.high)));
    }

    [[nodiscard]] bool is_over_ground(const Box& box, Interval turns) const {
        const Interval ground = ground_in(box, turns);
        return ground.begin <= ground.end && box.low.z > ground.end;
    }

    [[nodiscard]] bool is_beside(const Box& box, Interval turns) const {
        const auto is_beside_in = [&](double turn) {
            const Box own = without_turn(box, turn);
            return glm::any(glm::lessThan(glm::dvec2(own.high), glm::dvec2(surface_.low))) ||
                   glm::any(glm::greaterThan(glm::dvec2(own.low), glm::dvec2(surface_.high)));
        };
        bool is_beside = is_beside_in(turns.begin);
        for (double turn = turns.begin; is_beside && turn < turns.end;) {
            turn = std::min(turn + rays_.columns_around_, turns.end);
            is_beside = is_beside_in(turn);
        }
        return is_beside;
    }

    void add_piece(const RayFan& from, const RayFan& to, const Chord& chord, double turn) {
        RayPiece& piece = pieces_.emplace_back();
        piece.rays =
            in_samples(straight_between(from.vectors, to.vectors, {from.t, to.t}, rays_.local_),
                       glm::dvec2(1.0), {-turn, 0.0});
        piece.error = error_of(from, to, chord);
        piece.metres = chord.metres;
        piece.block = block_;
    }

    const CurvedRays& rays_;
    const PixelBlock& block_;
    glm::dvec2 middle_; // pixel
    // Columns around the Earth are those next to where a piece begins.
    SampleOfRay sample_of_ = [this](glm::dvec2 pixel, double t) {
        auto sample = rays_.sample_at(pixel, t);
        if (sample && rays_.columns_around_ > 0.0) {
            sample->x -=
                rays_.columns_around_ * std::round((sample->x - col_) / rays_.columns_around_);
        }
        return sample;
    };
    double col_ = 0.0; // where a piece begins
    FanDegree degree_ = FanDegree::linear;
    const Box& surface_;
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
    const glm::ivec2 size = part_size(block.size);
    for (int row = 0; row < block.size.y; row += size.y) {
        for (int col = 0; col < block.size.x; col += size.x) {
            cut({block.first + glm::ivec2(col, row), size}, pieces);
        }
    }
}

} // namespace reljef::cast
