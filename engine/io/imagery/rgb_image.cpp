#include "engine/io/imagery/rgb_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <gdal_utils.h>
#include <glm/common.hpp>

#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/sample_decoder.h"

namespace reljef::io {
namespace {

std::optional<int> band_of(GDALDataset& image, GDALColorInterp desired) {
    for (int i = 1; i <= image.GetRasterCount(); ++i) {
        if (image.GetRasterBand(i)->GetColorInterpretation() == desired) {
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

/// Fails for a single band of a type other than Byte and UInt16: it holds heights.
Result<void> check_is_image(const std::filesystem::path& path, GDALDataset& dataset) {
    const GDALDataType type = dataset.GetRasterBand(1)->GetRasterDataType();
    if (dataset.GetRasterCount() >= 3 || kind_of_values(dataset) != ValueKind::plain ||
        type == GDT_Byte || type == GDT_UInt16) {
        return {};
    }
    return Error{
        fmt::format("{}: holds {}, as heights are stored, an image (grey of Byte or UInt16, "
                    "palette or RGB(A)) was expected",
                    path.string(), GDALGetDataTypeName(type))};
}

double opaque_of(GDALDataType type) {
    return type == GDT_Byte ? 255.0 : type == GDT_UInt16 ? 65535.0 : 1.0;
}

// Detects a truncated file before all other blocks are read.
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

/// The highest value of a window, at least 0; 0 if unreadable.
double highest_in(GDALRasterBand& band, const PixelWindow& window) {
    std::vector<double> values(static_cast<std::size_t>(window.size.x) *
                               static_cast<std::size_t>(window.size.y));
    if (!read_window(band, {window.first, window.size, values.data(), window.size})) {
        return 0.0;
    }
    int declares = 0;
    const double nodata = band.GetNoDataValue(&declares);
    double highest = 0.0;
    for (const double value : values) {
        const bool counts = std::isfinite(value) && (declares == 0 || value != nodata);
        highest = counts ? std::max(highest, value) : highest;
    }
    return highest;
}

double highest_of(GDALRasterBand& band, const std::stop_token& stop) {
    glm::ivec2 block(1);
    band.GetBlockSize(&block.x, &block.y);
    double highest = 0.0;
    for (const PixelWindow& window : sampled_windows({band.GetXSize(), band.GetYSize()}, block)) {
        if (stop.stop_requested()) {
            break;
        }
        highest = std::max(highest, highest_in(band, window));
    }
    return highest;
}

CPLStringList rgb_arguments(GDALDataset& image, double white) {
    const ColorBands bands = color_bands(image);
    CPLStringList arguments;
    add_options(arguments, {"-of", "VRT"});
    if (bands.palette) {
        add_options(arguments, {"-b", "1", "-expand", "rgba"});
        return arguments;
    }
    for (const int band : bands.color) {
        add_options(arguments, {"-b", std::to_string(band)});
    }
    if (bands.alpha) {
        add_options(arguments, {"-b", std::to_string(*bands.alpha)});
    }
    add_options(arguments,
                {"-colorinterp", bands.alpha ? "red,green,blue,alpha" : "red,green,blue"});
    const GDALDataType type = image.GetRasterBand(bands.color[0])->GetRasterDataType();
    if (type == GDT_Byte) {
        return arguments;
    }
    add_options(arguments, {"-ot", "Byte"});
    const std::string max_value = fmt::format("{}", white > 0.0 ? white : 1.0);
    for (const char* option : {"-scale_1", "-scale_2", "-scale_3"}) {
        add_options(arguments, {option, "0", max_value, "0", "255"});
    }
    if (bands.alpha) {
        add_options(arguments, {"-scale_4", "0", fmt::format("{}", opaque_of(type)), "0", "255"});
    }
    return arguments;
}

Dataset translated(GDALDataset& image, CPLStringList arguments) {
    const std::unique_ptr<GDALTranslateOptions, decltype(&GDALTranslateOptionsFree)> options(
        GDALTranslateOptionsNew(arguments.List(), nullptr), &GDALTranslateOptionsFree);
    if (options == nullptr) {
        return nullptr;
    }
    return Dataset(GDALDataset::FromHandle(
        GDALTranslate("", GDALDataset::ToHandle(&image), options.get(), nullptr)));
}

int progress_step(double fraction, const char* /*message*/, void* options) {
    const auto* warping = static_cast<const WarpOptions*>(options);
    if (warping->progress) {
        warping->progress(fraction);
    }
    return warping->stop.stop_requested() ? FALSE : TRUE;
}

std::uint8_t mixed(double top, double beneath, double share) {
    return static_cast<std::uint8_t>(std::lround(share * top + (1.0 - share) * beneath));
}

Rgba8 over(Rgba8 top, Rgba8 beneath) {
    if (top.a == 255 || beneath.a == 0) {
        return top;
    }
    const double shown = top.a / 255.0;
    const double alpha = shown + (1.0 - shown) * beneath.a / 255.0;
    const double share = shown / alpha;
    return {mixed(top.r, beneath.r, share), mixed(top.g, beneath.g, share),
            mixed(top.b, beneath.b, share), static_cast<std::uint8_t>(std::lround(255.0 * alpha))};
}

constexpr int min_window_cols = 64; // limits the number of windows

/// A block, some rows of it, or several narrow blocks.
glm::ivec2 sampled_window_for(glm::ivec2 block, glm::ivec2 size) {
    const int cols = std::min(std::clamp(block.x, min_window_cols, max_window_pixels), size.x);
    return {cols, std::clamp(std::min(block.y, size.y), 1, max_window_pixels / cols)};
}

} // namespace

std::vector<PixelWindow> sampled_windows(glm::ivec2 size, glm::ivec2 block) {
    const glm::ivec2 window = sampled_window_for(block, size);
    const std::int64_t across = (size.x - 1) / window.x + 1;
    const std::int64_t count = across * ((size.y - 1) / window.y + 1);
    const std::int64_t desired = max_sampled_pixels / (window.x * window.y) + 1;
    std::int64_t step = std::max<std::int64_t>(1, (count + desired - 1) / desired);
    step += step > 1 && step % across == 0 ? 1 : 0; // avoids sampling one column only
    std::vector<PixelWindow> windows;
    for (std::int64_t i = 0; i < count; i += step) {
        const glm::ivec2 first(static_cast<int>(i % across) * window.x,
                               static_cast<int>(i / across) * window.y);
        windows.push_back({first, glm::min(window, size - first)});
    }
    return windows;
}

double white_of(GDALDataset& image, const std::stop_token& stop) {
    const ColorBands bands = color_bands(image);
    const GDALDataType type = image.GetRasterBand(bands.color[0])->GetRasterDataType();
    if (bands.palette || type == GDT_Byte) {
        return 0.0;
    }
    double white = 0.0;
    for (const int index : bands.color) {
        white = std::max(white, highest_of(*image.GetRasterBand(index), stop));
    }
    if (GDALDataTypeIsFloating(type) != 0 && white <= 1.0) {
        return 1.0;
    }
    return white > 0.0 ? white : 1.0;
}

Result<RgbImage> open_rgb(const std::filesystem::path& path, std::optional<double> white,
                          const GdalMessages& messages, const std::stop_token& stop) {
    auto image = open_raster(path, messages);
    if (!image) {
        return image.error();
    }
    if (auto good = check_is_image(path, **image); !good) {
        return good.error();
    }
    if (auto good = check_affine(**image, path.string()); !good) {
        return good.error();
    }
    RgbImage rgb{nullptr, white ? *white : white_of(**image, stop)};
    if (has_last_block(**image)) {
        rgb.dataset = translated(**image, rgb_arguments(**image, rgb.white));
    }
    if (rgb.dataset == nullptr) {
        return unreadable_image(path, messages);
    }
    image->release()->ReleaseRef(); // the VRT holds its own reference
    return rgb;
}

Dataset raster_over(Image& image) {
    auto* driver = GetGDALDriverManager()->GetDriverByName("MEM");
    Dataset raster(driver->Create("", image.cols(), image.rows(), 0, GDT_Byte, nullptr));
    if (raster == nullptr) {
        return raster;
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
        raster->AddBand(GDT_Byte, options.List());
        raster->GetRasterBand(static_cast<int>(i) + 1)->SetColorInterpretation(interpretations[i]);
    }
    return raster;
}

bool warp(GDALDataset& rgb, GDALDataset& target, const WarpOptions& options) {
    CPLStringList arguments;
    add_options(arguments, {"-r", "bilinear", "-et", fmt::format("{}", max_warp_error), "-ovr",
                            options.overview < 0 ? "NONE" : std::to_string(options.overview), "-wo",
                            fmt::format("XSCALE={}", options.scale.x), "-wo",
                            fmt::format("YSCALE={}", options.scale.y)});
    if (options.memory > 0) {
        constexpr std::size_t min_memory = std::size_t{1}
                                           << 20U; // GDAL takes small numbers as megabytes
        add_options(arguments, {"-wm", std::to_string(std::max(options.memory, min_memory))});
    }
    const std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)> warping(
        GDALWarpAppOptionsNew(arguments.List(), nullptr), &GDALWarpAppOptionsFree);
    if (warping == nullptr) {
        return false;
    }
    GDALWarpAppOptionsSetProgress(warping.get(), &progress_step,
                                  const_cast<WarpOptions*>(&options));
    GDALDatasetH source = GDALDataset::ToHandle(&rgb);
    int misused = FALSE;
    const bool drawn = GDALWarp(nullptr, GDALDataset::ToHandle(&target), 1, &source, warping.get(),
                                &misused) != nullptr &&
                       misused == FALSE;
    target.FlushCache();
    return drawn;
}

Error unreadable_image(const std::filesystem::path& path, const GdalMessages& messages) {
    return {fmt::format("{}: cannot be read as an image{}, a whole grey, palette or RGB(A) image "
                        "was expected",
                        path.string(), messages.reason())};
}

bool is_opaque(const Image& image) {
    const auto pixels = image.samples();
    return std::all_of(pixels.begin(), pixels.end(), [](Rgba8 pixel) { return pixel.a == 255; });
}

void composite_under(Image& top, const Image& beneath) {
    check(top.cols() == beneath.cols() && top.rows() == beneath.rows(),
          "images of the same size were expected");
    std::transform(top.samples().begin(), top.samples().end(), beneath.samples().begin(),
                   top.samples().begin(), over);
}

} // namespace reljef::io
