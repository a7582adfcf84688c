#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "engine/io/raster/globe.h"
#include "engine/io/raster/sample_decoder.h"
#include "engine/io/raster/sample_reader.h"

namespace reljef::io {
namespace {

constexpr int largest_reduction = 1024;
constexpr double coarser_for_overview = 4.0 / 3.0 + 1e-9;
constexpr double near_whole = 1e-6;

using Window = RasterOptions::Window;

Result<Window> window_of(GDALDataset& dataset, const std::string& name,
                         const RasterOptions& options) {
    const int cols = dataset.GetRasterXSize();
    const int rows = dataset.GetRasterYSize();
    if (cols < 2 || rows < 2) {
        return Error{
            fmt::format("{}: has {}×{} samples, at least 2×2 were expected", name, cols, rows)};
    }
    const Window window = options.window.value_or(Window{0, 0, cols, rows});
    const bool inside = window.col >= 0 && window.row >= 0 && window.cols >= 2 &&
                        window.rows >= 2 && window.cols <= cols - window.col &&
                        window.rows <= rows - window.row;
    if (!inside) {
        return Error{
            fmt::format("{}: the window of {}×{} samples at {},{} was asked for, at least 2×2 "
                        "inside its {}×{} were expected",
                        name, window.cols, window.rows, window.col, window.row, cols, rows)};
    }
    return window;
}

/// A window of one resolution; `scale`: full-resolution samples per sample.
struct Level {
    int overview = -1;
    glm::dvec2 scale{1.0};
    Window window;
};

Level level_of(GDALRasterBand& band, int overview, const Window& full) {
    if (overview < 0) {
        return {overview, glm::dvec2(1.0), full};
    }
    GDALRasterBand* reduced = band.GetOverview(overview);
    Level level;
    if (reduced == nullptr || reduced->GetXSize() < 2 || reduced->GetYSize() < 2) {
        return level;
    }
    const int cols = reduced->GetXSize();
    const int rows = reduced->GetYSize();
    level.overview = overview;
    level.scale = {static_cast<double>(band.GetXSize()) / cols,
                   static_cast<double>(band.GetYSize()) / rows};
    const glm::dvec2 low = glm::dvec2(full.col, full.row) / level.scale;
    const glm::dvec2 high = glm::dvec2(full.col + full.cols, full.row + full.rows) / level.scale;
    level.window.col = static_cast<int>(std::ceil(low.x - near_whole));
    level.window.row = static_cast<int>(std::ceil(low.y - near_whole));
    level.window.cols = std::min(static_cast<int>(high.x + near_whole), cols) - level.window.col;
    level.window.rows = std::min(static_cast<int>(high.y + near_whole), rows) - level.window.row;
    return level;
}

/// `around`: samples per 360 degrees, a multiple of the reduction; 0: any reduction.
std::optional<int> smallest_reduction(const Window& window, std::size_t budget, int around) {
    const std::size_t samples = budget / bytes_per_sample;
    for (int k = 1; k <= largest_reduction; ++k) {
        if (window.cols / k < 2 || window.rows / k < 2) {
            break;
        }
        if (around % k == 0 &&
            static_cast<std::size_t>(window.cols / k) * static_cast<std::size_t>(window.rows / k) <=
                samples) {
            return k;
        }
    }
    return std::nullopt;
}

ReadPlan plan_of(const Level& level, int reduction) {
    ReadPlan plan;
    plan.overview = level.overview;
    plan.col = level.window.col;
    plan.row = level.window.row;
    plan.reduction = reduction;
    plan.grid.cols = level.window.cols / reduction;
    plan.grid.rows = level.window.rows / reduction;
    plan.grid.step = level.scale * static_cast<double>(reduction);
    plan.grid.origin = level.scale * glm::dvec2(plan.col, plan.row) + 0.5 * plan.grid.step;
    return plan;
}

/// Samples per 360 degrees of a window that spans them all; else 0.
int samples_to_divide(GDALDataset& dataset, const Window& window) {
    std::vector<std::string> ignored;
    const auto affine = affine_of(dataset);
    const auto crs = affine ? horizontal_crs(dataset, ignored) : std::nullopt;
    const int around = crs ? samples_around(*crs, *affine) : 0;
    return window.cols == around || window.cols == around + 1 ? around : 0;
}

/// Samples of an overview per 360 degrees; absent if not a whole number.
std::optional<int> around_on(const Level& level, int around) {
    const double samples = around / level.scale.x;
    const double whole = std::round(samples);
    return std::abs(samples - whole) <= near_whole ? checked_int(whole) : std::nullopt;
}

/// `plan`, or that of the coarsest overview with nearly its resolution.
ReadPlan with_overview(GDALRasterBand& band, const Window& full, const RasterOptions& options,
                       int around, ReadPlan plan) {
    const double coarsest = plan.grid.step.x * coarser_for_overview;
    for (int i = 0; i < band.GetOverviewCount(); ++i) {
        const Level level = level_of(band, i, full);
        if (level.overview < 0 || level.window.cols < 2 || level.window.rows < 2) {
            continue;
        }
        const auto around_level = around_on(level, around);
        const auto reduction =
            around_level ? smallest_reduction(level.window, options.memory_budget, *around_level)
                         : std::nullopt;
        if (!reduction) {
            continue;
        }
        const ReadPlan candidate = plan_of(level, *reduction);
        if (candidate.grid.step.x <= coarsest && candidate.reduction < plan.reduction) {
            plan = candidate;
        }
    }
    return plan;
}

} // namespace

Result<ReadPlan> plan_reading(GDALDataset& dataset, const std::string& name,
                              const RasterOptions& options, std::vector<std::string>& notes) {
    auto window = window_of(dataset, name, options);
    if (!window) {
        return window.error();
    }
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    const double bytes = static_cast<double>(window->cols) * window->rows * bytes_per_sample;
    const int around = samples_to_divide(dataset, *window);
    auto reduction = smallest_reduction(*window, options.memory_budget, around);
    if (!reduction) {
        reduction = smallest_reduction(*window, options.memory_budget, 0);
    }
    if (!reduction) {
        return Error{
            fmt::format("{}: {}×{} samples take {} of memory, at most {} were expected, also "
                        "at 1/{}",
                        name, window->cols, window->rows, size_text(bytes),
                        size_text(static_cast<double>(options.memory_budget)), largest_reduction)};
    }
    ReadPlan plan = plan_of(Level{-1, glm::dvec2(1.0), *window}, *reduction);
    if (*reduction == 1) {
        return plan;
    }
    if (kind_of_values(dataset) == ValueKind::plain) {
        plan = with_overview(band, *window, options, around, plan);
    }
    const glm::dvec2 middle =
        glm::dvec2(window->col, window->row) + 0.5 * glm::dvec2(window->cols, window->rows);
    const glm::dvec2 last(plan.grid.cols - 1, plan.grid.rows - 1);
    plan.grid.to_middle = (middle - plan.grid.origin) / plan.grid.step - 0.5 * last;
    notes.push_back(fmt::format("{}×{} samples would take {}: read at 1/{:.4g} ({}×{}) to fit {}",
                                window->cols, window->rows, size_text(bytes), plan.grid.step.x,
                                plan.grid.cols, plan.grid.rows,
                                size_text(static_cast<double>(options.memory_budget))));
    return plan;
}

ReadPlan plan_window(GDALDataset& dataset, const Window& window, int reduction) {
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    const int overviews = kind_of_values(dataset) == ValueKind::plain ? band.GetOverviewCount() : 0;
    Level best{-1, glm::dvec2(1.0), window};
    for (int i = 0; i < overviews; ++i) {
        const Level level = level_of(band, i, window);
        const bool fine_enough = std::max(level.scale.x, level.scale.y) <= reduction + near_whole;
        if (level.overview >= 0 && fine_enough && level.scale.x > best.scale.x &&
            level.window.cols >= 1 && level.window.rows >= 1) {
            best = level;
        }
    }
    const int rest = static_cast<int>(reduction / std::max(best.scale.x, best.scale.y));
    return plan_of(best, std::clamp(rest, 1, std::min(best.window.cols, best.window.rows)));
}

} // namespace reljef::io
