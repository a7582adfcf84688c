#include "engine/io/imagery.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <optional>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_utils.h>
#include <gdalwarper.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/io/gdal_dataset.h"
#include "engine/io/georeferencing.h"

namespace reljef::io {
namespace {

constexpr double bytes_per_pixel = 16.0 / 3.0; // with mipmaps
constexpr double least_budget_share = 0.25;
constexpr const char* most_warp_error = "0.05"; // pixels

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

std::optional<int> band_of(GDALDataset& image, GDALColorInterp wanted) {
    for (int i = 1; i <= image.GetRasterCount(); ++i) {
        if (image.GetRasterBand(i)->GetColorInterpretation() == wanted) {
            return i;
        }
    }
    return std::nullopt;
}

struct ColorBands {
    bool palette = false;
    std::array<int, 3> color{1, 1, 1};
    std::optional<int> alpha;
};

ColorBands color_bands(GDALDataset& image) {
    ColorBands bands;
    bands.palette = image.GetRasterBand(1)->GetColorTable() != nullptr;
    bands.alpha = band_of(image, GCI_AlphaBand);
    const auto red = band_of(image, GCI_RedBand);
    const auto green = band_of(image, GCI_GreenBand);
    const auto blue = band_of(image, GCI_BlueBand);
    if (red && green && blue) {
        bands.color = {*red, *green, *blue};
    } else if (image.GetRasterCount() - (bands.alpha ? 1 : 0) >= 3) {
        bands.color = {1, 2, 3};
    }
    return bands;
}

/// The value that is white: the type's most for 8 bits, 1 for fractions, else the highest found.
double white_of(GDALDataset& image, const ColorBands& bands) {
    double white = 0.0;
    for (const int index : bands.color) {
        std::array<double, 2> range{};
        GDALRasterBand& band = *image.GetRasterBand(index);
        if (band.ComputeRasterMinMax(TRUE, range.data()) == CE_None) {
            white = std::max(white, range[1]);
        }
    }
    if (GDALDataTypeIsFloating(image.GetRasterBand(1)->GetRasterDataType()) != 0 && white <= 1.0) {
        return 1.0;
    }
    return white > 0.0 ? white : 1.0;
}

double opaque_of(GDALDataType type) {
    return type == GDT_Byte ? 255.0 : type == GDT_UInt16 ? 65535.0 : 1.0;
}

void add(CPLStringList& list, std::initializer_list<std::string> words) {
    for (const std::string& word : words) {
        list.AddString(word.c_str());
    }
}

// Every how-manieth pixel is read of an image so large that reading all of it would take minutes.
int thinning_of(GDALDataset& image) {
    constexpr double most_pixels_read = 1U << 29U;
    const double pixels = static_cast<double>(image.GetRasterXSize()) * image.GetRasterYSize();
    return static_cast<int>(std::ceil(std::sqrt(pixels / most_pixels_read)));
}

// A file cut short is found by its last block, before all the others are read.
bool has_last_block(GDALDataset& image) {
    GDALRasterBand& band = *image.GetRasterBand(1);
    int cols = 0;
    int rows = 0;
    band.GetBlockSize(&cols, &rows);
    GDALRasterBlock* block =
        band.GetLockedBlockRef((band.GetXSize() - 1) / cols, (band.GetYSize() - 1) / rows);
    if (block != nullptr) {
        block->DropLock();
    }
    return block != nullptr;
}

CPLStringList translation_of(GDALDataset& image) {
    const ColorBands bands = color_bands(image);
    CPLStringList words;
    add(words, {"-of", "VRT"});
    if (const int thinning = thinning_of(image); thinning > 1) {
        add(words, {"-outsize", std::to_string(image.GetRasterXSize() / thinning),
                    std::to_string(image.GetRasterYSize() / thinning)});
    }
    if (bands.palette) {
        add(words, {"-b", "1", "-expand", "rgba"});
        return words;
    }
    for (const int band : bands.color) {
        add(words, {"-b", std::to_string(band)});
    }
    if (bands.alpha) {
        add(words, {"-b", std::to_string(*bands.alpha)});
    }
    add(words, {"-colorinterp", bands.alpha ? "red,green,blue,alpha" : "red,green,blue"});
    const GDALDataType type = image.GetRasterBand(bands.color[0])->GetRasterDataType();
    if (type == GDT_Byte) {
        return words;
    }
    add(words, {"-ot", "Byte"});
    const std::string white = fmt::format("{}", white_of(image, bands));
    for (const char* option : {"-scale_1", "-scale_2", "-scale_3"}) {
        add(words, {option, "0", white, "0", "255"});
    }
    if (bands.alpha) {
        add(words, {"-scale_4", "0", fmt::format("{}", opaque_of(type)), "0", "255"});
    }
    return words;
}

/// The image as 8-bit red, green, blue and perhaps alpha, still on disk.
Dataset as_rgb(GDALDataset& image) {
    CPLStringList words = translation_of(image);
    const std::unique_ptr<GDALTranslateOptions, decltype(&GDALTranslateOptionsFree)> options(
        GDALTranslateOptionsNew(words.List(), nullptr), &GDALTranslateOptionsFree);
    if (options == nullptr) {
        return nullptr;
    }
    return Dataset(GDALDataset::FromHandle(
        GDALTranslate("", GDALDataset::ToHandle(&image), options.get(), nullptr)));
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

/// A GDAL raster whose pixels are those of `image`, over the samples edge to edge.
Dataset target_of(Image& image, const SampleGrid& grid, const Meeting& meeting) {
    auto* driver = GetGDALDriverManager()->GetDriverByName("MEM");
    Dataset target(driver->Create("", image.cols(), image.rows(), 0, GDT_Byte, nullptr));
    if (target == nullptr) {
        return target;
    }
    auto* bytes = reinterpret_cast<GByte*>(image.samples().data());
    constexpr std::array interpretations{GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
    for (std::size_t i = 0; i < interpretations.size(); ++i) {
        CPLStringList options;
        std::array<char, 64> pointer{};
        pointer.at(static_cast<std::size_t>(CPLPrintPointer(
            pointer.data(), bytes + i, static_cast<int>(pointer.size()) - 1))) = '\0';
        options.SetNameValue("DATAPOINTER", pointer.data());
        options.SetNameValue("PIXELOFFSET", "4");
        options.SetNameValue(
            "LINEOFFSET",
            std::to_string(std::size_t{4} * static_cast<std::size_t>(image.cols())).c_str());
        target->AddBand(GDT_Byte, options.List());
        target->GetRasterBand(static_cast<int>(i) + 1)->SetColorInterpretation(interpretations[i]);
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

int progress_step(double fraction, const char* /*message*/, void* options) {
    const auto* reading = static_cast<const RasterOptions*>(options);
    if (reading->progress) {
        reading->progress(fraction);
    }
    return reading->stop.stop_requested() ? FALSE : TRUE;
}

bool warp(GDALDataset& image, GDALDataset& target, const RasterOptions& reading) {
    CPLStringList words;
    add(words, {"-r", "bilinear", "-et", most_warp_error});
    const std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)> options(
        GDALWarpAppOptionsNew(words.List(), nullptr), &GDALWarpAppOptionsFree);
    if (options == nullptr) {
        return false;
    }
    GDALWarpAppOptionsSetProgress(options.get(), &progress_step,
                                  const_cast<RasterOptions*>(&reading));
    GDALDatasetH source = GDALDataset::ToHandle(&image);
    int misused = FALSE;
    return GDALWarp(nullptr, GDALDataset::ToHandle(&target), 1, &source, options.get(), &misused) !=
               nullptr &&
           misused == FALSE;
}

double covered_share(const Image& image) {
    const auto pixels = image.samples();
    const auto covered =
        std::count_if(pixels.begin(), pixels.end(), [](Rgba8 pixel) { return pixel.a != 0; });
    return static_cast<double>(covered) / static_cast<double>(pixels.size());
}

} // namespace

Result<Image> read_imagery(GDALDataset& heights, const SampleGrid& grid,
                           const RasterOptions& options, std::vector<std::string>& notes) {
    const std::string name = options.imagery.string();
    GdalMessages messages;
    auto image = open_raster(options.imagery, messages);
    if (!image) {
        return image.error();
    }
    const auto unreadable = [&] {
        return Error{
            fmt::format("{}: cannot be read as an image{}, a whole grey, palette or RGB(A) image "
                        "was expected",
                        name, messages.reason())};
    };
    if (auto good = check_affine(**image, name); !good) {
        return good.error();
    }
    const Meeting meeting = meeting_of(heights, **image, notes);
    const Dataset colors = has_last_block(**image) ? as_rgb(**image) : nullptr;
    if (colors == nullptr) {
        return unreadable();
    }
    if (const int thinning = thinning_of(**image); thinning > 1) {
        notes.push_back(fmt::format("imagery: one of {} pixels a side is read of its {}×{}",
                                    thinning, (*image)->GetRasterXSize(),
                                    (*image)->GetRasterYSize()));
    }
    if (auto placed = place_image(heights, *colors, meeting, name); !placed) {
        return placed.error();
    }
    const auto pixel = pixel_size(*colors, meeting);
    if (!pixel) {
        return unreadable();
    }
    const Size size = target_size(grid, meeting, *pixel, options.memory_budget);
    Image result(size.cols, size.rows, Rgba8{0, 0, 0, 0});
    const Dataset target = target_of(result, grid, meeting);
    if (target == nullptr || !warp(*colors, *target, options)) {
        return options.stop.stop_requested() ? Error{name + ": reading was stopped"} : unreadable();
    }
    target->FlushCache();
    const double share = covered_share(result);
    if (share == 0.0) {
        return Error{fmt::format(
            "{}: shows nothing of the terrain, an image that overlaps was expected", name)};
    }
    if (share < 0.995) {
        notes.push_back(fmt::format("imagery covers {:.0f} % of the terrain", 100.0 * share));
    }
    return result;
}

} // namespace reljef::io
