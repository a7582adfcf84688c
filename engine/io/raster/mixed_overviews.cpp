#include "engine/io/raster/mixed_overviews.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>

#include "engine/core/grid.h"
#include "engine/io/raster/sample_decoder.h"
#include "engine/io/raster/web_tiles.h"

namespace reljef::io {
namespace {

constexpr double max_overview_samples = 512.0 * 512.0;   // of the examined overview
constexpr double max_remote_samples = 256.0 * 256.0;     // if the file is remote
constexpr double max_coarsest_samples = 2048.0 * 2048.0; // if no overview is that small
constexpr std::size_t max_suspects = 8;
// An undeclared void lowers the sum of the samples behind an overview sample by at least this.
constexpr double min_drop = 8192.0;
constexpr int max_suspect_samples = 256; // per side of the area of a suspect
constexpr double rounding = 1.0;         // of averages stored as whole numbers
// Of the part of a raster that shows which values are isolated.
constexpr double max_searched_samples = 1 << 21;
constexpr int max_searched_blocks = 64;
constexpr int max_remote_blocks = 8;
constexpr int max_block_samples = 1 << 15; // of each block
constexpr int max_strip_samples = 1 << 16; // read at a time, if a block has no more

double samples_of_band(GDALRasterBand& band) {
    return static_cast<double>(band.GetXSize()) * band.GetYSize();
}

/// The finest overview within `max_samples`, else the coarsest; null if it is too large.
GDALRasterBand* small_overview(GDALRasterBand& band, double max_samples) {
    GDALRasterBand* finest = nullptr;
    GDALRasterBand* coarsest = nullptr;
    for (int i = 0; i < band.GetOverviewCount(); ++i) {
        GDALRasterBand* overview = band.GetOverview(i);
        if (overview == nullptr || overview->GetXSize() < 2 || overview->GetYSize() < 2) {
            continue;
        }
        const double samples = samples_of_band(*overview);
        coarsest =
            coarsest == nullptr || samples < samples_of_band(*coarsest) ? overview : coarsest;
        const bool finer = finest == nullptr || samples > samples_of_band(*finest);
        finest = samples <= max_samples && finer ? overview : finest;
    }
    const bool readable = coarsest != nullptr && samples_of_band(*coarsest) <= max_coarsest_samples;
    return finest != nullptr ? finest : readable ? coarsest : nullptr;
}

/// Stored values of a window; empty if unreadable.
Grid<double> stored_values(GDALRasterBand& band, const RasterOptions::Window& part) {
    Grid<double> values(part.cols, part.rows);
    const glm::ivec2 size(part.cols, part.rows);
    const bool read =
        read_window(band, {{part.col, part.row}, size, values.samples().data(), size});
    return read ? std::move(values) : Grid<double>();
}

/// An overview sample that is lower than a neighbour.
struct Suspect {
    double drop = 0.0; ///< stored values
    int col = 0;
    int row = 0;
};

double drop_at(const Grid<double>& values, const Grid<double>& heights, int col, int row) {
    double drop = 0.0;
    for (const auto& [c, r] : {std::pair{col - 1, row}, std::pair{col + 1, row},
                               std::pair{col, row - 1}, std::pair{col, row + 1}}) {
        const bool inside = c >= 0 && r >= 0 && c < values.cols() && r < values.rows();
        if (inside && !std::isnan(heights(c, r))) {
            drop = std::max(drop, values(c, r) - values(col, row));
        }
    }
    return drop;
}

/// The steepest drops of at least `min`; `heights` are NaN at voids.
std::vector<Suspect> suspects_in(const Grid<double>& values, const Grid<double>& heights,
                                 double min) {
    std::vector<Suspect> suspects;
    for (int row = 0; row < values.rows(); ++row) {
        for (int col = 0; col < values.cols(); ++col) {
            const double drop =
                std::isnan(heights(col, row)) ? 0.0 : drop_at(values, heights, col, row);
            if (drop >= min) {
                suspects.push_back({drop, col, row});
            }
        }
    }
    const auto end =
        suspects.begin() + static_cast<std::ptrdiff_t>(std::min(suspects.size(), max_suspects));
    std::partial_sort(suspects.begin(), end, suspects.end(),
                      [](const Suspect& a, const Suspect& b) { return a.drop > b.drop; });
    suspects.erase(end, suspects.end());
    return suspects;
}

/// The full-resolution samples behind an overview sample, and half as many around them.
RasterOptions::Window covered_by(const Suspect& suspect, GDALRasterBand& band,
                                 GDALRasterBand& overview) {
    // A raster may have 2^31 - 1 columns.
    const auto side = [](std::int64_t at, std::int64_t full, std::int64_t reduced) {
        const std::int64_t step = std::max<std::int64_t>(1, (full + reduced - 1) / reduced);
        const std::int64_t begin = at * full / reduced;
        const std::int64_t first = std::clamp<std::int64_t>(begin - step / 2, 0, full - 1);
        const std::int64_t end = std::clamp(begin + step + step / 2 + 1, first + 1, full);
        return std::pair{static_cast<int>(first), static_cast<int>(std::min<std::int64_t>(
                                                      end - first, max_suspect_samples))};
    };
    const auto [col, cols] = side(suspect.col, band.GetXSize(), overview.GetXSize());
    const auto [row, rows] = side(suspect.row, band.GetYSize(), overview.GetYSize());
    return {col, row, cols, rows};
}

/// Whether an overview value is below all heights behind it, which include undeclared voids.
bool is_mixture(double value, const Grid<double>& values, SampleDecoder decoder) {
    Grid<double> heights = values;
    decoder.decode(heights.samples(), {}, {});
    if (decoder.undeclared_voids_note("").empty()) {
        return false;
    }
    bool below_all = true;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const bool is_void = std::isnan(heights.samples()[i]);
        below_all = below_all && (is_void || value < values.samples()[i] - rounding);
    }
    return below_all;
}

using Windows = std::vector<RasterOptions::Window>;

/// All of a raster, in strips of whole blocks: few samples are in memory at a time.
Windows strips_of(GDALRasterBand& band) {
    const glm::ivec2 size(band.GetXSize(), band.GetYSize());
    glm::ivec2 block(1);
    band.GetBlockSize(&block.x, &block.y);
    const int rows_at_once = std::max(max_strip_samples / size.x, 1);
    const int rows = std::max(rows_at_once / block.y, 1) * std::min(block.y, size.y);
    Windows strips;
    for (int row = 0; row < size.y; row += rows) {
        strips.push_back({0, row, size.x, std::min(rows, size.y - row)});
    }
    return strips;
}

/// Blocks that are spread over a raster, or parts of large ones.
Windows spread_blocks(GDALRasterBand& band, int max_count) {
    glm::ivec2 block(1);
    band.GetBlockSize(&block.x, &block.y);
    block = glm::min(block, {band.GetXSize(), band.GetYSize()});
    const glm::ivec2 size(std::min(block.x, max_block_samples),
                          std::clamp(max_block_samples / block.x, 1, block.y));
    const glm::i64vec2 blocks((std::int64_t{band.GetXSize()} + block.x - 1) / block.x,
                              (std::int64_t{band.GetYSize()} + block.y - 1) / block.y);
    const auto count = std::min<std::int64_t>(blocks.x * blocks.y, max_count);
    Windows parts;
    for (std::int64_t i = 0; i < count; ++i) {
        const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        const auto number = static_cast<std::int64_t>(share * static_cast<double>(blocks.x) *
                                                      static_cast<double>(blocks.y));
        // A part of a large block lies as far into it as the block lies into the raster.
        const glm::i64vec2 first =
            glm::i64vec2(number % blocks.x, number / blocks.x) * glm::i64vec2(block) +
            glm::i64vec2(share * glm::dvec2(block - size));
        const auto inside = [&](int axis, int samples) {
            return static_cast<int>(std::clamp<std::int64_t>(samples - first[axis], 1, size[axis]));
        };
        parts.push_back({clamped_int(static_cast<double>(first.x), 0, band.GetXSize() - 1),
                         clamped_int(static_cast<double>(first.y), 0, band.GetYSize() - 1),
                         inside(0, band.GetXSize()), inside(1, band.GetYSize())});
    }
    return parts;
}

/// What is isolated in each part is isolated in all. Empty if no part is readable, or, with
/// `needs_all`, if one is not.
std::optional<std::vector<double>> isolated_in(GDALRasterBand& band, const Windows& parts,
                                               bool needs_all, const SampleDecoder& decoder) {
    std::optional<std::vector<double>> isolated;
    for (const RasterOptions::Window& part : parts) {
        const Grid<double> values = stored_values(band, part);
        if (values.empty() && needs_all) {
            return std::nullopt;
        }
        if (values.empty()) {
            continue;
        }
        std::vector<double> here = decoder.isolated_voids(values.samples());
        if (isolated) {
            std::erase_if(here, [&](double value) {
                return std::find(isolated->begin(), isolated->end(), value) == isolated->end();
            });
        }
        isolated = std::move(here);
    }
    return isolated;
}

} // namespace

std::optional<bool> overviews_mix_voids(GDALDataset& dataset, const std::filesystem::path& path) {
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    if (is_web_tiles(path) || kind_of_values(dataset) != ValueKind::plain ||
        band.GetOverviewCount() == 0) {
        return false;
    }
    const GdalMessages ignored_messages;
    std::vector<std::string> ignored;
    const auto decoder = SampleDecoder::create(dataset, path.string(), {}, ignored);
    GDALRasterBand* overview =
        small_overview(band, is_remote(path) ? max_remote_samples : max_overview_samples);
    if (!decoder || overview == nullptr || !decoder->can_find_voids()) {
        return false;
    }
    const Grid<double> values =
        stored_values(*overview, {0, 0, overview->GetXSize(), overview->GetYSize()});
    if (values.empty()) {
        return std::nullopt;
    }
    const double share = samples_of_band(*overview) / samples_of_band(band);
    Grid<double> heights = values; // NaN at voids
    SampleDecoder(*decoder).decode(heights.samples(), {}, {});
    for (const Suspect& suspect : suspects_in(values, heights, min_drop * share)) {
        const Grid<double> below = stored_values(band, covered_by(suspect, band, *overview));
        if (below.empty()) {
            return std::nullopt;
        }
        if (is_mixture(values(suspect.col, suspect.row), below, *decoder)) {
            return true;
        }
    }
    return false;
}

std::optional<std::vector<double>> undeclared_voids(GDALDataset& dataset,
                                                    const std::filesystem::path& path) {
    if (is_web_tiles(path) || kind_of_values(dataset) != ValueKind::plain) {
        return std::vector<double>();
    }
    const GdalMessages ignored_messages;
    std::vector<std::string> ignored;
    const auto decoder = SampleDecoder::create(dataset, path.string(), {}, ignored);
    if (!decoder || !decoder->can_find_voids()) {
        return std::vector<double>();
    }
    const bool remote = is_remote(path);
    GDALRasterBand* band = dataset.GetRasterBand(1);
    if (samples_of_band(*band) > (remote ? max_remote_samples : max_searched_samples)) {
        GDALRasterBand* overview =
            small_overview(*band, remote ? max_remote_samples : max_overview_samples);
        if (overview == nullptr) {
            const Windows parts =
                spread_blocks(*band, remote ? max_remote_blocks : max_searched_blocks);
            return isolated_in(*band, parts, false, *decoder);
        }
        band = overview;
    }
    return isolated_in(*band, strips_of(*band), true, *decoder);
}

} // namespace reljef::io
