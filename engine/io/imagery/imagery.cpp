#include "engine/io/imagery/imagery.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdalwarper.h>
#include <glm/common.hpp>

#include "engine/io/files/tile_grid.h"
#include "engine/io/imagery/degree_box.h"
#include "engine/io/imagery/image_files.h"
#include "engine/io/imagery/imagery_set.h"
#include "engine/io/imagery/rgb_image.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/globe.h"

namespace reljef::io {
namespace {

constexpr double bytes_per_pixel = 16.0 / 3.0; // with mipmaps
constexpr double min_budget_share = 0.25;
constexpr std::size_t reading_part = 8; // divides the budget for reading

/// A coordinate system of both heights and image: `crs`, or the heights' pixels with y upwards.
struct CommonSpace {
    geo::PixelAffine from_heights; ///< from GDAL's pixel coordinates
    std::optional<OGRSpatialReference> crs;
    [[nodiscard]] bool stretched() const { return !crs; } ///< the image has no place
};

/// GDAL ignores an identity affine, so this one has an offset.
constexpr double pixel_space_origin = 1000.0;
constexpr geo::PixelAffine pixel_space{pixel_space_origin, 1.0, 0.0, pixel_space_origin, 0.0, -1.0};

bool has_place(GDALDataset& image) {
    return affine_of(image) || image.GetGCPCount() > 0;
}

CommonSpace common_space_of(GDALDataset& heights, GDALDataset& image,
                            std::vector<std::string>& notes) {
    const auto affine = affine_of(heights);
    std::vector<std::string> ignored;
    auto crs = affine ? horizontal_crs(heights, ignored) : std::nullopt;
    const bool image_placed = has_place(image);
    if (image_placed && affine && crs && crs->IsLocal() == 0) {
        return {*affine, std::move(crs)};
    }
    if (image_placed) {
        notes.emplace_back(
            "imagery: the terrain names no place, so the image is stretched over it");
    }
    return {pixel_space, std::nullopt};
}

/// Maps corner pixels to corner samples.
geo::PixelAffine stretched(GDALDataset& heights, GDALDataset& image) {
    const glm::dvec2 samples(heights.GetRasterXSize() - 1, heights.GetRasterYSize() - 1);
    const glm::dvec2 pixels(std::max(image.GetRasterXSize() - 1, 1),
                            std::max(image.GetRasterYSize() - 1, 1));
    const glm::dvec2 scale = samples / pixels;
    const glm::dvec2 corner = 0.5 - 0.5 * scale;
    return {pixel_space.x0 + corner.x, scale.x, 0.0, pixel_space.y0 - corner.y, 0.0, -scale.y};
}

bool names_crs(GDALDataset& image) {
    return image.GetSpatialRef() != nullptr || image.GetGCPSpatialRef() != nullptr;
}

Result<void> place_image(GDALDataset& heights, GDALDataset& image, const CommonSpace& space,
                         const std::string& name) {
    if (space.stretched()) {
        place_raster(image, stretched(heights, image), nullptr);
    } else if (!names_crs(image)) {
        if (image.SetSpatialRef(&*space.crs) != CE_None) {
            return Error{fmt::format(
                "{}: its place cannot be read, a georeferenced image was expected", name)};
        }
    }
    return {};
}

/// Size of the image's pixels in the common space.
std::optional<glm::dvec2> pixel_size(GDALDataset& image, const CommonSpace& space) {
    std::array<double, 6> t{};
    const bool has_affine = image.GetGeoTransform(t.data()) == CE_None;
    const OGRSpatialReference* crs = image.GetSpatialRef();
    if (has_affine && (!space.crs || (crs != nullptr && crs->IsSame(&*space.crs) != 0))) {
        return glm::dvec2(std::hypot(t[1], t[4]), std::hypot(t[2], t[5]));
    }
    CPLStringList options;
    options.SetNameValue("DST_SRS", wkt_of(*space.crs, "FORMAT=DEFAULT").c_str());
    const std::unique_ptr<void, decltype(&GDALDestroyGenImgProjTransformer)> transformer(
        GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&image), nullptr, options.List()),
        &GDALDestroyGenImgProjTransformer);
    int cols = 0;
    int rows = 0;
    if (transformer == nullptr ||
        GDALSuggestedWarpOutput(GDALDataset::ToHandle(&image), GDALGenImgProjTransform,
                                transformer.get(), t.data(), &cols, &rows) != CE_None) {
        return std::nullopt;
    }
    return glm::dvec2(std::abs(t[1]), std::abs(t[5]));
}

/// A placed image. It is not open: there may be too many.
struct PlacedImage {
    std::filesystem::path path;
    CommonSpace space;
    glm::dvec2 pixel{1.0}; ///< size in the common space
    bool has_place = true;
    /// Multiples of 360 degrees that move it onto the heights; empty: no overlap.
    std::vector<double> turns{0.0};
};

/// The placed image as RGB, subsampled if it is huge.
Result<Dataset> open_colors(const std::filesystem::path& path, double white, GDALDataset& heights,
                            const CommonSpace& space, const GdalMessages& messages) {
    auto colors = open_rgb(path, white, messages);
    if (!colors) {
        return colors.error();
    }
    if (const int subsampling = subsampling_of(**colors); subsampling > 1) {
        *colors = subsampled(std::move(*colors), subsampling);
        if (*colors == nullptr) {
            return unreadable_image(path, messages);
        }
    }
    if (auto good = place_image(heights, **colors, space, path.string()); !good) {
        return good.error();
    }
    return colors;
}

/// The image's own resolution over the samples, within the limits.
glm::ivec2 target_size(const SampleGrid& grid, const CommonSpace& space, glm::dvec2 pixel,
                       std::size_t budget) {
    const geo::PixelAffine& affine = space.from_heights;
    const glm::dvec2 sample(std::hypot(affine.x_col, affine.y_col) * std::abs(grid.step.x),
                            std::hypot(affine.x_row, affine.y_row) * std::abs(grid.step.y));
    const glm::dvec2 intervals = glm::dvec2(grid.cols - 1, grid.rows - 1) * sample / pixel;
    const glm::dvec2 desired = glm::clamp(glm::round(intervals) + 1.0, 2.0, 1e6);
    const double used = static_cast<double>(grid.cols) * grid.rows * bytes_per_sample;
    const double whole = static_cast<double>(budget);
    const double pixels = std::max(whole - used, whole * min_budget_share) / bytes_per_pixel;
    const double shrink = std::min({1.0, max_image_side / std::max(desired.x, desired.y),
                                    std::sqrt(pixels / (desired.x * desired.y))});
    const glm::dvec2 size = desired * shrink + 1e-6;
    return {clamped_int(size.x, 2, max_image_side), clamped_int(size.y, 2, max_image_side)};
}

/// Units of x in the common space; 0 if it is not in degrees.
double units_of(double degrees, const CommonSpace& space) {
    const bool in_degrees = space.crs && space.crs->IsGeographic() != 0;
    return in_degrees ? degrees / glm::degrees(space.crs->GetAngularUnits()) : 0.0;
}

/// A raster over the samples, edge to edge, moved by −`turn` degrees.
Dataset target_of(Image& image, const SampleGrid& grid, const CommonSpace& space, double turn) {
    Dataset target = raster_over(image);
    if (target == nullptr) {
        return target;
    }
    // Pixel X (outer corner 0) is sample (X − 0.5)·q.
    const glm::dvec2 q =
        glm::dvec2(grid.cols - 1, grid.rows - 1) / glm::dvec2(image.cols() - 1, image.rows() - 1);
    const geo::PixelAffine& from = space.from_heights;
    const glm::dvec2 step = grid.step * q;
    const glm::dvec2 corner = from.crs_from_pixel(grid.pixel_from_sample(-0.5 * q));
    const geo::PixelAffine affine{corner.x - units_of(turn, space),
                                  from.x_col * step.x,
                                  from.x_row * step.y,
                                  corner.y,
                                  from.y_col * step.x,
                                  from.y_row * step.y};
    place_raster(*target, affine, space.crs ? &*space.crs : nullptr);
    return target;
}

double covered_share(const Image& image) {
    const auto pixels = image.samples();
    const auto covered =
        std::count_if(pixels.begin(), pixels.end(), [](Rgba8 pixel) { return pixel.a != 0; });
    return static_cast<double>(covered) / static_cast<double>(pixels.size());
}

/// Composites pictures; the first one is on top.
class Drape {
public:
    Drape(GDALDataset& heights, const SampleGrid& grid, const RasterOptions& options, double white,
          Image image)
        : heights_(heights), grid_(grid), options_(options), white_(white),
          image_(std::move(image)) {}

    /// Draws the `index`-th of `count` pictures; fails if it is unreadable.
    Result<void> add(const PlacedImage& picture, std::size_t index, std::size_t count) {
        const GdalMessages messages;
        const auto colors = open_colors(picture.path, white_, heights_, picture.space, messages);
        if (!colors) {
            return colors.error();
        }
        WarpOptions warping{.overview = automatic_overview,
                            .scale = 0.0,
                            .memory = options_.memory_budget / reading_part,
                            .progress = {},
                            .stop = options_.stop};
        if (options_.progress) {
            warping.progress = [&](double done) {
                options_.progress((static_cast<double>(index) + done) / static_cast<double>(count));
            };
        }
        for (const double turn : picture.turns) {
            Image drawn(image_.cols(), image_.rows(), Rgba8{0, 0, 0, 0});
            const Dataset target = target_of(drawn, grid_, picture.space, turn);
            if (target == nullptr || !warp(**colors, *target, warping)) {
                return unreadable_image(picture.path, messages);
            }
            composite_under(image_, drawn);
            if (messages.has_lost_blocks()) {
                return unreadable_image(picture.path, messages);
            }
        }
        return {};
    }
    [[nodiscard]] bool is_full() const { return is_opaque(image_); }
    Image take() && { return std::move(image_); }

private:
    GDALDataset& heights_;
    const SampleGrid& grid_;
    const RasterOptions& options_;
    double white_;
    Image image_;
};

void note_subsampling(GDALDataset& image, std::vector<std::string>& notes) {
    if (const int subsampling = subsampling_of(image); subsampling > 1) {
        notes.push_back(fmt::format("imagery: one of {} pixels a side is read of its {}×{}",
                                    subsampling, image.GetRasterXSize(), image.GetRasterYSize()));
    }
}

std::optional<DegreeBox> box_of(const SampleGrid& grid, const CommonSpace& space) {
    const glm::dvec2 last(grid.cols - 1, grid.rows - 1);
    const auto degrees = places_over(
        [&](glm::dvec2 part) {
            return space.from_heights.crs_from_pixel(grid.pixel_from_sample(part * last));
        },
        wkt_of(*space.crs));
    return degrees.empty() ? std::nullopt : std::optional(padded_box(degrees));
}

/// Empty only if both are known not to overlap.
std::vector<double> turns_of(const SampleGrid& grid, GDALDataset& image, const CommonSpace& space) {
    const auto ground = space.crs ? box_of(grid, space) : std::nullopt;
    const auto shown = ground ? places_over(image) : std::vector<glm::dvec2>();
    if (shown.empty()) {
        return {0.0};
    }
    const std::vector<double> turns = turns_to_meet(padded_box(shown), *ground);
    const bool in_degrees = space.crs->IsGeographic() != 0;
    return turns.empty() || in_degrees ? turns : std::vector{0.0};
}

Result<PlacedImage> placed_image(const std::filesystem::path& path, double white,
                                 GDALDataset& heights, const SampleGrid& grid,
                                 std::vector<std::string>& notes) {
    const GdalMessages messages;
    auto image = open_raster(path, messages);
    if (!image) {
        return image.error();
    }
    if (auto good = check_affine(**image, path.string()); !good) {
        return good.error();
    }
    PlacedImage picture{path, common_space_of(heights, **image, notes), {}, has_place(**image)};
    if (!picture.space.stretched() && !names_crs(**image)) {
        notes.push_back(fmt::format("imagery: {} names no coordinate system, so that of the "
                                    "terrain is taken",
                                    path.filename().string()));
    }
    auto colors = open_colors(path, white, heights, picture.space, messages);
    if (!colors) {
        return colors.error();
    }
    note_subsampling(**image, notes);
    const auto pixel = pixel_size(**colors, picture.space);
    if (!pixel) {
        return unreadable_image(path, messages);
    }
    picture.pixel = *pixel;
    picture.turns = turns_of(grid, **colors, picture.space);
    return picture;
}

/// See resolution().
double resolution_over_heights(const PlacedImage& picture) {
    const geo::PixelAffine& from = picture.space.from_heights;
    return resolution(picture.pixel /
                      std::sqrt(std::abs(from.x_col * from.y_row - from.x_row * from.y_col)));
}

/// Readable pictures: finest first, then newest. Adds errors for the others.
std::vector<PlacedImage> placed_images(const ImageFiles& files, GDALDataset& heights,
                                       const SampleGrid& grid, std::vector<std::string>& notes,
                                       std::vector<std::string>& errors) {
    std::vector<PlacedImage> pictures;
    for (const std::filesystem::path& path : files.paths) {
        auto picture = placed_image(path, files.white, heights, grid, notes);
        if (picture) {
            pictures.push_back(std::move(*picture));
        } else {
            errors.push_back(picture.error().message);
        }
    }
    std::stable_sort(pictures.begin(), pictures.end(),
                     [](const PlacedImage& a, const PlacedImage& b) {
                         return resolution_over_heights(a) < resolution_over_heights(b);
                     });
    return pictures;
}

/// Images without a place are stretched over the terrain only if no image has a place.
void leave_out_unplaced(std::vector<PlacedImage>& pictures, std::vector<std::string>& notes) {
    const auto stretched = [](const PlacedImage& picture) { return picture.space.stretched(); };
    if (std::all_of(pictures.begin(), pictures.end(), stretched)) {
        return;
    }
    for (const PlacedImage& picture : pictures) {
        if (stretched(picture)) {
            notes.push_back(
                fmt::format("imagery: {} names no place on Earth: it is left out beside "
                            "images that do",
                            picture.path.filename().string()));
        }
    }
    std::erase_if(pictures, stretched);
}

std::string name_of(const std::vector<std::filesystem::path>& images) {
    return images.size() == 1 ? images.front().string()
                              : fmt::format("the {} images", images.size());
}

Error shows_nothing(const RasterOptions& options) {
    return {fmt::format("{}: shows nothing of the terrain, an image that overlaps was expected",
                        name_of(options.imagery))};
}

void note_share(double share, std::vector<std::string>& notes) {
    if (share < 0.995) {
        notes.push_back(fmt::format("imagery covers {:.0f} % of the terrain", 100.0 * share));
    }
}

void note_stretching(std::span<const PlacedImage> pictures, GDALDataset& heights,
                     std::vector<std::string>& notes) {
    for (const PlacedImage& picture : pictures) {
        if (!picture.has_place && affine_of(heights)) {
            notes.push_back(fmt::format("imagery: {} names no place, so it is stretched over the "
                                        "terrain",
                                        picture.path.filename().string()));
        }
    }
}

} // namespace

Result<Image> read_imagery(GDALDataset& heights, const Place& place, const RasterOptions& options,
                           std::vector<std::string>& notes, std::vector<std::string>& errors) {
    const SampleGrid grid = closed(place.grid, place.wrap);
    std::vector<std::string> wrong;
    const ImageFiles files =
        image_files(options.imagery, wrong, options.stop, options.imagery_white);
    if (options.stop.stop_requested()) {
        return Error{name_of(options.imagery) + ": reading was stopped"};
    }
    std::vector<PlacedImage> pictures = placed_images(files, heights, grid, notes, wrong);
    if (pictures.empty()) {
        check(!wrong.empty(), "a list of images without images");
        return Error{wrong.front()};
    }
    leave_out_unplaced(pictures, notes);
    note_stretching(pictures, heights, notes);
    std::erase_if(pictures, [](const PlacedImage& picture) { return picture.turns.empty(); });
    if (pictures.empty()) {
        return shows_nothing(options);
    }
    const glm::ivec2 size =
        target_size(grid, pictures.front().space, pictures.front().pixel, options.memory_budget);
    Drape drape(heights, grid, options, files.white, Image(size.x, size.y, Rgba8{0, 0, 0, 0}));
    bool any = false;
    for (std::size_t i = 0; i < pictures.size() && !drape.is_full(); ++i) {
        const auto drawn = drape.add(pictures[i], i, pictures.size());
        if (options.stop.stop_requested()) {
            return Error{pictures[i].path.string() + ": reading was stopped"};
        }
        any = any || drawn;
        if (!drawn) {
            wrong.push_back(drawn.error().message);
        }
    }
    if (!any) {
        return Error{wrong.front()};
    }
    Image result = std::move(drape).take();
    wrap_picture(result, {place.wrap, place.grid.rows}, 0.0, grid.rows - 1);
    const double share = covered_share(result);
    if (share == 0.0) {
        return shows_nothing(options);
    }
    note_share(share, notes);
    errors.insert(errors.end(), wrong.begin(), wrong.end());
    return result;
}

} // namespace reljef::io
