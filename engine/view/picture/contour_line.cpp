#include "engine/view/picture/contour_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace reljef::view {
namespace {

class Follower {
public:
    Follower(const LabelGround& ground, const LabelView& view, const ContourPlace& place)
        : ground_(ground), view_(view), place_(place) {}

    // Metres per sample, over a step to each side.
    [[nodiscard]] std::optional<glm::dvec2> gradient(glm::dvec2 sample) const {
        glm::dvec2 slopes(0.0);
        for (int axis = 0; axis < 2; ++axis) {
            glm::dvec2 to_side(0.0);
            to_side[axis] = place_.step;
            const auto before = ground_.height(sample - to_side);
            const auto after = ground_.height(sample + to_side);
            if (!before || !after) {
                return std::nullopt;
            }
            slopes[axis] = (*after - *before) / (2.0 * place_.step);
        }
        return glm::dot(slopes, slopes) > 0.0 ? std::optional(slopes) : std::nullopt;
    }

    // The place of the contour that is nearest to a sample beside it (Newton).
    [[nodiscard]] std::optional<glm::dvec2> on_contour(glm::dvec2 sample) const {
        constexpr int max_rounds = 3;
        constexpr double close = 0.05; // steps
        double length = close + 1.0;
        for (int i = 0; i < max_rounds && length > close; ++i) {
            const auto slopes = gradient(sample);
            const auto height = ground_.height(sample);
            if (!slopes || !height) {
                return std::nullopt;
            }
            const glm::dvec2 correction =
                *slopes * ((place_.height - *height) / glm::dot(*slopes, *slopes));
            length = glm::length(correction) / place_.step;
            if (length > max_correction) {
                return std::nullopt;
            }
            sample += correction;
        }
        return ground_.is_inside(sample) ? std::optional(sample) : std::nullopt;
    }

    // `pixels` farther along the contour, uphill to the left; negative: to the other side.
    [[nodiscard]] std::optional<glm::dvec2> along(glm::dvec2 sample, double pixels) const {
        const auto slopes = gradient(sample);
        if (!slopes) {
            return std::nullopt;
        }
        const glm::dvec2 direction = glm::normalize(glm::dvec2(-slopes->y, slopes->x));
        const auto from = view_.project(place_of(sample));
        const auto to = view_.project(place_of(sample + place_.step * direction));
        const double seen = glm::distance(from.pixel, to.pixel);
        if (!view_.is_before_eye(from) || !view_.is_before_eye(to) || !(seen > 0.0)) {
            return std::nullopt;
        }
        const double steps = pixels / seen;
        return std::abs(steps) <= max_steps ? on_contour(sample + steps * place_.step * direction)
                                            : std::nullopt;
    }

    [[nodiscard]] glm::dvec3 place_of(glm::dvec2 sample) const {
        return ground_.place(sample, place_.height);
    }

    struct Climb {
        glm::dvec2 pixels{0.0}; // per metre of height
        double depth = 0.0;     // likewise
    };
    [[nodiscard]] std::optional<Climb> climb_at(glm::dvec2 sample) const {
        const auto slopes = gradient(sample);
        if (!slopes) {
            return std::nullopt;
        }
        const double slope = glm::length(*slopes);
        const double rise = slope * place_.step;
        const glm::dvec3 higher =
            ground_.place(sample + *slopes * (place_.step / slope), place_.height + rise);
        const auto from = view_.project(place_of(sample));
        const auto to = view_.project(higher);
        return view_.is_before_eye(to) ? std::optional(Climb{(to.pixel - from.pixel) / rise,
                                                             (to.depth - from.depth) / rise})
                                       : std::nullopt;
    }

    // Whether the ground rises about as its gradient says to a height above the contour, and from
    // as much below it: else the line is one of many specks.
    [[nodiscard]] bool is_even(glm::dvec2 sample, double metres) const {
        const auto slopes = gradient(sample);
        if (!slopes) {
            return false;
        }
        const glm::dvec2 offset = *slopes * (metres / glm::dot(*slopes, *slopes));
        for (const double side : {-1.0, 1.0}) {
            const auto height = ground_.height(sample + side * offset);
            const double share = height ? side * (*height - place_.height) / metres : 0.0;
            if (!(share > min_evenness && share < 1.0 / min_evenness)) {
                return false;
            }
        }
        return true;
    }

private:
    static constexpr double min_evenness = 0.4;
    static constexpr double max_correction = 4.0; // steps
    static constexpr double max_steps = 16.0;     // at once

    const LabelGround& ground_;
    const LabelView& view_;
    const ContourPlace& place_;
};

} // namespace

std::optional<ContourLine> follow_contour(const LabelGround& ground, const LabelView& view,
                                          const ContourPlace& place, double half_length) {
    const Follower follower(ground, view, place);
    const auto middle = follower.on_contour(place.sample);
    const auto climb = middle ? follower.climb_at(*middle) : std::nullopt;
    const double pixels_per_metre = climb ? glm::length(climb->pixels) : 0.0;
    if (!(pixels_per_metre > 0.0) || pixels_per_metre < place.min_climb) {
        return std::nullopt;
    }
    const double rise_of_side = place.side / pixels_per_metre;
    ContourLine line;
    line.climb = climb->pixels;
    double nearest = std::numeric_limits<double>::infinity();
    double farthest = -nearest;
    const auto add = [&](int index, glm::dvec2 sample) {
        const auto i = static_cast<std::size_t>(index);
        line.places[i] = follower.place_of(sample);
        const auto seen = view.project(line.places[i]);
        line.pixels[i] = seen.pixel;
        nearest = std::min(nearest, seen.depth);
        farthest = std::max(farthest, seen.depth);
        return follower.is_even(sample, rise_of_side);
    };
    if (!add(ContourLine::middle, *middle)) {
        return std::nullopt;
    }
    line.depth = nearest;
    for (const int side : {-1, 1}) {
        auto sample = middle;
        for (int i = 1; i <= ContourLine::steps; ++i) {
            sample = follower.along(*sample, side * half_length / ContourLine::steps);
            if (!sample || !add(ContourLine::middle + side * i, *sample)) {
                return std::nullopt;
            }
        }
    }
    line.depth_reach = farthest - nearest + std::abs(climb->depth) * rise_of_side;
    return line;
}

} // namespace reljef::view
