#include "engine/io/imagery/imagery.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/io/imagery/imagery_set.h"
#include "engine/io/raster/crs_transform.h"
#include "engine/io/raster/globe.h"

namespace reljef::io {
namespace {

constexpr double bytes_per_pixel = 16.0 / 3.0; // with mipmaps
constexpr double min_budget_share = 0.25;
constexpr std::size_t reading_part = 8;       // divides the budget for reading
constexpr double max_pixels_read = 1U << 31U; // to read of an image: about half a minute

/// Of a raster without coordinates: its pixels, with y upwards. GDAL ignores an identity affine, so
/// this one has an offset.
constexpr geo::PixelAffine pixel_space{1000.0, 1.0, 0.0, 1000.0, 0.0, -1.0};

/// The finest image's resolution over the samples, within the limits; absent if no image reaches
/// there.
std::optional<glm::ivec2> picture_size(const ImagerySet& set, const TexelGrid& samples,
                                       std::size_t budget) {
    const auto pixels = set.finest_pixels_in(samples);
    if (!pixels) {
        return std::nullopt;
    }
    const glm::dvec2 intervals = glm::dvec2(samples.cols - 1, samples.rows - 1) * *pixels;
    const glm::dvec2 desired = glm::clamp(glm::round(intervals) + 1.0, 2.0, 1e6);
    const double used = static_cast<double>(samples.cols) * samples.rows * bytes_per_sample;
    const double whole = static_cast<double>(budget);
    const double texels = std::max(whole - used, whole * min_budget_share) / bytes_per_pixel;
    const double shrink = std::min({1.0, max_image_side / std::max(desired.x, desired.y),
                                    std::sqrt(texels / (desired.x * desired.y))});
    const glm::dvec2 size = desired * shrink + 1e-6;
    return glm::ivec2(clamped_int(size.x, 2, max_image_side),
                      clamped_int(size.y, 2, max_image_side));
}

double covered_share(const Image& image) {
    const auto pixels = image.samples();
    const auto covered =
        std::count_if(pixels.begin(), pixels.end(), [](Rgba8 pixel) { return pixel.a != 0; });
    return pixels.empty() ? 0.0 : static_cast<double>(covered) / static_cast<double>(pixels.size());
}

std::string name_of(const std::vector<std::filesystem::path>& images) {
    return images.size() == 1 ? images.front().string()
                              : fmt::format("the {} images", images.size());
}

std::string too_much_text(const std::filesystem::path& image) {
    return fmt::format(
        "{0}: more than {1:.0f} pixels would be read, overviews were expected; the image is left "
        "out where the terrain is seen whole, and 'gdaladdo -r average {0} 2 4 8 16 32 64' adds "
        "them",
        image.string(), max_pixels_read);
}

template <class Texts> void append(const Texts& texts, std::vector<std::string>& list) {
    list.insert(list.end(), texts.begin(), texts.end());
}

} // namespace

ImageryGround imagery_ground(GDALDataset& heights) {
    const glm::ivec2 size(heights.GetRasterXSize(), heights.GetRasterYSize());
    const auto affine = affine_of(heights);
    std::vector<std::string> ignored;
    const auto crs = affine ? horizontal_crs(heights, ignored) : std::nullopt;
    return crs && crs->IsLocal() == 0 ? ImageryGround{wkt_of(*crs), *affine, size}
                                      : ImageryGround{"", pixel_space, size};
}

Result<Image> read_imagery(const ImageryGround& ground, const Place& place,
                           const RasterOptions& options, std::vector<std::string>& notes,
                           std::vector<std::string>& errors) {
    const auto set = ImagerySet::open(options.imagery, ground,
                                      {.reading_memory = options.memory_budget / reading_part,
                                       .keeps_open = false,
                                       .white = options.imagery_white,
                                       .stop = options.stop});
    if (!set) {
        return set.error();
    }
    append(set->notes(), notes);
    const SampleGrid grid = closed(place.grid, place.wrap);
    const TexelGrid samples{affine_of_samples(ground.affine, grid), grid.cols, grid.rows};
    const auto size = picture_size(*set, samples, options.memory_budget);
    ImageryWindow window;
    if (size) {
        const glm::dvec2 step = glm::dvec2(grid.cols - 1, grid.rows - 1) / glm::dvec2(*size - 1);
        window = set->read(
            {affine_of_samples(samples.affine, {glm::dvec2(0.0), step}), size->x, size->y},
            {.max_pixels = max_pixels_read, .progress = options.progress, .stop = options.stop});
    }
    if (options.stop.stop_requested()) {
        return Error{name_of(options.imagery) + ": reading was stopped"};
    }
    append(set->take_new_notes(), notes);
    append(set->errors(), errors);
    for (const FileError& error : window.errors) {
        errors.push_back(error.message);
    }
    if (size) {
        wrap_picture(window.texels, {place.wrap, place.grid.rows}, 0.0, grid.rows - 1);
    }
    if (!window.needs_overviews.empty()) {
        errors.push_back(too_much_text(window.needs_overviews));
    }
    const double share = covered_share(window.texels);
    if (share == 0.0 && !window.needs_overviews.empty()) {
        return Image();
    }
    if (share == 0.0) {
        return Error{!window.errors.empty()
                         ? window.errors.front().message
                         : fmt::format("{}: shows nothing of the terrain, an image that overlaps "
                                       "was expected",
                                       name_of(options.imagery))};
    }
    if (share < 0.995) {
        notes.push_back(fmt::format("imagery covers {:.0f} % of the terrain", 100.0 * share));
    }
    return std::move(window.texels);
}

} // namespace reljef::io
