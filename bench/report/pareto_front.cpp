#include "bench/report/pareto_front.h"

#include <algorithm>
#include <cmath>

namespace reljef::bench {
namespace {

constexpr double min_ratio = 0.1;
constexpr double max_ratio = 1000.0;
constexpr double min_error_px = 1e-3;
constexpr double max_error_px = 1e3;

struct FrontPoint {
    std::string label;
    double ms = 0.0;
    double ratio = 1.0; // to texture; unused if the row has none
    double error = 0.0;
    std::optional<double> noise; // a share of `ms`
};

bool has_error(const Row& row) {
    return !row.null_row && row.error && row.error->reprojection_px;
}

bool is_holed(const Row& row) {
    const double pixels = static_cast<double>(row.size.x) * row.size.y;
    return static_cast<double>(row.error->holes) > max_holes * pixels;
}

bool is_ranked(const Row& row) {
    return has_error(row) && row.error->reprojection_px->unbounded == 0 && !is_holed(row);
}

std::vector<FrontPoint> points_of(std::span<const Row> rows) {
    std::vector<FrontPoint> points;
    for (const Row& row : rows) {
        if (is_ranked(row)) {
            points.push_back(
                {row.setting.label, row.timing.ms.median, row.timing.ratio_to_texture.value_or(1.0),
                 row.error->reprojection_px->distribution.rms, row.timing.noise_floor});
        }
    }
    std::stable_sort(points.begin(), points.end(), [](const FrontPoint& a, const FrontPoint& b) {
        return a.ms != b.ms ? a.ms < b.ms : a.error < b.error;
    });
    return points;
}

bool dominates(const FrontPoint& a, const FrontPoint& b) {
    return a.noise && b.noise && a.error <= b.error &&
           b.ms > a.ms * (1.0 + std::max(*a.noise, *b.noise));
}

// Precondition: sorted points. Only an earlier point can dominate a later one.
std::vector<FrontPoint> front_points(const std::vector<FrontPoint>& points) {
    std::vector<FrontPoint> front;
    for (const FrontPoint& point : points) {
        if (std::none_of(front.begin(), front.end(),
                         [&](const FrontPoint& other) { return dominates(other, point); })) {
            front.push_back(point);
        }
    }
    return front;
}

// The most accurate setting of the front that dominates a point; absent if it is on the front.
std::optional<std::string> dominator_of(const FrontPoint& point,
                                        const std::vector<FrontPoint>& front) {
    const FrontPoint* best = nullptr;
    for (const FrontPoint& other : front) {
        if (dominates(other, point) && (best == nullptr || other.error <= best->error)) {
            best = &other;
        }
    }
    return best == nullptr ? std::nullopt : std::optional(best->label);
}

// The front is a staircase that descends at each point with a smaller error than all before.
double area_below(const std::vector<FrontPoint>& points) {
    const double width = std::log(max_ratio / min_ratio);
    const double height = std::log(max_error_px / min_error_px);
    double area = 0.0;
    double place = 0.0;
    double level = height;
    for (const FrontPoint& point : points) {
        const double next = std::clamp(std::log(point.ratio / min_ratio), 0.0, width);
        area += level * (next - place);
        place = next;
        const double error = std::clamp(point.error, min_error_px, max_error_px);
        level = std::min(level, std::log(error / min_error_px));
    }
    area += level * (width - place);
    return std::clamp(area / (width * height), 0.0, 1.0);
}

bool lacks_ratios(std::span<const Row> rows) {
    return std::any_of(rows.begin(), rows.end(),
                       [](const Row& row) { return !row.timing.ratio_to_texture; });
}

bool is_same_place(const Row& a, const Row& b) {
    return a.scene == b.scene && a.pose == b.pose && a.size == b.size;
}

} // namespace

Front front_of(std::span<const Row> rows) {
    check(!rows.empty(), "a front of no rows");
    const std::vector<FrontPoint> points = points_of(rows);
    const std::vector<FrontPoint> best = front_points(points);
    Front front;
    front.scene = rows.front().scene;
    front.pose = rows.front().pose;
    front.area = lacks_ratios(rows) ? std::nullopt : std::optional(area_below(points));
    for (const Row& row : rows) {
        if (has_error(row) && is_holed(row)) {
            front.holed.push_back(row.setting.label);
        }
    }
    for (const FrontPoint& point : points) {
        if (const auto by = dominator_of(point, best)) {
            front.dominated.push_back({point.label, *by});
        } else {
            front.front.push_back(point.label);
        }
    }
    return front;
}

std::vector<Front> fronts_of(std::span<const Row> rows) {
    std::vector<Front> fronts;
    while (!rows.empty()) {
        const auto end = std::find_if_not(rows.begin(), rows.end(), [&](const Row& row) {
            return is_same_place(row, rows.front());
        });
        const auto count = static_cast<std::size_t>(end - rows.begin());
        fronts.push_back(front_of(rows.first(count)));
        rows = rows.subspan(count);
    }
    return fronts;
}

} // namespace reljef::bench
