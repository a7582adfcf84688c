#include "engine/io/imagery.h"

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
#include <glm/geometric.hpp>

#include "engine/io/gdal_dataset.h"
#include "engine/io/georeferencing.h"
#include "engine/io/image_files.h"
#include "engine/io/rgb_image.h"

namespace reljef::io {
namespace {

constexpr double bytes_per_pixel = 16.0 / 3.0; // with mipmaps
constexpr double least_budget_share = 0.25;

/// Where the heights and the image meet: a space both have an affine to. `crs` absent: the heights'
/// own pixels, y upwards.
struct Meeting {
    geo::PixelAffine from_heights; ///< from the heights' GDAL pixel coordinates
    std::optional<OGRSpatialReference> crs;
    bool stretched = false; ///< the image has no place of its own
};

std::array<double, 6> geotransform(const geo::PixelAffine& affine) {
    return {affine.x0, affine.x_col, affine.x_row, affine.y0, affine.y_col, affine.y_row};
}

/// Some offset: GDAL takes an affine without one for none.
constexpr double pixel_space_origin = 1000.0;
constexpr geo::PixelAffine pixel_space{pixel_space_origin, 1.0, 0.0, pixel_space_origin, 0.0, -1.0};

Meeting meeting_of(GDALDataset& heights, GDALDataset& image, std::vector<std::string>& notes) {
    const auto affine = affine_of(heights);
    std::vector<std::string> ignored;
    auto crs = affine ? horizontal_crs(heights, ignored) : std::nullopt;
    const bool image_placed = affine_of(image) || image.GetGCPCount() > 0;
    if (image_placed && affine && crs && crs->IsLocal() == 0) {
        return {*affine, std::move(crs), false};
    }
    if (image_placed) {
        notes.emplace_back(
            "imagery: the terrain names no place, so the image is stretched over it");
    }
    return {pixel_space, std::nullopt, true};
}

/// Corner pixels on the heights' corner samples.
geo::PixelAffine stretched(GDALDataset& heights, GDALDataset& image) {
    const glm::dvec2 samples(heights.GetRasterXSize() - 1, heights.GetRasterYSize() - 1);
    const glm::dvec2 pixels(std::max(image.GetRasterXSize() - 1, 1),
                            std::max(image.GetRasterYSize() - 1, 1));
    const glm::dvec2 scale = samples / pixels;
    const glm::dvec2 corner = 0.5 - 0.5 * scale;
    return {pixel_space.x0 + corner.x, scale.x, 0.0, pixel_space.y0 - corner.y, 0.0, -scale.y};
}

Result<void> place_image(GDALDataset& heights, GDALDataset& image, const Meeting& meeting,
                         const std::string& name) {
    if (meeting.stretched) {
        std::array<double, 6> affine = geotransform(stretched(heights, image));
        image.SetSpatialRef(nullptr);
        image.SetGeoTransform(affine.data());
    } else if (image.GetSpatialRef() == nullptr && image.GetGCPSpatialRef() == nullptr) {
        if (image.SetSpatialRef(&*meeting.crs) != CE_None) {
            return Error{fmt::format(
                "{}: its place cannot be read, a georeferenced image was expected", name)};
        }
    }
    return {};
}

/// Side lengths of the image's pixels in the meeting space.
std::optional<glm::dvec2> pixel_size(GDALDataset& image, const Meeting& meeting) {
    std::array<double, 6> t{};
    const bool has_affine = image.GetGeoTransform(t.data()) == CE_None;
    const OGRSpatialReference* crs = image.GetSpatialRef();
    if (has_affine && (!meeting.crs || (crs != nullptr && crs->IsSame(&*meeting.crs) != 0))) {
        return glm::dvec2(std::hypot(t[1], t[4]), std::hypot(t[2], t[5]));
    }
    char* wkt = nullptr;
    meeting.crs->exportToWkt(&wkt);
    CPLStringList options;
    options.SetNameValue("DST_SRS", wkt);
    CPLFree(wkt);
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

/// An image where it lies, still on disk.
struct PlacedImage {
    std::filesystem::path path;
    Meeting meeting;
    Dataset colors;
    glm::dvec2 pixel{1.0}; ///< of the meeting space
};

struct Size {
    int cols = 0;
    int rows = 0;
};

/// As many pixels as the image has over the samples, within the limits.
Size target_size(const SampleGrid& grid, const Meeting& meeting, glm::dvec2 pixel,
                 std::size_t budget) {
    const geo::PixelAffine& affine = meeting.from_heights;
    const glm::dvec2 sample(std::hypot(affine.x_col, affine.y_col) * std::abs(grid.step.x),
                            std::hypot(affine.x_row, affine.y_row) * std::abs(grid.step.y));
    const glm::dvec2 intervals = glm::dvec2(grid.cols - 1, grid.rows - 1) * sample / pixel;
    const glm::dvec2 wanted = glm::clamp(glm::round(intervals) + 1.0, 2.0, 1e6);
    const double used = static_cast<double>(grid.cols) * grid.rows * bytes_per_sample;
    const double whole = static_cast<double>(budget);
    const double pixels = std::max(whole - used, whole * least_budget_share) / bytes_per_pixel;
    const double shrink = std::min({1.0, longest_image_side / std::max(wanted.x, wanted.y),
                                    std::sqrt(pixels / (wanted.x * wanted.y))});
    const glm::dvec2 size = glm::max(glm::floor(wanted * shrink + 1e-6), 2.0);
    return {static_cast<int>(size.x), static_cast<int>(size.y)};
}

/// A raster over the samples, edge to edge.
Dataset target_of(Image& image, const SampleGrid& grid, const Meeting& meeting) {
    Dataset target = raster_over(image);
    if (target == nullptr) {
        return target;
    }
    // image pixel X (outer corner 0) is sample (X − 0.5)·q, and that is a place in the meeting
    // space
    const glm::dvec2 q =
        glm::dvec2(grid.cols - 1, grid.rows - 1) / glm::dvec2(image.cols() - 1, image.rows() - 1);
    const geo::PixelAffine& from = meeting.from_heights;
    const glm::dvec2 step = grid.step * q;
    const glm::dvec2 corner = from.crs_from_pixel(grid.pixel_from_sample(-0.5 * q));
    std::array<double, 6> t{corner.x, from.x_col * step.x, from.x_row * step.y,
                            corner.y, from.y_col * step.x, from.y_row * step.y};
    target->SetGeoTransform(t.data());
    if (meeting.crs) {
        target->SetSpatialRef(&*meeting.crs);
    }
    return target;
}

double covered_share(const Image& image) {
    const auto pixels = image.samples();
    const auto covered =
        std::count_if(pixels.begin(), pixels.end(), [](Rgba8 pixel) { return pixel.a != 0; });
    return static_cast<double>(covered) / static_cast<double>(pixels.size());
}

/// Draws the pictures beneath one another.
class Drape {
public:
    Drape(const SampleGrid& grid, const RasterOptions& options, Image image)
        : grid_(grid), options_(options), image_(std::move(image)) {}

    /// The `index`-th of `count`. False where it cannot be read.
    bool add(PlacedImage& picture, std::size_t index, std::size_t count) {
        Image drawn(image_.cols(), image_.rows(), Rgba8{0, 0, 0, 0});
        const Dataset target = target_of(drawn, grid_, picture.meeting);
        WarpOptions warping{
            .overview = automatic_overview, .scale = 0.0, .progress = {}, .stop = options_.stop};
        if (options_.progress) {
            warping.progress = [&](double done) {
                options_.progress((static_cast<double>(index) + done) / static_cast<double>(count));
            };
        }
        if (target == nullptr || !warp(*picture.colors, *target, warping)) {
            return false;
        }
        lay_under(image_, drawn);
        return true;
    }
    [[nodiscard]] bool is_full() const {
        const auto pixels = image_.samples();
        return std::all_of(pixels.begin(), pixels.end(),
                           [](Rgba8 pixel) { return pixel.a == 255; });
    }
    Image take() && { return std::move(image_); }

private:
    const SampleGrid& grid_;
    const RasterOptions& options_;
    Image image_;
};

Error unreadable(const std::string& name, const GdalMessages& messages) {
    return {fmt::format("{}: cannot be read as an image{}, a whole grey, palette or RGB(A) image "
                        "was expected",
                        name, messages.reason())};
}

Result<PlacedImage> open_placed(const std::filesystem::path& path, double white,
                                GDALDataset& heights, std::vector<std::string>& notes) {
    GdalMessages messages;
    const std::string name = path.string();
    auto image = open_raster(path, messages);
    if (!image) {
        return image.error();
    }
    if (auto good = check_affine(**image, name); !good) {
        return good.error();
    }
    PlacedImage placed{path, meeting_of(heights, **image, notes), nullptr, {}};
    const int thinning = thinning_of(**image);
    const std::string size =
        fmt::format("{}×{}", (*image)->GetRasterXSize(), (*image)->GetRasterYSize());
    placed.colors = as_rgb(std::move(*image), white);
    if (placed.colors != nullptr && thinning > 1) {
        notes.push_back(
            fmt::format("imagery: one of {} pixels a side is read of its {}", thinning, size));
        placed.colors = thinned(std::move(placed.colors), thinning);
    }
    if (placed.colors == nullptr) {
        return unreadable(name, messages);
    }
    if (auto good = place_image(heights, *placed.colors, placed.meeting, name); !good) {
        return good.error();
    }
    const auto pixel = pixel_size(*placed.colors, placed.meeting);
    if (!pixel) {
        return unreadable(name, messages);
    }
    placed.pixel = *pixel;
    return placed;
}

/// How much ground a pixel covers, in samples of the heights.
double in_samples(const PlacedImage& image) {
    const geo::PixelAffine& from = image.meeting.from_heights;
    return image.pixel.x * image.pixel.y /
           std::abs(from.x_col * from.y_row - from.x_row * from.y_col);
}

/// Those that can be read, finest first; what is wrong with the others is told in `faults`.
std::vector<PlacedImage> open_all(const ImageFiles& files, GDALDataset& heights,
                                  std::vector<std::string>& notes,
                                  std::vector<std::string>& faults) {
    std::vector<PlacedImage> placed;
    for (const std::filesystem::path& path : files.paths) {
        auto opened = open_placed(path, files.white, heights, notes);
        if (opened) {
            placed.push_back(std::move(*opened));
        } else {
            faults.push_back(opened.error().message);
        }
    }
    std::stable_sort(placed.begin(), placed.end(), [](const PlacedImage& a, const PlacedImage& b) {
        return in_samples(a) < in_samples(b);
    });
    return placed;
}

std::string name_of(const std::vector<std::filesystem::path>& images) {
    return images.size() == 1 ? images.front().string()
                              : fmt::format("the {} images", images.size());
}

void note_share(double share, std::vector<std::string>& notes) {
    if (share < 0.995) {
        notes.push_back(fmt::format("imagery covers {:.0f} % of the terrain", 100.0 * share));
    }
}

} // namespace

Result<Image> read_imagery(GDALDataset& heights, const SampleGrid& grid,
                           const RasterOptions& options, std::vector<std::string>& notes,
                           std::vector<std::string>& faults) {
    std::vector<std::string> wrong;
    const ImageFiles files = image_files(options.imagery, wrong);
    std::vector<PlacedImage> images = open_all(files, heights, notes, wrong);
    if (images.empty()) {
        check(!wrong.empty(), "a list of images without images");
        return Error{wrong.front()};
    }
    const Size size =
        target_size(grid, images.front().meeting, images.front().pixel, options.memory_budget);
    Drape drape(grid, options, Image(size.cols, size.rows, Rgba8{0, 0, 0, 0}));
    bool any = false;
    for (std::size_t i = 0; i < images.size() && !drape.is_full(); ++i) {
        const GdalMessages messages;
        const bool drawn = drape.add(images[i], i, images.size());
        if (options.stop.stop_requested()) {
            return Error{images[i].path.string() + ": reading was stopped"};
        }
        any = any || drawn;
        if (!drawn) {
            wrong.push_back(unreadable(images[i].path.string(), messages).message);
        }
    }
    if (!any) {
        return Error{wrong.front()};
    }
    Image result = std::move(drape).take();
    const double share = covered_share(result);
    if (share == 0.0) {
        return Error{
            fmt::format("{}: shows nothing of the terrain, an image that overlaps was expected",
                        name_of(options.imagery))};
    }
    note_share(share, notes);
    faults.insert(faults.end(), wrong.begin(), wrong.end());
    return result;
}

} // namespace reljef::io
