#include "engine/io/imagery/imagery_set.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "engine/core/parallel_for.h"
#include "engine/io/files/dataset_pool.h"
#include "engine/io/imagery/degree_box.h"
#include "engine/io/imagery/image_files.h"
#include "engine/io/imagery/rgb_image.h"
#include "engine/io/raster/crs_transform.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
/// Metadata of an image.
struct ImageInfo {
    std::filesystem::path path;
    glm::ivec2 size{0};
    glm::dvec2 pixel{1.0}; ///< metres
    DegreeBox box{};
    struct Overview {
        int index = 0;
        double factor = 1.0; ///< full-resolution pixels per pixel and side
    };
    std::vector<Overview> overviews;
};

namespace {

/// Metres per pixel at the middle of 9×9 places over `size` pixels.
glm::dvec2 pixel_size(std::span<const glm::dvec2> degrees, glm::ivec2 size) {
    constexpr std::size_t middle = middle_of_places;
    const double across = metres_between(degrees[middle - 1], degrees[middle + 1]);
    const double down = metres_between(degrees[middle - 9], degrees[middle + 9]);
    return 4.0 * glm::dvec2(across, down) / glm::dvec2(size);
}

std::vector<ImageInfo::Overview> overviews_of(GDALDataset& rgb) {
    std::vector<ImageInfo::Overview> found;
    GDALRasterBand& band = *rgb.GetRasterBand(1);
    found.reserve(static_cast<std::size_t>(std::max(band.GetOverviewCount(), 0)));
    for (int i = 0; i < band.GetOverviewCount(); ++i) {
        GDALRasterBand* reduced = band.GetOverview(i);
        if (reduced != nullptr && reduced->GetXSize() >= 1) {
            found.push_back({i, static_cast<double>(band.GetXSize()) / reduced->GetXSize()});
        }
    }
    return found;
}

/// `crs` is its CRS if it names none.
Result<Dataset> open_placed(const std::filesystem::path& path, double white, const std::string& crs,
                            const GdalMessages& messages) {
    auto rgb = open_rgb(path, white, messages);
    if (rgb && (*rgb)->GetSpatialRef() == nullptr) {
        const OGRSpatialReference own = crs_from_text(crs);
        (*rgb)->SetSpatialRef(&own);
    }
    return rgb;
}

std::optional<ImageInfo> image_info(const std::filesystem::path& path, GDALDataset& rgb) {
    const auto degrees = places_over(rgb);
    if (degrees.empty()) {
        return std::nullopt;
    }
    ImageInfo image{path, {rgb.GetRasterXSize(), rgb.GetRasterYSize()}, {}, {}, overviews_of(rgb)};
    image.box = padded_box(degrees);
    image.pixel = pixel_size(degrees, image.size);
    return std::isfinite(image.pixel.x * image.pixel.y) ? std::optional(image) : std::nullopt;
}

double side_of(const ImageInfo& image) {
    return std::sqrt(image.pixel.x * image.pixel.y);
}

/// The overview to read for a spacing of texels.
struct Choice {
    int overview = -1;   ///< -1: full resolution
    double pixels = 0.0; ///< to read
    double scale = 1.0;  ///< texels per pixel read
};

Choice choice_for(const ImageInfo& image, double spacing, double texels) {
    const double desired = spacing / std::max(image.pixel.x, image.pixel.y);
    Choice choice;
    double factor = 1.0;
    constexpr double near = 1.0 + 1e-6; // sizes are rounded
    for (const ImageInfo::Overview& overview : image.overviews) {
        if (overview.factor <= desired * near && overview.factor > factor) {
            choice.overview = overview.index;
            factor = overview.factor;
        }
    }
    const double there = static_cast<double>(image.size.x) * image.size.y / (factor * factor);
    const double shown =
        texels * spacing * spacing / (image.pixel.x * image.pixel.y * factor * factor);
    choice.pixels = std::min(there, shown);
    choice.scale = side_of(image) * factor / spacing;
    return choice;
}

bool shows_something(std::span<const Rgba8> texels) {
    return std::any_of(texels.begin(), texels.end(), [](Rgba8 texel) { return texel.a != 0; });
}

/// Whether an image may lie between the texels.
bool is_tiny(const ImageInfo& image, double spacing) {
    const glm::dvec2 sides = image.pixel * glm::dvec2(image.size);
    return std::min(sides.x, sides.y) < 2.0 * spacing;
}

double units_in_degree(const std::string& crs) {
    const OGRSpatialReference reference = crs_from_text(crs);
    return reference.IsGeographic() != 0 ? 1.0 / glm::degrees(reference.GetAngularUnits()) : 0.0;
}

void copy_row(Image& picture, int from, int to) {
    std::copy(picture.row(from).begin(), picture.row(from).end(), picture.row(to).begin());
}

} // namespace

struct ImagerySet::State {
    State(std::string grid_crs, double white_of_all, const ImagerySetOptions& options)
        : crs(std::move(grid_crs)), turn(units_in_degree(crs)),
          reading_memory(options.reading_memory), white(white_of_all),
          pool([this](const std::filesystem::path& path, const GdalMessages& messages) {
              return open_placed(path, white, crs, messages);
          }),
          failing(options.first_pause) {}

    std::string crs;               ///< WKT of the grids
    double turn;                   ///< units of x per degree; 0: not in degrees
    std::size_t reading_memory;    ///< bytes per thread
    double white;                  ///< see white_of
    std::vector<ImageInfo> images; ///< finest first
    bool complete = true;          ///< all images could be opened
    mutable DatasetPool pool;
    mutable FailingFiles failing;
    mutable NewNotes new_notes;

    /// Draws an image into an empty picture.
    Result<void> draw(const ImageInfo& image, const Choice& choice, const TileGrid& grid,
                      Image& texels, const std::stop_token& stop) const {
        const GdalMessages messages;
        auto rgb = pool.borrow(image.path, messages);
        if (!rgb) {
            return rgb.error();
        }
        if (rgb->found_change()) {
            new_notes.add(image.path, changed_note);
        }
        const Dataset raster = raster_over(texels);
        const WarpOptions options{.overview = choice.overview,
                                  .scale = choice.scale,
                                  .memory = reading_memory,
                                  .progress = {},
                                  .stop = stop};
        const OGRSpatialReference reference = crs_from_text(crs); // not thread-safe
        if (raster == nullptr || !place_raster(*raster, outer_affine_of(grid), &reference) ||
            !warp(**rgb, *raster, options) || messages.has_lost_blocks()) {
            if (!stop.stop_requested()) {
                rgb->discard();
            }
            return Error{fmt::format("{}: cannot be read{}, a whole image was expected",
                                     image.path.string(), messages.reason())};
        }
        return {};
    }

    /// Draws an image beneath the others; `turns`: see turns_to_meet. Returns whether it
    /// contributes or may contribute.
    bool add(const ImageInfo& image, const Choice& choice, const TileGrid& grid,
             std::span<const double> turns, ImageryWindow& window,
             const std::stop_token& stop) const {
        if (choice.pixels > ImagerySet::max_pixels_read || failing.skip_reason(image.path)) {
            window.whole = false;
            return true;
        }
        bool shows = false;
        for (const double degrees : turns) {
            TileGrid moved = grid;
            moved.first.x += degrees * turn;
            Image drawn(grid.cols, grid.rows, Rgba8{0, 0, 0, 0});
            const auto done = draw(image, choice, moved, drawn, stop);
            if (!done) {
                window.whole = false;
                if (!stop.stop_requested()) {
                    failing.note(image.path, done.error().message);
                    window.errors.push_back({image.path, done.error().message});
                }
                return true;
            }
            shows = shows || shows_something(drawn.samples());
            composite_under(window.texels, drawn);
            if (turn == 0.0) {
                break; // all turns are the same place
            }
        }
        failing.forget(image.path);
        return shows;
    }
};

Result<ImagerySet> ImagerySet::open(std::span<const std::filesystem::path> names,
                                    const std::string& crs, const ImagerySetOptions& options) {
    const ReadScope scope(options.stop);
    std::vector<std::string> errors;
    const ImageFiles files = image_files(names, errors, options.stop);
    auto state = std::make_shared<State>(crs, files.white, options);
    std::vector<std::optional<ImageInfo>> found(files.paths.size());
    const auto inspect = [&](int i) {
        const auto index = static_cast<std::size_t>(i);
        const ReadScope thread_scope(options.stop);
        const GdalMessages messages;
        const auto rgb = open_placed(files.paths[index], files.white, crs, messages);
        found[index] = rgb ? image_info(files.paths[index], **rgb) : std::nullopt;
    };
    parallel_for(static_cast<int>(found.size()), inspect,
                 {.threads = 0, .stop = options.stop, .progress = {}});
    if (options.stop.stop_requested()) {
        return Error{"the images: reading was stopped"};
    }
    for (std::optional<ImageInfo>& image : found) {
        if (image) {
            state->images.push_back(std::move(*image));
        }
    }
    if (state->images.empty()) {
        return Error{errors.empty() ? "the images name no place on Earth, at least one was "
                                      "expected to"
                                    : errors.front()};
    }
    state->complete = state->images.size() == found.size();
    std::stable_sort(state->images.begin(), state->images.end(),
                     [](const ImageInfo& a, const ImageInfo& b) {
                         return resolution(a.pixel) < resolution(b.pixel);
                     });
    return ImagerySet(std::move(state));
}

std::size_t ImagerySet::size() const {
    return state_->images.size();
}

double ImagerySet::white() const {
    return state_->white;
}

double ImagerySet::finest_pixel() const {
    return side_of(state_->images.front());
}

ImageryWindow ImagerySet::read(const TileGrid& grid, double spacing,
                               const std::stop_token& stop) const {
    const ReadScope scope(stop);
    check(grid.cols >= 1 && grid.rows >= 1, "ImagerySet::read of an empty grid");
    ImageryWindow window{
        Image(grid.cols, grid.rows, Rgba8{0, 0, 0, 0}), state_->complete, false, {}};
    const GdalMessages ignored_messages; // projections are undefined at some places
    const glm::dvec2 last(grid.cols - 1, grid.rows - 1);
    const auto degrees = places_over(
        [&](glm::dvec2 part) { return grid.first + grid.step * (part * last); }, state_->crs);
    if (degrees.empty()) {
        return window;
    }
    const DegreeBox box = padded_box(degrees);
    const double texels = static_cast<double>(grid.cols) * grid.rows;
    for (const ImageInfo& image : state_->images) {
        if (is_opaque(window.texels) || stop.stop_requested()) {
            break;
        }
        const std::vector<double> turns = turns_to_meet(box, image.box);
        if (turns.empty()) {
            continue;
        }
        const Choice choice = choice_for(image, spacing, texels);
        const bool shows = state_->add(image, choice, grid, turns, window, stop);
        window.has_more = window.has_more ||
                          (side_of(image) < 0.999 * spacing && (shows || is_tiny(image, spacing)));
    }
    return window;
}

std::uint64_t ImagerySet::changes() const {
    return state_->pool.changes();
}

std::vector<std::string> ImagerySet::take_new_notes() const {
    return state_->new_notes.take();
}

std::optional<std::string> ImagerySet::missing_overviews() const {
    for (const ImageInfo& image : state_->images) {
        const double pixels = static_cast<double>(image.size.x) * image.size.y;
        if (image.overviews.empty() && pixels > max_pixels_read) {
            return fmt::format("{0}: {1}×{2} pixels without overviews, so that views from afar "
                               "show it as coarse as it was read at the start; 'gdaladdo -r "
                               "average {0} 2 4 8 16 32 64' adds them",
                               image.path.string(), image.size.x, image.size.y);
        }
    }
    return std::nullopt;
}

void wrap_picture(Image& picture, const geo::WrappedRows& rows, double first, double samples) {
    constexpr double same_row = 1e-6;
    const double step = samples / (picture.rows() - 1);
    const int last = picture.rows() - 1;
    const auto texel_of = [&](int row) {
        const double source = rows.source_row(first + row * step);
        return (source + rows.wrap().north_rows() - first) / step;
    };
    for (int row = 0; row <= last && texel_of(row) > row + same_row; ++row) {
        copy_row(picture, std::min(static_cast<int>(std::ceil(texel_of(row) - same_row)), last),
                 row);
    }
    for (int row = last; row >= 0 && texel_of(row) < row - same_row; --row) {
        copy_row(picture, std::max(static_cast<int>(std::floor(texel_of(row) + same_row)), 0), row);
    }
}

} // namespace reljef::io
