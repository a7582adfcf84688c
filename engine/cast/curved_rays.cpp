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
#include "engine/core/parallel_for.h"
#include "engine/view/draw_list.h"

namespace reljef::cast {
namespace {

constexpr double chord_error = 0.005;  // pixels
constexpr double order_error = 0.002;  // where borders of tiles are passed in one direction
constexpr double largest_error = 0.25; // of rays that are not linear in the pixel
// Share of the error that the polynomial may have; the chords have the rest.
constexpr double share_of_map = 0.2;
constexpr double earth_radius = 6.4e6; // metres

constexpr double far_away = std::numeric_limits<double>::infinity();

// Of a block, parts of its sides: corners, middle, and the middles of two sides.
constexpr std::array places{glm::dvec2(0.0, 0.0), glm::dvec2(1.0, 0.0), glm::dvec2(0.0, 1.0),
                            glm::dvec2(1.0, 1.0), glm::dvec2(0.5, 0.5), glm::dvec2(1.0, 0.5),
                            glm::dvec2(0.5, 1.0)};

// Blocks in which rays are not linear in the pixel are quartered, down to the pixels of beams.
constexpr glm::ivec2 smallest_block(beam_cols, beam_rows);
constexpr double fan_error = 0.005; // pixels, of larger blocks

glm::dvec2 pixel_at(const PixelBlock& block, glm::dvec2 part) {
    return glm::dvec2(block.first) + part * glm::dvec2(block.size);
}

bool has_eye(const scene::Camera& camera) {
    return camera.projection == scene::ProjectionKind::perspective;
}

// The largest tangent of a latitude of the box: parallels bend by it.
double parallel_bend(const terrain::Placement& placement, const Box& local) {
    double largest = 0.0;
    for (const double x : {local.low.x, local.high.x}) {
        for (const double y : {local.low.y, local.high.y}) {
            const auto place = placement.geodetic_from_world({x, y, local.center().z});
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

// The rays of a block at a depth.
struct CurvedRays::Fan {
    double t = 0.0;
    std::array<glm::dvec3, places.size()> samples{};
    PictureRays::Vectors linear; // in the pixel of the picture
    glm::dvec3 bend{0.0};        // between this and the samples, at most
    Box box;
};

CurvedRays::CurvedRays(const scene::Camera& camera, glm::ivec2 size, const Terrain& terrain,
                       unsigned threads)
    : local_(local_rays(camera, size, terrain.world_from_local, terrain.local)), terrain_(terrain),
      depths_(depths_of(terrain.local, local_, has_eye(camera))),
      metres_(metres_of(terrain.placement, terrain.samples)),
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
    error_ += share_of_map * chord_error + order_error;
}

glm::dvec2 CurvedRays::unseen_samples(double t) const {
    return order_error * pixel_at(t) / (std::numbers::sqrt2 * glm::dvec2(metres_));
}

std::optional<glm::dvec3> CurvedRays::sample_at(glm::dvec2 pixel, double t) const {
    const glm::dvec3 place = local_.origin.at(pixel) + t * local_.direction.at(pixel);
    return map_->at(place, share_of_map * chord_error * pixel_at(t));
}

double CurvedRays::tolerance_at(double t) const {
    return (1.0 - share_of_map) * chord_error * pixel_at(t);
}

double CurvedRays::pixel_at(double t) const {
    return pixel_.x + pixel_.y * std::max(t, 0.0);
}

// Linear between the corners, halfway to the middle.
std::optional<CurvedRays::Fan> CurvedRays::fan_at(const PixelBlock& block, double t) const {
    Fan fan;
    fan.t = t;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto sample = sample_at(reljef::cast::pixel_at(block, places[i]), t);
        if (!sample || glm::any(glm::isnan(*sample)) || glm::any(glm::isinf(*sample))) {
            return std::nullopt;
        }
        fan.samples[i] = *sample;
        fan.box.add(*sample);
    }
    const auto& at = fan.samples;
    fan.linear.right = (at[1] - at[0] + at[3] - at[2]) / (2.0 * block.size.x);
    fan.linear.down = (at[2] - at[0] + at[3] - at[1]) / (2.0 * block.size.y);
    const glm::dvec3 middle = 0.5 * (0.25 * (at[0] + at[1] + at[2] + at[3]) + at[4]);
    const glm::dvec2 pixel = reljef::cast::pixel_at(block, glm::dvec2(0.5));
    fan.linear.first = middle - pixel.x * fan.linear.right - pixel.y * fan.linear.down;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::dvec3 found = fan.linear.at(reljef::cast::pixel_at(block, places[i]));
        fan.bend = glm::max(fan.bend, glm::abs(found - at[i]));
    }
    return fan;
}

// Cuts the rays of a block.
class CurvedRays::Pieces {
public:
    Pieces(const CurvedRays& rays, const PixelBlock& block)
        : rays_(rays), block_(block), surface_(rays.terrain_.samples),
          is_smallest_(block.size == smallest_block) {}

    // Empty: smaller blocks are needed.
    std::optional<std::vector<RayPiece>> run(Interval range) {
        std::optional<Fan> from = rays_.fan_at(block_, range.begin);
        length_ = first_length(range.begin);
        was_above_ = from && is_inside(from->box);
        while (range.begin < range.end && !is_done_) {
            const double end = std::min(range.begin + length_, range.end);
            const auto halfway = rays_.fan_at(block_, 0.5 * (range.begin + end));
            const auto to = rays_.fan_at(block_, end);
            const bool is_known = from && halfway && to;
            is_too_large_ = is_too_large_ || (!is_known && !is_smallest_);
            if (is_too_large_) {
                return std::nullopt;
            }
            const double min_length = shortest(end);
            const bool is_shortest = end - range.begin <= 1.01 * min_length; // despite rounding
            if (is_known ? advance(*from, *halfway, *to, is_shortest) : is_shortest) {
                range.begin = end;
                from = to;
            }
            length_ = std::max(is_known ? length_ : 0.5 * length_, min_length);
        }
        return is_too_large_ ? std::nullopt : std::optional(std::move(pieces_));
    }

private:
    [[nodiscard]] double first_length(double t) const {
        return std::sqrt(8.0 * earth_radius * rays_.tolerance_at(std::max(t, 1.0)));
    }
    [[nodiscard]] static double shortest(double t) { return 1e-3 * (1.0 + std::abs(t)); }

    // Whether all until `to` is done; else the length is shorter.
    bool advance(const Fan& from, const Fan& halfway, const Fan& to, bool is_shortest) {
        const glm::dvec3 chord = chord_of(from, halfway, to);
        const glm::dvec3 bend = chord + glm::max(glm::max(from.bend, halfway.bend), to.bend);
        Box box = from.box;
        box.add(halfway.box);
        box.add(to.box);
        const glm::dvec3 room = 2.0 * bend;
        box = {box.low - room, box.high + room};
        const bool is_above = box.low.z > surface_.high.z;
        if (is_above || is_beside(box)) {
            was_above_ = was_above_ || is_above;
            const bool rises =
                halfway.box.low.z > from.box.low.z && to.box.low.z > halfway.box.low.z;
            is_done_ = is_above && rises;
            length_ *= 2.0;
            return true;
        }
        if (was_above_ && box.high.z < surface_.low.z) {
            is_done_ = true;
            return true;
        }
        const double off = glm::length(chord * metres_) / rays_.tolerance_at(halfway.t);
        if (off > 1.0 && !is_shortest) {
            length_ = (to.t - from.t) * std::clamp(0.9 / std::sqrt(off), 0.2, 0.8);
            return false;
        }
        is_too_large_ = !is_smallest_ && std::max(bend_of(from), bend_of(to)) > fan_error;
        is_done_ = is_too_large_;
        add(from, to, chord);
        length_ = (to.t - from.t) * std::clamp(0.9 / std::sqrt(off), 0.5, 4.0);
        return true;
    }

    // Between the chords of the rays and the rays halfway.
    [[nodiscard]] static glm::dvec3 chord_of(const Fan& from, const Fan& halfway, const Fan& to) {
        glm::dvec3 largest(0.0);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const glm::dvec3 chord = 0.5 * (from.samples[i] + to.samples[i]);
            largest = glm::max(largest, glm::abs(chord - halfway.samples[i]));
        }
        return largest;
    }

    // Pixels. A chord is off by 4 s (1 - s) times its middle at the part s of its length.
    [[nodiscard]] double error_of(const Fan& from, const Fan& to, glm::dvec3 chord) const {
        const double near = rays_.pixel_at(from.t);
        const double far = rays_.pixel_at(to.t);
        const double off = glm::length(chord * metres_);
        return std::min(off / near, 4.0 * off / (far - near)) +
               std::max(bend_of(from), bend_of(to));
    }
    [[nodiscard]] double bend_of(const Fan& fan) const { // pixels
        return glm::length(fan.bend * metres_) / rays_.pixel_at(fan.t);
    }

    // Over or under the surface.
    [[nodiscard]] bool is_inside(const Box& box) const {
        return glm::all(glm::greaterThan(glm::dvec2(box.low), glm::dvec2(surface_.low))) &&
               glm::all(glm::lessThan(glm::dvec2(box.high), glm::dvec2(surface_.high)));
    }

    [[nodiscard]] bool is_beside(const Box& box) const {
        return glm::any(glm::lessThan(glm::dvec2(box.high), glm::dvec2(surface_.low))) ||
               glm::any(glm::greaterThan(glm::dvec2(box.low), glm::dvec2(surface_.high)));
    }

    void add(const Fan& from, const Fan& to, glm::dvec3 chord) {
        RayPiece& piece = pieces_.emplace_back();
        piece.rays = straight_between(from.linear, to.linear, {from.t, to.t}, rays_.local_);
        piece.error = error_of(from, to, chord);
        piece.block = block_;
    }

    const CurvedRays& rays_;
    const PixelBlock& block_;
    const Box& surface_;
    glm::dvec3 metres_ = rays_.metres_;
    double length_ = 0.0;
    bool was_above_ = false;
    bool is_done_ = false;
    bool is_smallest_;
    bool is_too_large_ = false; // the block
    std::vector<RayPiece> pieces_;
};

void CurvedRays::cut(const PixelBlock& block, std::vector<RayPiece>& pieces) const {
    const glm::dvec2 middle = reljef::cast::pixel_at(block, glm::dvec2(0.5));
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

bool are_linear(const scene::Camera& camera, glm::ivec2 size, const glm::dmat4& world_from_local,
                const terrain::Placement& placement, const Box& local) {
    const PictureRays rays = local_rays(camera, size, world_from_local, local);
    const glm::dvec2 pixel(view::metres_a_pixel(camera, size));
    const double depth = depths_of(local, rays, has_eye(camera)).end;
    const double width = smallest_block.x * (pixel.x + pixel.y * std::max(depth, 0.0));
    // The middle of a block above the chord between its sides, and beside that of a parallel.
    const double off =
        (1.0 + parallel_bend(placement, local)) * width * smallest_block.x / (8.0 * earth_radius);
    return off <= largest_error;
}

} // namespace reljef::cast
