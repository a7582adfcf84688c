#include "terrains/generators.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "terrains/natural/natural_land.h"

namespace reljef::terrains {
namespace {

constexpr int margin = 24; // cells that are cut off: they hide the border

std::optional<Error> natural_option_error(const GeneratorOptions& options) {
    if (options.size < 16 || options.size > 4096) {
        return Error{fmt::format("natural: the size is {}, expected 16 to 4096", options.size)};
    }
    if (!std::isfinite(options.spacing) || options.spacing < 0.0 || options.spacing > 10000.0) {
        return Error{fmt::format("natural: the spacing is {} m, expected more than 0 and at most "
                                 "10000, or 0 for the generator's own",
                                 options.spacing)};
    }
    if (options.tileable) {
        return Error{"natural: tileable was asked for, which only the urban generator supports"};
    }
    return std::nullopt;
}

template <class T> Grid<T> without_margin(const Grid<T>& grid, int size) {
    Grid<T> inner(size, size);
    for (int row = 0; row < size; ++row) {
        const auto from = grid.row(row + margin).subspan(margin, static_cast<std::size_t>(size));
        std::copy(from.begin(), from.end(), inner.row(row).begin());
    }
    return inner;
}

} // namespace

Result<terrain::Terrain> generate_natural(const GeneratorOptions& options) {
    if (std::optional<Error> error = natural_option_error(options)) {
        return *std::move(error);
    }
    natural::LandOptions land_options = options;
    land_options.size += 2 * margin;
    const auto report = [&](double part) {
        if (options.progress) {
            options.progress(part);
        }
    };
    struct Step {
        void (*work)(natural::Land& land, const natural::LandOptions& options);
        double progress;
    };
    natural::Land land = natural::make_relief(land_options);
    report(0.6);
    for (const auto& [work, progress] :
         {Step{natural::shape_valleys, 0.8}, Step{natural::draw_streams, 0.85}}) {
        if (options.stop.stop_requested()) {
            break;
        }
        work(land, land_options);
        report(progress);
    }
    if (options.stop.stop_requested()) {
        return Error{"natural: generating was stopped"};
    }
    terrain::Terrain terrain;
    terrain.name = "natural";
    terrain.color = without_margin(natural::paint_cover(land, land_options), options.size);
    report(1.0);
    terrain::Heightfield& field = terrain.heightfield;
    field.heights = without_margin(land.heights, options.size);
    const double spacing =
        options.spacing > 0.0 ? options.spacing : double{natural::design_spacing};
    const auto scale = static_cast<float>(spacing / double{natural::design_spacing});
    for (float& height : field.heights.samples()) {
        height = scale * (height + natural::base_height);
    }
    field.spacing = glm::dvec2{spacing};
    field.range = terrain::height_range(field.heights, field.void_mask);
    return terrain;
}

} // namespace reljef::terrains
