#include "engine/terrain/mesh/sample_positions.h"

#include <algorithm>

#include <glm/common.hpp>

#include "engine/terrain/mesh/bending.h"

// With second derivatives of at most C in any direction, a bilinear interpolant over squares of
// side s is off by at most s²/8 (C + C) = s² C / 4. Positions at a fixed height are as smooth as
// the map from samples to the ground, except where cells of another length begin: at the last cells
// of a tile, and next to a row that closes a globe at a pole. There are always anchors.

namespace reljef::terrain {
namespace {

constexpr int max_distance = 32; // samples between anchors

double error_between_anchors(int distance, double curvature) {
    return distance > 1 ? 0.25 * distance * distance * curvature : 0.0;
}

int distance_for(double curvature, double max_error) {
    int distance = max_distance;
    while (distance > 1 && error_between_anchors(distance, curvature) > max_error) {
        distance /= 2;
    }
    return distance;
}

// Columns or rows of anchors. Cells of another length may lie before `first_equal` and after
// `last_equal`.
std::vector<int> anchor_lines(int last, int first_equal, int last_equal, int distance) {
    std::vector<int> lines{0, std::min(first_equal, last), std::min(last_equal, last), last};
    for (int line = distance; line < last; line += distance) {
        lines.push_back(line);
    }
    std::sort(lines.begin(), lines.end());
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    return lines;
}

} // namespace

SamplePositions::SamplePositions(const Heightfield& heightfield, const Placement& placement,
                                 double curvature, double max_error)
    : exaggeration_(placement.exaggeration()) {
    const glm::ivec2 last(heightfield.heights.cols() - 1, heightfield.heights.rows() - 1);
    if (placement.kind() == PlacementKind::plane) {
        for (int col = 0; col <= last.x; ++col) {
            x_.push_back(placement.world_from_sample({col, 0.0, 0.0}).x);
        }
        for (int row = 0; row <= last.y; ++row) {
            y_.push_back(placement.world_from_sample({0.0, row, 0.0}).y);
        }
        return;
    }
    const int distance = distance_for(curvature, max_error);
    error_ = error_between_anchors(distance, curvature);
    const ShorterCells shorter(heightfield, placement);
    const glm::ivec2 from = shorter.first_equal();
    const glm::ivec2 to = shorter.last_equal();
    const std::vector<int> cols = anchor_lines(last.x, from.x, to.x, distance);
    const std::vector<int> rows = anchor_lines(last.y, from.y, to.y, distance);
    cols_ = places_between(cols);
    rows_ = places_between(rows);
    anchors_ = Grid<Anchor>(static_cast<int>(cols.size()), static_cast<int>(rows.size()));
    for (int row = 0; row < anchors_.rows(); ++row) {
        for (int col = 0; col < anchors_.cols(); ++col) {
            constexpr double height = 1000.0; // metres; positions are rounded at 1e-9 m
            const glm::dvec2 sample(cols[static_cast<std::size_t>(col)],
                                    rows[static_cast<std::size_t>(row)]);
            Anchor& anchor = anchors_(col, row);
            anchor.ground = placement.world_from_sample({sample, 0.0});
            anchor.up = (placement.world_from_sample({sample, height}) - anchor.ground) / height;
        }
    }
}

std::vector<SamplePositions::Between>
SamplePositions::places_between(const std::vector<int>& lines) {
    std::vector<Between> places;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
        for (int line = lines[i]; line < lines[i + 1]; ++line) {
            places.push_back({static_cast<int>(i),
                              static_cast<double>(line - lines[i]) / (lines[i + 1] - lines[i])});
        }
    }
    places.push_back({static_cast<int>(lines.size()) - 2, 1.0});
    return places;
}

glm::dvec3 SamplePositions::between_anchors(glm::ivec2 sample, double height) const {
    const Between col = cols_[static_cast<std::size_t>(sample.x)];
    const Between row = rows_[static_cast<std::size_t>(sample.y)];
    const auto at_anchor = [&](int i, int j) {
        const Anchor& anchor = anchors_(col.before + i, row.before + j);
        return anchor.ground + height * anchor.up;
    };
    return glm::mix(glm::mix(at_anchor(0, 0), at_anchor(1, 0), col.part),
                    glm::mix(at_anchor(0, 1), at_anchor(1, 1), col.part), row.part);
}

} // namespace reljef::terrain
