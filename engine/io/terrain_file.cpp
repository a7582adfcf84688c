#include "engine/io/terrain_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/io/imagery/imagery.h"
#include "engine/io/raster/ascii_grid.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/sample_reader.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

constexpr std::size_t max_gdal_notes = 3;

/// Part of a longer progress.
Progress part(const Progress& whole, double begin, double end) {
    if (!whole) {
        return {};
    }
    return [whole, begin, end](double fraction) { whole(begin + (end - begin) * fraction); };
}

Result<void> check_options(const RasterOptions& options, const std::string& name) {
    if (!std::isfinite(options.height_scale) || options.height_scale == 0.0 ||
        !std::isfinite(options.height_offset)) {
        return Error{
            fmt::format("{}: height scale {} and offset {} were asked for, finite numbers and a "
                        "scale other than 0 were expected",
                        name, options.height_scale, options.height_offset)};
    }
    return {};
}

Result<Samples> samples_with_heights(GDALDataset& dataset, const ReadPlan& plan,
                                     const std::string& name, const RasterOptions& options,
                                     const GdalMessages& messages,
                                     std::vector<std::string>& notes) {
    auto samples = read_samples(dataset, plan, name, options, messages, notes);
    if (samples && samples->void_count == samples->heights.size()) {
        const RasterOptions::Window whole{0, 0, dataset.GetRasterXSize(), dataset.GetRasterYSize()};
        const RasterOptions::Window read = options.window.value_or(whole);
        return Error{
            fmt::format("{}: all {}×{} samples are voids, at least one height was expected", name,
                        read.cols, read.rows)};
    }
    return samples;
}

void note_messages(const GdalMessages& messages, std::vector<std::string>& notes) {
    const std::size_t count = std::min(messages.all().size(), max_gdal_notes);
    for (std::size_t i = 0; i < count; ++i) {
        notes.push_back("GDAL says: " + messages.all()[i]);
    }
}

} // namespace

Result<terrain::Terrain> read_terrain(const std::filesystem::path& path,
                                      const RasterOptions& options) {
    const std::string name = path.string();
    if (auto good = check_options(options, name); !good) {
        return good.error();
    }
    const ReadScope scope(options.stop);
    GdalMessages messages;
    auto raster = open_whole_raster(path, messages);
    if (!raster) {
        return raster.error();
    }
    GDALDataset& dataset = *raster->dataset;
    terrain::Terrain terrain;
    terrain.name = path.filename().string();
    if (raster->mixed_overviews.value_or(false)) {
        terrain.notes.emplace_back(mixed_overviews_note);
    }
    const auto plan = plan_reading(dataset, name, options, terrain.notes);
    if (!plan) {
        return plan.error();
    }
    auto place = place_of(dataset, plan->grid, name, options, terrain.notes);
    if (!place) {
        return place.error();
    }
    note_messages(messages, terrain.notes);
    RasterOptions reading = options;
    reading.undeclared_voids = std::move(raster->undeclared_voids);
    reading.progress = part(options.progress, 0.0, options.imagery.empty() ? 1.0 : 0.5);
    auto samples = samples_with_heights(dataset, *plan, name, reading, messages, terrain.notes);
    if (!samples) {
        return samples.error();
    }
    const glm::dvec2 step = glm::abs(place->grid.step);
    terrain.heightfield =
        heightfield_of(std::move(*samples), *place, std::max({1.0, step.x, step.y}));
    if (place->spacing_assumed) {
        const glm::dvec2 steps =
            glm::dvec2(plan->grid.cols - 1, plan->grid.rows - 1) * glm::abs(plan->grid.step);
        terrain.heightfield.spacing *=
            assumed_spacing(terrain.heightfield.range, steps, terrain.notes);
    }
    if (!options.imagery.empty()) {
        reading.progress = part(options.progress, 0.5, 1.0);
        auto color =
            read_imagery(imagery_ground(dataset), *place, reading, terrain.notes, terrain.errors);
        if (!color) {
            return color.error();
        }
        terrain.color = std::move(*color);
    }
    return terrain;
}

} // namespace reljef::io
