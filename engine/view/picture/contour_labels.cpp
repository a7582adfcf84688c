#include "engine/view/picture/contour_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/view/picture/contour_line.h"
#include "engine/view/picture/label_ground.h"
#include "engine/view/picture/label_strokes.h"
#include "engine/view/picture/label_view.h"

namespace reljef::view {
namespace {

#include "shaders/terrain/overlay_numbers.inc"

// Heights of a digit.
constexpr double cell_size = 12.0;   // smallest, on the picture; the largest is twice as large
constexpr double min_distance = 9.0; // between the middles of labels
constexpr double max_bend = 0.3;     // of a contour from the straight text
constexpr double min_length = 3.2;   // of the straight piece of contour under a text
constexpr double side = 0.6;         // beside it, where the ground rises evenly
constexpr double text_margin = 0.7;  // to the picture's border
constexpr double lift = 0.03;        // above the ground of places that must be seen
// Distance between bold contours where labels are faint, and where they are not.
constexpr double crowded = 1.1;
constexpr double apart = 1.8;

constexpr double digit_pixels = 9.6; // at a contour_scale() of 1
constexpr double min_opacity = 0.45;

constexpr int min_level = 3; // cells that are not seen are divided before
constexpr int max_cells = 10'000;
constexpr int steps_of_cell = 24;
constexpr int max_tries = 24;
constexpr double min_cell = 1.0 / 64.0; // samples

// A square of samples.
struct Cell {
    glm::dvec2 first{0.0};
    double side = 1.0;
    int level = 0; ///< 0: all of the terrain

    [[nodiscard]] glm::dvec2 at(double col, double row) const {
        return first + side * glm::dvec2(col, row);
    }
};

enum class CellView { unseen, large, fitting };

std::string height_text(double metres) {
    std::string text = fmt::format("{:.6f}", metres);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') {
        text.pop_back();
    }
    return text == "-0" ? "0" : text;
}

double cross_product(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

double area(const std::array<glm::dvec2, 4>& corners) {
    return 0.5 * std::abs(cross_product(corners[2] - corners[0], corners[3] - corners[1]));
}

// The straight line that a piece of a contour follows; empty if it bends too much.
struct Baseline {
    glm::dvec2 middle;
    glm::dvec2 along;
};
std::optional<Baseline> baseline_of(const ContourLine& line, double digit_height, double width) {
    const glm::dvec2 chord = line.pixels.back() - line.pixels.front();
    const double length = glm::length(chord);
    constexpr double min_share = 0.9; // of the length along the contour
    if (!(length >= min_share * width)) {
        return std::nullopt;
    }
    const glm::dvec2 along = chord / length;
    glm::dvec2 sum(0.0);
    for (const glm::dvec2 pixel : line.pixels) {
        sum += pixel;
    }
    const glm::dvec2 middle = sum / static_cast<double>(line.pixels.size());
    const bool is_straight = std::ranges::all_of(line.pixels, [&](glm::dvec2 pixel) {
        return std::abs(cross_product(along, pixel - middle)) <= max_bend * digit_height;
    });
    const bool is_backwards = along.x < 0.0 || (along.x == 0.0 && along.y > 0.0);
    return is_straight ? std::optional(Baseline{middle, is_backwards ? -along : along})
                       : std::nullopt;
}

// Pixels across the contour per metre of height; negative on ground that faces away from the eye.
double spacing_of(const ContourLine& line) {
    const glm::dvec2 chord = line.pixels.back() - line.pixels.front();
    return cross_product(line.climb, glm::normalize(chord));
}

// Finds the labels of one terrain.
class LabelSearch {
public:
    LabelSearch(const DrawList& list, const TerrainDraw& draw, double digit_height)
        : list_(list), terrain_(*draw.terrain), ground_(list, draw), view_(list.camera, list.size),
          frustum_(scene::clip_from_world(list.camera, list.size)),
          interval_(bold_every * scene::shown_contours(terrain_)), digit_height_(digit_height) {}

    std::vector<ContourLabel> find() {
        const glm::dvec2 last = ground_.last_sample();
        std::vector<Cell> cells{
            {glm::dvec2(0.0), std::exp2(std::ceil(std::log2(std::max({last.x, last.y, 1.0}))))}};
        int cells_seen = 0;
        while (!cells.empty()) {
            std::vector<Cell> smaller;
            for (const Cell& cell : cells) {
                if (++cells_seen > max_cells) {
                    return std::move(labels_);
                }
                const CellView view = view_of(cell);
                if (view == CellView::fitting) {
                    label(cell);
                } else if (view == CellView::large) {
                    divide(cell, smaller);
                }
            }
            cells = std::move(smaller);
        }
        return std::move(labels_);
    }

private:
    // The nearest place on the terrain.
    [[nodiscard]] glm::dvec3 place_near(glm::dvec2 sample) const {
        const glm::dvec2 inside = glm::clamp(sample, glm::dvec2(0.0), ground_.last_sample());
        return ground_.place(inside, ground_.height(inside).value_or(0.0));
    }

    [[nodiscard]] CellView view_of(const Cell& cell) const {
        if (cell.level < min_level) {
            return CellView::large;
        }
        const std::array<glm::dvec3, 4> corners{
            place_near(cell.at(0.0, 0.0)), place_near(cell.at(1.0, 0.0)),
            place_near(cell.at(1.0, 1.0)), place_near(cell.at(0.0, 1.0))};
        if (!frustum_.may_see(around(corners))) {
            return CellView::unseen;
        }
        const bool is_large = pixels_across(corners) > 2.0 * cell_size * digit_height_;
        return is_large && cell.side > min_cell ? CellView::large : CellView::fitting;
    }

    // With room for hills between them.
    [[nodiscard]] static Box around(const std::array<glm::dvec3, 4>& corners) {
        Box box;
        for (const glm::dvec3& corner : corners) {
            box.add(corner);
        }
        const double hills = 0.25 * glm::length(box.size());
        return {box.low - hills, box.high + hills};
    }

    // Infinite if a corner is behind the eye.
    [[nodiscard]] double pixels_across(const std::array<glm::dvec3, 4>& corners) const {
        std::array<glm::dvec2, 4> pixels;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto seen = view_.project(corners[i]);
            if (!view_.is_before_eye(seen)) {
                return std::numeric_limits<double>::infinity();
            }
            pixels[i] = seen.pixel;
        }
        return std::sqrt(area(pixels));
    }

    void divide(const Cell& cell, std::vector<Cell>& smaller) const {
        for (const double row : {0.0, 0.5}) {
            for (const double col : {0.0, 0.5}) {
                const Cell part{cell.at(col, row), 0.5 * cell.side, cell.level + 1};
                if (ground_.is_inside(part.first)) {
                    smaller.push_back(part);
                }
            }
        }
    }

    // Where a row or a column through the cell crosses a bold contour.
    struct Crossing {
        glm::dvec2 sample{0.0};
        double number = 0.0; // of the contour
        double from_middle = 0.0;
    };
    [[nodiscard]] std::vector<Crossing> crossings_in(const Cell& cell) const {
        std::vector<Crossing> crossings;
        for (const double across : {0.5, 0.2, 0.8}) {
            add_crossings(
                cell, [&](double along) { return cell.at(along, across); }, crossings);
            add_crossings(
                cell, [&](double along) { return cell.at(across, along); }, crossings);
        }
        std::ranges::stable_sort(crossings, {}, &Crossing::from_middle);
        return crossings;
    }

    template <class At>
    void add_crossings(const Cell& cell, const At& at, std::vector<Crossing>& crossings) const {
        auto before = ground_.height(at(0.0));
        for (int i = 1; i <= steps_of_cell; ++i) {
            const auto height = ground_.height(at(static_cast<double>(i) / steps_of_cell));
            if (before && height && *before != *height) {
                const double number = std::round(0.5 * (*before + *height) / interval_);
                const double share = (number * interval_ - *before) / (*height - *before);
                if (share >= 0.0 && share < 1.0) {
                    const glm::dvec2 sample = at((i - 1 + share) / steps_of_cell);
                    crossings.push_back({sample, number, glm::distance(sample, cell.at(0.5, 0.5))});
                }
            }
            before = height;
        }
    }

    void label(const Cell& cell) {
        int tries = 0;
        for (const Crossing& crossing : crossings_in(cell)) {
            if (tries++ == max_tries) {
                return;
            }
            const ContourPlace place{crossing.sample, crossing.number * interval_,
                                     cell.side / (2.0 * steps_of_cell),
                                     crowded * digit_height_ / interval_, side * digit_height_};
            if (!may_have_room(place)) {
                continue;
            }
            if (auto label = label_at(place)) {
                labels_.push_back(std::move(*label));
                return;
            }
        }
    }

    [[nodiscard]] std::optional<ContourLabel> label_at(const ContourPlace& place) {
        std::string text = height_text(place.height);
        const double width = digit_height_ * text_strokes(text).width;
        const double length = std::max(width, min_length * digit_height_);
        const auto line = follow_contour(ground_, view_, place, 0.5 * length);
        const auto baseline = line ? baseline_of(*line, digit_height_, length) : std::nullopt;
        if (!baseline || !has_room(*baseline, width)) {
            return std::nullopt;
        }
        const double spacing = spacing_of(*line) * interval_;
        const double opacity =
            glm::smoothstep(crowded * digit_height_, apart * digit_height_, spacing);
        if (opacity < min_opacity || !is_visible(*line)) {
            return std::nullopt;
        }
        return ContourLabel{std::move(text), baseline->middle, baseline->along,
                            opacity,         line->depth,      line->depth_reach};
    }

    // Whether a place is on the picture and away from other labels.
    [[nodiscard]] bool may_have_room(const ContourPlace& place) const {
        const auto seen = view_.project(ground_.place(place.sample, place.height));
        const glm::dvec2 size = view_.size();
        return view_.is_before_eye(seen) && seen.pixel.x > 0.0 && seen.pixel.y > 0.0 &&
               seen.pixel.x < size.x && seen.pixel.y < size.y &&
               is_far_from_labels(seen.pixel, 0.5 * min_distance);
    }

    [[nodiscard]] bool is_far_from_labels(glm::dvec2 pixel, double digit_heights) const {
        return std::ranges::none_of(labels_, [&](const ContourLabel& other) {
            return glm::distance(other.middle, pixel) < digit_heights * digit_height_;
        });
    }

    [[nodiscard]] bool has_room(const Baseline& baseline, double width) const {
        const glm::dvec2 along = glm::abs(baseline.along);
        const double margin = text_margin * digit_height_;
        const glm::dvec2 half =
            0.5 * width * along + 0.5 * digit_height_ * glm::dvec2(along.y, along.x) + margin;
        const glm::dvec2 low = baseline.middle - half;
        const glm::dvec2 high = baseline.middle + half;
        const glm::dvec2 size = view_.size();
        const bool is_inside = low.x >= 0.0 && low.y >= 0.0 && high.x <= size.x && high.y <= size.y;
        return is_inside && is_far_from_labels(baseline.middle, min_distance);
    }

    // Without nearer ground, and without a detail texture, which shows no contours.
    [[nodiscard]] bool is_visible(const ContourLine& line) {
        const double distance = glm::distance(line.places[ContourLine::middle], list_.camera.eye);
        if (seen_detail(terrain_, list_.camera, list_.size, distance) != DetailLevel::none) {
            return false;
        }
        return std::ranges::all_of(line.places, [this](glm::dvec3 place) {
            const double metres =
                lift * digit_height_ * view_.pixel_width(view_.project(place).depth);
            const auto sight = view_.sight_from(place + metres * ground_.up(place));
            return !ground_.is_met(sight.ray, sight.range);
        });
    }

    const DrawList& list_;
    const scene::TerrainNode& terrain_;
    LabelGround ground_;
    LabelView view_;
    Frustum frustum_;
    double interval_; // metres between bold contours
    double digit_height_;
    std::vector<ContourLabel> labels_;
};

bool shows_labels(const scene::TerrainNode& terrain) {
    return scene::shown_contours(terrain) > 0.0 && terrain.labels_contours &&
           scene::shows_heights(terrain.material.technique) && !terrain.material.wireframe;
}

double digit_height(const DrawList& list, double magnification) {
    const glm::ivec2 shown(glm::round(magnification * glm::dvec2(list.size)));
    return digit_pixels * contour_scale(list.camera, shown) / magnification;
}

} // namespace

bool is_covered(const ContourLabel& label, double digit_height, const Grid<float>& depths) {
    const glm::dvec2 half = 0.5 * digit_height * text_strokes(label.text).width * label.along;
    for (const glm::dvec2 place : {label.middle - half, label.middle, label.middle + half}) {
        const glm::ivec2 pixel(glm::floor(place));
        const bool is_inside =
            pixel.x >= 0 && pixel.y >= 0 && pixel.x < depths.cols() && pixel.y < depths.rows();
        if (is_inside &&
            static_cast<double>(depths(pixel.x, pixel.y)) < label.depth - label.depth_reach) {
            return true;
        }
    }
    return false;
}

ContourInk contour_ink() {
    return {0.5 * static_cast<double>(crowded_pixels + apart_pixels),
            static_cast<double>(bold_every), static_cast<double>(height_rounding)};
}

ContourLabels contour_labels(const DrawList& list, double magnification) {
    ContourLabels found{digit_height(list, magnification), {}};
    for (const TerrainDraw& draw : list.terrains) {
        if (shows_labels(*draw.terrain)) {
            auto labels = LabelSearch(list, draw, found.digit_height).find();
            std::ranges::move(labels, std::back_inserter(found.labels));
        }
    }
    return found;
}

} // namespace reljef::view
