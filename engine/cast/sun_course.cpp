#include "engine/cast/sun_course.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "engine/terrain/field/gradient.h"
#include "engine/terrain/field/sample_polynomial.h"

namespace reljef::cast {
namespace {

constexpr double max_earth_radius = 6.4e6; // of curvature, metres: 6,399,594 m at the poles

constexpr std::size_t node_count = 5; // along columns and rows
constexpr std::size_t part_count = 4; // along a ray
constexpr std::size_t max_chords = 512;

// Chebyshev's places in (-1, 1).
template <std::size_t count> double chebyshev_place(std::size_t index) {
    return std::cos(std::numbers::pi * (2.0 * static_cast<double>(index) + 1.0) /
                    (2.0 * static_cast<double>(count)));
}

// Coefficients of Chebyshev's polynomials, the lowest power first.
constexpr std::array<std::array<double, node_count>, node_count> chebyshev_terms{
    {{1.0, 0.0, 0.0, 0.0, 0.0},
     {0.0, 1.0, 0.0, 0.0, 0.0},
     {-1.0, 0.0, 2.0, 0.0, 0.0},
     {0.0, -3.0, 0.0, 4.0, 0.0},
     {1.0, 0.0, -8.0, 0.0, 8.0}}};

// terms[power][node]: from values at Chebyshev's places to the coefficients of their polynomial of
// a degree below `side`.
std::array<std::array<double, node_count>, node_count> terms_from_values(std::size_t side) {
    std::array<std::array<double, node_count>, node_count> terms{};
    for (std::size_t node = 0; node < node_count; ++node) {
        const double x = chebyshev_place<node_count>(node);
        for (std::size_t degree = 0; degree < side; ++degree) {
            double value = 0.0;
            for (std::size_t power = node_count; power-- > 0;) {
                value = value * x + chebyshev_terms[degree][power];
            }
            const double weight = (degree == 0 ? 1.0 : 2.0) * value / double{node_count};
            for (std::size_t power = 0; power <= degree; ++power) {
                terms[power][node] += weight * chebyshev_terms[degree][power];
            }
        }
    }
    return terms;
}

std::array<double, part_count> part_places() {
    std::array<double, part_count> places{};
    for (std::size_t i = 0; i < part_count; ++i) {
        places[i] = 0.5 + 0.5 * chebyshev_place<part_count>(i);
    }
    return places;
}

// Places in a box, to its corners: `side` along columns and rows, two heights.
template <class Body> void for_each_place(const Box& box, int side, const Body& body) {
    for (int i = 0; i < 2 * side * side; ++i) {
        const int place = i / 2;
        const glm::ivec2 at(place % side, place / side);
        const glm::dvec3 part(glm::dvec2(at) / (side - 1.0), i % 2);
        body(box.low + part * box.size());
    }
}

// Metres that rays to the sun have below the highest ground, at most: from the lowest, upwards over
// a bent Earth, and no longer than all ground is wide.
double reach_over(const terrain::Placement& placement, glm::dvec3 to_sun,
                  const SunCourse::Ground& ground) {
    double sine = 1.0; // of the sun's lowest altitude
    for_each_place(ground.lit, 3, [&](glm::dvec3 sample) {
        sine = std::min(sine, glm::dot(placement.up(placement.world_from_sample(sample)), to_sun));
    });
    Box world;
    for_each_place(ground.all, 5,
                   [&](glm::dvec3 sample) { world.add(placement.world_from_sample(sample)); });
    constexpr double min_reach = 1.0;
    constexpr double more = 1.01;
    const double rise =
        placement.exaggeration() * std::max(ground.all.high.z - ground.lit.low.z, 0.0);
    const double bend = std::max(1.0 - sine * sine, 1e-9) / (2.0 * max_earth_radius);
    const double root = std::sqrt(sine * sine + 4.0 * bend * rise);
    const double up = sine > 0.0 ? 2.0 * rise / (sine + root) : (root - sine) / (2.0 * bend);
    return more * std::max(min_reach, std::min(up, glm::length(world.size())));
}

bool is_over(const Box& ground, glm::dvec3 sample) {
    const glm::dvec2 place(sample);
    return place == glm::clamp(place, glm::dvec2(ground.low), glm::dvec2(ground.high));
}

// Without the ground that the rays do not reach.
SunCourse::Ground reached(const terrain::Placement& placement, SunCourse::Ground ground,
                          double reach) {
    glm::dvec2 metres(std::numeric_limits<double>::infinity());
    for_each_place(ground.lit, 3, [&](glm::dvec3 sample) {
        metres = glm::min(metres, glm::dvec2(terrain::metres_at(placement, sample)));
    });
    constexpr double more = 1.2; // columns are narrower beside it
    const glm::dvec2 samples = more * reach / metres;
    for (int axis = 0; axis < 2; ++axis) {
        ground.all.low[axis] = std::max(ground.all.low[axis], ground.lit.low[axis] - samples[axis]);
        ground.all.high[axis] =
            std::min(ground.all.high[axis], ground.lit.high[axis] + samples[axis]);
    }
    return ground;
}

} // namespace

// Finds the terms of a course.
class SunCourse::Fit {
public:
    Fit(const SunCourse& course, const terrain::Placement& placement, glm::dvec3 to_sun)
        : course_(course), placement_(placement), way_(course.reach_ * to_sun) {}

    // False if places have no sample.
    bool run(std::array<glm::dvec3, SunBends::term_count>& terms) {
        std::array<Values, 4> low{};
        std::array<Values, 4> high{};
        for (std::size_t i = 0; i < node_count * node_count; ++i) {
            const glm::dvec2 unit(chebyshev_place<node_count>(i % node_count),
                                  chebyshev_place<node_count>(i / node_count));
            const auto below = factors_from({unit, -height_node});
            const auto above = factors_from({unit, height_node});
            if (!below || !above) {
                return false;
            }
            for (std::size_t power = 0; power < 4; ++power) {
                low[power][i] = (*below)[power];
                high[power][i] = (*above)[power];
            }
        }
        std::size_t first = 0;
        for (std::size_t power = 0; power < 4; ++power) {
            Values mean{};
            Values change{};
            for (std::size_t i = 0; i < mean.size(); ++i) {
                mean[i] = 0.5 * (low[power][i] + high[power][i]);
                change[i] = (high[power][i] - low[power][i]) / (2.0 * height_node);
            }
            const auto side = static_cast<std::size_t>(SunBends::sides[power]);
            add(mean, side, terms.data() + first);
            first += side * side;
            const auto with_height = static_cast<std::size_t>(SunBends::height_sides[power]);
            add(change, with_height, terms.data() + first);
            first += with_height * with_height;
        }
        return true;
    }

private:
    static constexpr double height_node = 0.7;
    using Values = std::array<glm::dvec3, node_count * node_count>;

    // Some maps end beside the terrain: from there on, rays are continued.
    [[nodiscard]] std::optional<Factors> factors_from(glm::dvec3 unit) const {
        constexpr double shortest = 1.0 / 64.0;
        for (double end = 1.0; end >= shortest; end *= 0.5) {
            if (const auto factors = factors_up_to(end, unit)) {
                return factors;
            }
        }
        return std::nullopt;
    }

    // `end`: part of the ray.
    [[nodiscard]] std::optional<Factors> factors_up_to(double end, glm::dvec3 unit) const {
        const glm::dvec3 sample = (unit - course_.unit_first_) / course_.unit_scale_;
        const glm::dvec3 place = placement_.world_from_sample(sample);
        std::array<double, part_count> parts = part_places();
        Factors means{};
        for (std::size_t i = 0; i < part_count; ++i) {
            parts[i] *= end;
            const auto found = placement_.sample_from_world(place + parts[i] * way_);
            if (!found || glm::any(glm::isnan(*found)) || glm::any(glm::isinf(*found))) {
                return std::nullopt;
            }
            means[i] = (*found - sample) / parts[i];
        }
        return terrain::powers_through(parts, means);
    }

    static void add(const Values& values, std::size_t side, glm::dvec3* terms) {
        const auto from = terms_from_values(side);
        for (std::size_t y = 0; y < side; ++y) {
            for (std::size_t x = 0; x < side; ++x) {
                glm::dvec3 sum(0.0);
                for (std::size_t i = 0; i < values.size(); ++i) {
                    sum += from[x][i % node_count] * from[y][i / node_count] * values[i];
                }
                terms[y * side + x] = sum;
            }
        }
    }

    const SunCourse& course_;
    const terrain::Placement placement_; // without a geoid
    glm::dvec3 way_;
};

glm::dvec3 SunCourse::unit_of(glm::dvec3 sample) const {
    glm::dvec3 unit = unit_scale_ * sample + unit_first_;
    unit.z += unit_scale_.z * zero_at(glm::dvec2(unit));
    return unit;
}

SunCourse::Factors SunCourse::factors_at(glm::dvec3 unit) const {
    const glm::dvec3* terms = terms_.data();
    const auto sum = [&](int side) {
        glm::dvec3 total(0.0);
        for (int y = side - 1; y >= 0; --y) {
            glm::dvec3 line(0.0);
            for (int x = side - 1; x >= 0; --x) {
                line = line * unit.x + terms[y * side + x];
            }
            total = total * unit.y + line;
        }
        terms += side * side;
        return total;
    };
    Factors factors{};
    for (std::size_t power = 0; power < factors.size(); ++power) {
        factors[power] = sum(SunBends::sides[power]);
        factors[power] += unit.z * sum(SunBends::height_sides[power]);
    }
    return factors;
}

glm::dvec3 SunCourse::way_to(const Factors& factors, double part) {
    return part * (factors[0] + part * (factors[1] + part * (factors[2] + part * factors[3])));
}

glm::dvec3 SunCourse::way(const Factors& factors, glm::dvec3 unit, double part) const {
    glm::dvec3 way = way_to(factors, part);
    const glm::dvec2 at(unit);
    way.z -= zero_at(at + glm::dvec2(unit_scale_) * glm::dvec2(way)) - zero_at(at);
    return way;
}

double SunCourse::zero_at(glm::dvec2 unit) const {
    if (zeros_.empty()) {
        return 0.0;
    }
    const glm::dvec2 count(zeros_.cols(), zeros_.rows());
    const glm::dvec2 place =
        glm::clamp(zero_scale_ * unit + zero_first_, glm::dvec2(0.0), count - 1.0);
    const glm::ivec2 cell(glm::min(glm::floor(place), count - 2.0));
    const glm::dvec2 part = place - glm::dvec2(cell);
    const auto at = [&](int col, int row) {
        return static_cast<double>(zeros_(cell.x + col, cell.y + row));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), part.x), glm::mix(at(0, 1), at(1, 1), part.x),
                    part.y);
}

// The unit place of samples, and the geoid.
void SunCourse::place(const Ground& ground, const terrain::Placement& placement) {
    const terrain::HeightRange zeros = placement.zero_range();
    Box lit = ground.lit;
    lit.low.z += zeros.low / placement.exaggeration();
    lit.high.z += zeros.high / placement.exaggeration();
    const glm::dvec3 half = glm::max(0.5 * lit.size(), glm::dvec3(0.5));
    unit_scale_ = 1.0 / half;
    unit_first_ = -lit.center() / half;
    if (placement.has_geoid()) {
        make_zeros(ground, placement);
    }
}

void SunCourse::make_zeros(const Ground& ground, const terrain::Placement& placement) {
    constexpr double apart = 2500.0; // metres: a geoid is smooth over tens of kilometres
    constexpr double max_count = 129.0;
    constexpr double beside = 3.0 * apart;
    const glm::dvec3 metres = terrain::metres_at(placement, ground.all.center());
    if (!(metres.x > 0.0 && metres.y > 0.0 && std::isfinite(metres.x + metres.y))) {
        zeros_ = Grid<float>(2, 2);
        error_ = std::numeric_limits<double>::infinity(); // a pole: too wrong
        return;
    }
    const glm::dvec2 more = beside / glm::dvec2(metres);
    const glm::dvec2 low = glm::dvec2(ground.all.low) - more;
    const glm::dvec2 extent = glm::dvec2(ground.all.high) + more - low;
    const glm::dvec2 count =
        glm::clamp(glm::ceil(extent * glm::dvec2(metres) / apart) + 1.0, 2.0, max_count);
    const glm::dvec2 step = extent / (count - 1.0);
    zeros_ = Grid<float>(static_cast<int>(count.x), static_cast<int>(count.y));
    terrain::HeightRange range{std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()};
    for (int row = 0; row < zeros_.rows(); ++row) {
        for (int col = 0; col < zeros_.cols(); ++col) {
            const double zero = placement.zero_at_sample(low + step * glm::dvec2(col, row)) /
                                placement.exaggeration();
            zeros_(col, row) = static_cast<float>(zero);
            range = {std::min(range.low, zero), std::max(range.high, zero)};
        }
    }
    zero_range_ = range.high - range.low;
    // Of a sample: (sample - low) / step.
    const glm::dvec2 sample_a_unit = 1.0 / glm::dvec2(unit_scale_);
    zero_scale_ = sample_a_unit / step;
    zero_first_ = (-glm::dvec2(unit_first_) * sample_a_unit - low) / step;
}

// Checks the polynomials, and chooses the parts at which chords end: none is seen from where its
// ray begins beside the ray by more than chord_error. A chord between the distances a and b is seen
// by at most (sqrt(b) - sqrt(a))^2 / 2 times the ray's curvature. False if they are too wrong.
bool SunCourse::cut(const terrain::Placement& placement, glm::dvec3 to_sun, const Ground& ground) {
    double curvature = 0.0; // 1/metre
    for_each_place(ground.lit, 4, [&](glm::dvec3 sample) {
        const glm::dvec3 place = placement.world_from_sample(sample);
        const glm::dvec3 metres = terrain::metres_at(placement, sample);
        const glm::dvec3 unit = unit_of(sample);
        const Factors factors = factors_at(unit);
        // Rays may leave narrow ground soon.
        for (const double part : {0.0, 0.003, 0.01, 0.03, 0.1, 0.3, 0.6, 1.0}) {
            const glm::dvec3 bend =
                2.0 * factors[1] + part * (6.0 * factors[2] + part * 12.0 * factors[3]);
            curvature = std::max(curvature, glm::length(metres * bend) / (reach_ * reach_));
            const auto found = placement.sample_from_world(place + part * reach_ * to_sun);
            if (part == 0.0 || !found || !is_over(ground.all, *found)) {
                continue; // beside all ground
            }
            const glm::dvec3 off = sample + way(factors, unit, part) - *found;
            const double error = glm::length(metres * off) / (part * reach_);
            error_ = error <= error_ ? error_ : error; // also what is no number
        }
    });
    const double highest = placement.exaggeration() *
                           std::max(std::abs(ground.all.low.z), std::abs(ground.all.high.z));
    constexpr double height_rounding = 0x1p-20; // by which rays are lifted, at least
    const double first = std::sqrt(8.0 * height_rounding * highest / curvature);
    const double step = std::sqrt(2.0 * chord_error / curvature);
    double root = std::max(step, std::sqrt(first));
    parts_ = {0.0F};
    while (root * root < reach_ && parts_.size() < max_chords) {
        parts_.push_back(static_cast<float>(root * root / reach_));
        root += step;
    }
    parts_.push_back(1.0F);
    return error_ <= max_error && std::isfinite(curvature) && parts_.size() <= max_chords;
}

std::optional<SunCourse> SunCourse::create(const terrain::Placement& placement, glm::dvec3 to_sun,
                                           const Ground& whole) {
    SunCourse course;
    course.reach_ = reach_over(placement, to_sun, whole);
    const Ground ground = reached(placement, whole, course.reach_);
    course.place(ground, placement);
    if (!Fit(course, placement.without_geoid(), to_sun).run(course.terms_) ||
        !course.cut(placement, to_sun, ground)) {
        return std::nullopt;
    }
    SunBends& bends = course.bends_;
    std::transform(course.terms_.begin(), course.terms_.end(), bends.terms.begin(),
                   [](glm::dvec3 term) { return glm::vec3(term); });
    bends.unit_per_sample = glm::vec2(course.unit_scale_);
    bends.unit_per_metre = static_cast<float>(course.unit_scale_.z);
    bends.unit_height = static_cast<float>(course.unit_first_.z);
    bends.parts = course.parts_;
    if (!course.zeros_.empty()) {
        bends.zeros = &course.zeros_(0, 0);
        bends.zero_count = {course.zeros_.cols(), course.zeros_.rows()};
        bends.zero_scale = glm::vec2(course.zero_scale_);
        bends.zero_first = glm::vec2(course.zero_first_);
    }
    return course;
}

std::vector<glm::dvec3> SunCourse::ways_from(glm::dvec3 sample) const {
    const glm::dvec3 unit = unit_of(sample);
    const Factors factors = factors_at(unit);
    std::vector<glm::dvec3> ways(parts_.size());
    std::transform(parts_.begin(), parts_.end(), ways.begin(),
                   [&](float part) { return way(factors, unit, static_cast<double>(part)); });
    return ways;
}

// The geoid changes heights by its range at most.
std::vector<Box> SunCourse::ends_from(const Box& places) const {
    constexpr double slack = 0.1; // of the differences between the ways: these bend little
    std::vector<Box> ends(parts_.size());
    std::vector<Box> ways(parts_.size());
    for_each_place(places, 3, [&](glm::dvec3 sample) {
        const Factors factors = factors_at(unit_scale_ * sample + unit_first_);
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            const glm::dvec3 way = way_to(factors, static_cast<double>(parts_[i]));
            ends[i].add(sample + way);
            ways[i].add(way);
        }
    });
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const glm::dvec3 more =
            slack * ways[i].size() + glm::dvec3(0.0, 0.0, i == 0 ? 0.0 : zero_range_);
        ends[i].low -= more;
        ends[i].high += more;
    }
    return ends;
}

} // namespace reljef::cast
