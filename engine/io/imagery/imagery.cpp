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
#include <glm/geometric.hpp>

#include "engine/io/imagery/closed_picture.h"
#include "engine/io/imagery/degree_box.h"
#include "engine/io/imagery/image_files.h"
#include "engine/io/imagery/rgb_image.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/raster/globe.h"
#include "engine/io/tile_layer.h"

namespace reljef::io {
namespace {

constexpr double bytes_per_pixel = 16.0 / 3.0; // with mipmaps
constexpr double min_budget_share = 0.25;
constexpr std::size_t reading_part = 8; // of the budget, for what is read at a time

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

bool says_place(GDALDataset& image) {
    return affine_of(image) || image.GetGCPCount() > 0;
}

Meeting meeting_of(GDALDataset& heights, GDALDataset& image, std::vector<std::string>& notes) {
    const auto affine = affine_of(heights);
    std::vector<std::string> ignored;
    auto crs = affine ? horizontal_crs(heights, ignored) : std::nullopt;
    const bool image_placed = says_place(image);
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

bool names_crs(GDALDataset& image) {
    return image.GetSpatialRef() != nullptr || image.GetGCPSpatialRef() != nullptr;
}

Result<void> place_image(GDALDataset& heights, GDALDataset& image, const Meeting& meeting,
                         const std::string& name) {
    if (meeting.stretched) {
        std::array<double, 6> affine = geotransform(stretched(heights, image));
        image.SetSpatialRef(nullptr);
        image.SetGeoTransform(affine.data());
    } else if (!names_crs(image)) {
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

/// An image where it lies, on disk and not open: there may be more of them than the system opens.
struct KnownPicture {
    std::filesystem::path path;
    Meeting meeting;
    glm::dvec2 pixel{1.0}; ///< of the meeting space
    bool has_place = true;
    /// By how many degrees it is moved to lie over the heights, for each whole turn; none: it lies
    /// elsewhere.
    std::vector<double> turns{0.0};
};

Error unreadable(const std::string& name, const GdalMessages& messages) {
    return {fmt::format("{}: cannot be read as an image{}, a whole grey, palette or RGB(A) image "
                        "was expected",
                        name, messages.reason())};
}

/// The image as RGB, thinned where it is vast, and in its place.
Result<Dataset> open_colors(const std::filesystem::path& path, double white, GDALDataset& heights,
                            const Meeting& meeting, const GdalMessages& messages) {
    const std::string name = path.string();
    auto image = open_raster(path, messages);
    if (!image) {
        return image.error();
    }
    const int subsampling = subsampling_of(**image);
    Dataset colors = as_rgb(std::move(*image), white);
    if (colors != nullptr && subsampling > 1) {
        colors = subsampled(std::move(colors), subsampling);
    }
    if (colors == nullptr) {
        return unreadable(name, messages);
    }
    if (auto good = place_image(heights, *colors, meeting, name); !good) {
        return good.error();
    }
    return colors;
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
    const glm::dvec2 desired = glm::clamp(glm::round(intervals) + 1.0, 2.0, 1e6);
    const double used = static_cast<double>(grid.cols) * grid.rows * bytes_per_sample;
    const double whole = static_cast<double>(budget);
    const double pixels = std::max(whole - used, whole * min_budget_share) / bytes_per_pixel;
    const double shrink = std::min({1.0, longest_image_side / std::max(desired.x, desired.y),
                                    std::sqrt(pixels / (desired.x * desired.y))});
    const glm::dvec2 size = glm::max(glm::floor(desired * shrink + 1e-6), 2.0);
    return {static_cast<int>(size.x), static_cast<int>(size.y)};
}

/// Of x in the meeting space, for degrees.
double units_of(double degrees, const Meeting& meeting) {
    const bool in_degrees = meeting.crs && meeting.crs->IsGeographic() != 0;
    return in_degrees ? degrees / glm::degrees(meeting.crs->GetAngularUnits()) : 0.0;
}

/// A raster over the samples, edge to edge, as seen by a picture that is moved by `turn` degrees.
Dataset target_of(Image& image, const SampleGrid& grid, const Meeting& meeting, double turn) {
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
    std::array<double, 6> t{corner.x - units_of(turn, meeting),
                            from.x_col * step.x,
                            from.x_row * step.y,
                            corner.y,
                            from.y_col * step.x,
                            from.y_row * step.y};
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
    Drape(GDALDataset& heights, const SampleGrid& grid, const RasterOptions& options, double white,
          Image image)
        : heights_(heights), grid_(grid), options_(options), white_(white),
          image_(std::move(image)) {}

    /// The `index`-th of `count`, open as long as it is drawn. Fails where it cannot be read.
    Result<void> add(const KnownPicture& picture, std::size_t index, std::size_t count) {
        const GdalMessages messages;
        const auto colors = open_colors(picture.path, white_, heights_, picture.meeting, messages);
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
            if (!draw(**colors, picture.meeting, turn, warping) || messages.has_lost_blocks()) {
                return unreadable(picture.path.string(), messages);
            }
        }
        return {};
    }
    [[nodiscard]] bool is_full() const {
        const auto pixels = image_.samples();
        return std::all_of(pixels.begin(), pixels.end(),
                           [](Rgba8 pixel) { return pixel.a == 255; });
    }
    Image take() && { return std::move(image_); }

private:
    bool draw(GDALDataset& colors, const Meeting& meeting, double turn,
              const WarpOptions& warping) {
        Image drawn(image_.cols(), image_.rows(), Rgba8{0, 0, 0, 0});
        const Dataset target = target_of(drawn, grid_, meeting, turn);
        const bool done = target != nullptr && warp(colors, *target, warping);
        if (done) {
            lay_under(image_, drawn);
        }
        return done;
    }

    GDALDataset& heights_;
    const SampleGrid& grid_;
    const RasterOptions& options_;
    double white_;
    Image image_;
};

void note_thinning(GDALDataset& image, std::vector<std::string>& notes) {
    if (const int subsampling = subsampling_of(image); subsampling > 1) {
        notes.push_back(fmt::format("imagery: one of {} pixels a side is read of its {}×{}",
                                    subsampling, image.GetRasterXSize(), image.GetRasterYSize()));
    }
}

/// Around the samples; nothing where they have no place on Earth.
std::optional<DegreeBox> box_of(const SampleGrid& grid, const Meeting& meeting) {
    const glm::dvec2 last(grid.cols - 1, grid.rows - 1);
    const auto degrees = places_over(
        [&](glm::dvec2 part) {
            return meeting.from_heights.crs_from_pixel(grid.pixel_from_sample(part * last));
        },
        wkt_of(*meeting.crs));
    const bool placed = !degrees.empty() && !std::isnan(degrees[middle_of_places].x);
    return placed ? std::optional(padded_box(degrees)) : std::nullopt;
}

std::optional<DegreeBox> box_of(GDALDataset& image) {
    std::vector<std::string> ignored;
    const auto affine = affine_of(image);
    const auto crs = affine ? horizontal_crs(image, ignored) : std::nullopt;
    if (!crs || crs->IsLocal() != 0) {
        return std::nullopt;
    }
    const glm::dvec2 size(image.GetRasterXSize(), image.GetRasterYSize());
    const auto degrees = places_over(
        [&](glm::dvec2 part) { return affine->crs_from_pixel(part * size); }, wkt_of(*crs));
    const bool placed = !degrees.empty() && !std::isnan(degrees[middle_of_places].x);
    return placed ? std::optional(padded_box(degrees)) : std::nullopt;
}

/// None only where both are known to lie apart.
std::vector<double> turns_of(const SampleGrid& grid, GDALDataset& image, const Meeting& meeting) {
    const auto ground = meeting.crs ? box_of(grid, meeting) : std::nullopt;
    const auto shown = ground ? box_of(image) : std::nullopt;
    if (!shown) {
        return {0.0};
    }
    const std::vector<double> turns = turns_to_meet(*shown, *ground);
    const bool in_degrees = meeting.crs->IsGeographic() != 0;
    return turns.empty() || in_degrees ? turns : std::vector{0.0};
}

Result<KnownPicture> known_picture(const std::filesystem::path& path, double white,
                                   GDALDataset& heights, const SampleGrid& grid,
                                   std::vector<std::string>& notes) {
    const GdalMessages messages;
    const std::string name = path.string();
    auto image = open_raster(path, messages);
    if (!image) {
        return image.error();
    }
    if (auto good = check_affine(**image, name); !good) {
        return good.error();
    }
    KnownPicture picture{path, meeting_of(heights, **image, notes), {}, says_place(**image)};
    if (!picture.meeting.stretched && !names_crs(**image)) {
        notes.push_back(fmt::format("imagery: {} names no coordinate system, so that of the "
                                    "terrain is taken",
                                    path.filename().string()));
    }
    auto colors = open_colors(path, white, heights, picture.meeting, messages);
    if (!colors) {
        return colors.error();
    }
    note_thinning(**image, notes);
    const auto pixel = pixel_size(**colors, picture.meeting);
    if (!pixel) {
        return unreadable(name, messages);
    }
    picture.pixel = *pixel;
    picture.turns = turns_of(grid, **colors, picture.meeting);
    return picture;
}

/// How fine it is over the heights: see fineness().
double fineness_over_heights(const KnownPicture& picture) {
    const geo::PixelAffine& from = picture.meeting.from_heights;
    return resolution(picture.pixel /
                      std::sqrt(std::abs(from.x_col * from.y_row - from.x_row * from.y_col)));
}

/// Those that can be read, finest first, of equally fine ones the newer; what is wrong with the
/// others is told in `faults`.
std::vector<KnownPicture> known_pictures(const ImageFiles& files, GDALDataset& heights,
                                         const SampleGrid& grid, std::vector<std::string>& notes,
                                         std::vector<std::string>& errors) {
    std::vector<KnownPicture> pictures;
    for (const std::filesystem::path& path : files.paths) {
        auto picture = known_picture(path, files.white, heights, grid, notes);
        if (picture) {
            pictures.push_back(std::move(*picture));
        } else {
            errors.push_back(picture.error().message);
        }
    }
    std::stable_sort(pictures.begin(), pictures.end(),
                     [](const KnownPicture& a, const KnownPicture& b) {
                         return fineness_over_heights(a) < fineness_over_heights(b);
                     });
    return pictures;
}

/// One alone is stretched over the terrain, but not among those that have a place.
void leave_out_unplaced(std::vector<KnownPicture>& pictures, std::vector<std::string>& notes) {
    const auto stretched = [](const KnownPicture& picture) { return picture.meeting.stretched; };
    if (std::all_of(pictures.begin(), pictures.end(), stretched)) {
        return;
    }
    for (const KnownPicture& picture : pictures) {
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

void note_stretching(std::span<const KnownPicture> pictures, GDALDataset& heights,
                     std::vector<std::string>& notes) {
    for (const KnownPicture& picture : pictures) {
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
    const SampleGrid grid = closed(place.grid, place.closing);
    std::vector<std::string> wrong;
    const ImageFiles files =
        image_files(options.imagery, wrong, options.stop, options.imagery_white);
    if (options.stop.stop_requested()) {
        return Error{name_of(options.imagery) + ": reading was stopped"};
    }
    std::vector<KnownPicture> pictures = known_pictures(files, heights, grid, notes, wrong);
    if (pictures.empty()) {
        check(!wrong.empty(), "a list of images without images");
        return Error{wrong.front()};
    }
    leave_out_unplaced(pictures, notes);
    note_stretching(pictures, heights, notes);
    std::erase_if(pictures, [](const KnownPicture& picture) { return picture.turns.empty(); });
    if (pictures.empty()) {
        return shows_nothing(options);
    }
    const Size size =
        target_size(grid, pictures.front().meeting, pictures.front().pixel, options.memory_budget);
    Drape drape(heights, grid, options, files.white,
                Image(size.cols, size.rows, Rgba8{0, 0, 0, 0}));
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
    close_picture(result, {place.closing, place.grid.rows}, 0.0, grid.rows - 1);
    const double share = covered_share(result);
    if (share == 0.0) {
        return shows_nothing(options);
    }
    note_share(share, notes);
    errors.insert(errors.end(), wrong.begin(), wrong.end());
    return result;
}

} // namespace reljef::io
