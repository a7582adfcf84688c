#include "engine/io/imagery/imagery_set.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/io/files/dataset_pool.h"
#include "engine/io/files/file_index.h"
#include "engine/io/imagery/image_place.h"
#include "engine/io/imagery/rgb_image.h"
#include "engine/io/raster/crs_transform.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
/// Metadata of an image.
struct ImageInfo {
    std::filesystem::path path;
    glm::ivec2 size{0};
    double white = 0.0; ///< see white_of
    bool has_place = false;
    bool names_crs = false;
    std::optional<DegreeBox> box;  ///< absent: unknown
    glm::dmat2 steps{1.0};         ///< see steps_over
    std::vector<double> overviews; ///< see overviews_of
};

namespace {

void add_folder(const std::filesystem::path& folder, std::vector<std::filesystem::path>& paths,
                std::vector<std::string>& errors) {
    std::vector<std::string> ignored;
    const auto index = index_files(folder, {}, ignored);
    if (!index) {
        errors.push_back(index.error().message);
        return;
    }
    const std::size_t before = paths.size();
    for (const IndexedFile& file : index->files) {
        if (file.use == FileKind::error) {
            errors.push_back(file.error);
        } else if (file.use == FileKind::picture || file.type == "Byte" || file.type == "UInt16") {
            paths.push_back(folder / file.path);
        }
    }
    if (paths.size() == before) {
        errors.push_back(
            fmt::format("{}: holds no image, at least one was expected", folder.string()));
    }
}

/// Files and addresses of images, newest first. Of folders: their pictures and Byte or UInt16
/// rasters. Adds an error for each unreadable file of a folder.
std::vector<std::filesystem::path> image_files(std::span<const std::filesystem::path> names,
                                               std::vector<std::string>& errors) {
    std::vector<std::filesystem::path> paths;
    for (const std::filesystem::path& name : names) {
        std::error_code ignored;
        if (std::filesystem::is_directory(name, ignored)) {
            add_folder(name, paths, errors);
        } else {
            paths.push_back(name);
        }
    }
    std::stable_sort(paths.begin(), paths.end(),
                     [](const std::filesystem::path& a, const std::filesystem::path& b) {
                         std::error_code ignored;
                         return std::filesystem::last_write_time(a, ignored) >
                                std::filesystem::last_write_time(b, ignored);
                     });
    return paths;
}

/// Full-resolution pixels per pixel and side of each overview; 0: it cannot be opened.
std::vector<double> overviews_of(GDALDataset& rgb) {
    GDALRasterBand& band = *rgb.GetRasterBand(1);
    std::vector<double> factors;
    for (int i = 0; i < band.GetOverviewCount(); ++i) {
        GDALRasterBand* reduced = band.GetOverview(i);
        const bool usable = reduced != nullptr && reduced->GetXSize() >= 1;
        factors.push_back(usable ? static_cast<double>(band.GetXSize()) / reduced->GetXSize()
                                 : 0.0);
    }
    return factors;
}

glm::dmat2 steps_of(const geo::PixelAffine& affine) {
    return {affine.x_col, affine.y_col, affine.x_row, affine.y_row};
}

glm::dvec2 lengths(const glm::dmat2& steps) {
    return {glm::length(steps[0]), glm::length(steps[1])};
}

void set_crs_of_ground(GDALDataset& image, const ImageryGround& ground) {
    if (image.GetSpatialRef() == nullptr && image.GetGCPSpatialRef() == nullptr) {
        const OGRSpatialReference crs = crs_from_text(ground.crs);
        image.SetSpatialRef(&crs);
    }
}

Result<ImageInfo> image_info(const std::filesystem::path& path, const ImageryGround& ground,
                             const ImagerySetOptions& options) {
    const ReadScope scope(options.stop);
    const GdalMessages messages;
    const auto rgb = open_rgb(path, options.white, messages, options.stop);
    if (!rgb) {
        return rgb.error();
    }
    GDALDataset& image = *rgb->dataset;
    ImageInfo info;
    info.path = path;
    info.size = {image.GetRasterXSize(), image.GetRasterYSize()};
    info.white = rgb->white;
    info.has_place = affine_of(image) || image.GetGCPCount() > 0;
    info.names_crs = image.GetSpatialRef() != nullptr || image.GetGCPSpatialRef() != nullptr;
    info.overviews = overviews_of(image);
    if (info.has_place && !ground.crs.empty()) {
        set_crs_of_ground(image, ground);
        const auto steps = steps_over(ground, image);
        if (!steps) {
            return Error{fmt::format(
                "{}: its place cannot be read, a georeferenced image was expected", path.string())};
        }
        info.steps = *steps;
        info.box = degree_box(image);
    }
    return info;
}

/// What is unusual about an image's place; empty: nothing.
std::string place_note(const ImageInfo& image, const ImageryGround& ground, bool any_has_place) {
    if (ground.crs.empty()) {
        return image.has_place ? "the terrain names no place, so the image is stretched over it"
                               : "";
    }
    const std::string name = image.path.filename().string();
    if (!image.has_place) {
        return name + (any_has_place
                           ? " names no place on Earth: it is left out beside images that do"
                           : " names no place, so it is stretched over the terrain");
    }
    return image.names_crs ? ""
                           : name + " names no coordinate system, so that of the terrain is taken";
}

/// Leaves out images without a place if others have one. Otherwise stretches all; returns whether.
bool stretch_or_leave_out(std::vector<ImageInfo>& images, const ImageryGround& ground,
                          std::vector<std::string>& notes) {
    const auto has_place = [](const ImageInfo& image) { return image.has_place; };
    const bool any_has_place = std::any_of(images.begin(), images.end(), has_place);
    const bool stretches = ground.crs.empty() || !any_has_place;
    for (ImageInfo& image : images) {
        if (const std::string note = place_note(image, ground, any_has_place); !note.empty()) {
            notes.push_back("imagery: " + note);
        }
        if (stretches) {
            image.steps = steps_of(stretched_over(ground, image.size));
        }
    }
    if (!stretches) {
        std::erase_if(images, std::not_fn(has_place));
    }
    return stretches;
}

/// How an image is read.
struct Choice {
    int overview = -1;     ///< -1: full resolution
    double pixels = 0.0;   ///< to read
    glm::dvec2 scale{1.0}; ///< texels per pixel read
};

/// `pixel`: sides of the image's pixels, texels.
Choice choice_for(const ImageInfo& image, glm::dvec2 pixel, double texels) {
    const double desired = 1.0 / std::max(pixel.x, pixel.y);
    Choice choice;
    double factor = 1.0;
    constexpr double near = 1.0 + 1e-6; // sizes are rounded
    for (std::size_t i = 0; i < image.overviews.size(); ++i) {
        if (image.overviews[i] <= desired * near && image.overviews[i] > factor) {
            choice.overview = static_cast<int>(i);
            factor = image.overviews[i];
        }
    }
    choice.scale = pixel * factor;
    const double there = static_cast<double>(image.size.x) * image.size.y / (factor * factor);
    choice.pixels = std::min(there, texels / (choice.scale.x * choice.scale.y));
    return choice;
}

bool shows_something(std::span<const Rgba8> texels) {
    return std::any_of(texels.begin(), texels.end(), [](Rgba8 texel) { return texel.a != 0; });
}

void copy_row(Image& picture, int from, int to) {
    std::copy(picture.row(from).begin(), picture.row(from).end(), picture.row(to).begin());
}

} // namespace

struct ImagerySet::State {
    State(ImageryGround terrain, double white_of_all, const ImagerySetOptions& options)
        : ground(std::move(terrain)), turn(units_in_degree(ground.crs)),
          reading_memory(options.reading_memory), white(white_of_all),
          pool([this](const std::filesystem::path& path,
                      const GdalMessages& messages) { return open_placed(path, messages); },
               options.keeps_open ? DatasetPool::max_idle : 0),
          failing(options.first_pause) {}

    ImageryGround ground;
    double turn;                   ///< units of x per degree; 0: not in degrees
    std::size_t reading_memory;    ///< bytes per thread
    double white;                  ///< see white_of
    std::vector<ImageInfo> images; ///< finest first
    bool stretches = false;        ///< the images have no place
    bool complete = true;          ///< all images could be opened
    std::vector<std::string> notes;
    std::vector<std::string> errors;
    mutable DatasetPool pool;
    mutable FailingFiles failing;
    mutable NewNotes new_notes;

    Result<Dataset> open_placed(const std::filesystem::path& path,
                                const GdalMessages& messages) const {
        auto rgb = open_rgb(path, white, messages);
        if (!rgb) {
            return rgb.error();
        }
        GDALDataset& image = *rgb->dataset;
        if (stretches) {
            const glm::ivec2 size(image.GetRasterXSize(), image.GetRasterYSize());
            place_over(ground, stretched_over(ground, size), image);
        } else {
            set_crs_of_ground(image, ground);
        }
        return std::move(rgb->dataset);
    }

    /// A raster over texels, moved by `degrees`; null if GDAL fails.
    [[nodiscard]] Dataset raster_at(const TexelGrid& grid, double degrees, Image& texels) const {
        Dataset raster = raster_over(texels);
        auto outer = affine_of_samples(grid.affine, {glm::dvec2(-0.5), glm::dvec2(1.0)});
        outer.x0 += degrees * turn;
        return raster != nullptr && place_over(ground, outer, *raster) ? std::move(raster)
                                                                       : nullptr;
    }

    /// Absent if unknown.
    [[nodiscard]] std::optional<DegreeBox> box_of(const TexelGrid& grid) const {
        const glm::dvec2 count(grid.cols, grid.rows);
        const TexelGrid whole{affine_of_samples(grid.affine, {0.5 * (count - 1.0), count}), 1, 1};
        Image texel(1, 1);
        const Dataset raster = stretches ? nullptr : raster_at(whole, 0.0, texel);
        return raster != nullptr ? degree_box(*raster) : std::nullopt;
    }

    /// The multiples of 360 degrees that move an image onto a box; empty if it lies elsewhere.
    [[nodiscard]] std::vector<double> turns_of(const ImageInfo& image,
                                               const std::optional<DegreeBox>& box) const {
        if (!box || !image.box) {
            return {0.0};
        }
        std::vector<double> turns = turns_to_meet(*box, *image.box);
        return turns.empty() || turn != 0.0 ? turns : std::vector{0.0}; // 0: the same place
    }

    struct Job {
        const TexelGrid& grid;
        const ImageryReading& reading;
        ImageryWindow window;
    };

    /// The picture of an image that is moved by `degrees`.
    Result<Image> drawn(const ImageInfo& image, const Choice& choice, double degrees,
                        const Job& job) const {
        const GdalMessages messages;
        auto rgb = pool.borrow(image.path, messages);
        if (!rgb) {
            return rgb.error();
        }
        if (rgb->found_change()) {
            new_notes.add(image.path, changed_note);
        }
        Image texels(job.grid.cols, job.grid.rows, Rgba8{0, 0, 0, 0});
        const Dataset raster = raster_at(job.grid, degrees, texels);
        const WarpOptions options{.overview = choice.overview,
                                  .scale = choice.scale,
                                  .memory = reading_memory,
                                  .progress = job.reading.progress,
                                  .stop = job.reading.stop};
        if (raster == nullptr || !warp(**rgb, *raster, options) || messages.has_lost_blocks()) {
            if (!job.reading.stop.stop_requested()) {
                rgb->discard();
            }
            return unreadable_image(image.path, messages);
        }
        return texels;
    }

    /// Draws an image beneath the others; `turns`: see turns_of. Returns whether it contributes or
    /// may contribute.
    bool add(const ImageInfo& image, const Choice& choice, std::span<const double> turns,
             Job& job) const {
        const bool is_too_much = choice.pixels > job.reading.max_pixels;
        if (is_too_much || failing.skip_reason(image.path)) {
            job.window.whole = false;
            job.window.needs_overviews = is_too_much ? image.path : job.window.needs_overviews;
            return true;
        }
        bool shows = false;
        for (const double degrees : turns) {
            const auto texels = drawn(image, choice, degrees, job);
            if (!texels) {
                job.window.whole = false;
                if (!job.reading.stop.stop_requested()) {
                    failing.note(image.path, texels.error().message);
                    job.window.errors.push_back({image.path, texels.error().message});
                }
                return true;
            }
            shows = shows || shows_something(texels->samples());
            composite_under(job.window.texels, *texels);
        }
        failing.forget(image.path);
        return shows;
    }
};

Result<ImagerySet> ImagerySet::open(std::span<const std::filesystem::path> names,
                                    const ImageryGround& ground, const ImagerySetOptions& options) {
    register_drivers();
    const ReadScope scope(options.stop);
    std::vector<std::string> errors;
    const std::vector<std::filesystem::path> paths = image_files(names, errors);
    std::vector<std::optional<Result<ImageInfo>>> found(paths.size());
    const auto open_one = [&](int i) {
        const auto index = static_cast<std::size_t>(i);
        found[index] = image_info(paths[index], ground, options);
    };
    parallel_for(static_cast<int>(found.size()), open_one,
                 {.threads = 0, .stop = options.stop, .progress = {}});
    if (options.stop.stop_requested()) {
        return Error{"the images: reading was stopped"};
    }
    std::vector<ImageInfo> images;
    double white = 0.0;
    for (auto& image : found) {
        if (*image) {
            white = std::max(white, (*image)->white);
            images.push_back(std::move(**image));
        } else {
            errors.push_back(image->error().message);
        }
    }
    if (images.empty()) {
        check(!errors.empty(), "a list of images without images");
        return Error{errors.front()};
    }
    auto state = std::make_shared<State>(ground, white, options);
    state->stretches = stretch_or_leave_out(images, ground, state->notes);
    state->complete = images.size() == found.size();
    state->errors = std::move(errors);
    state->images = std::move(images);
    const double sample = std::abs(glm::determinant(steps_of(ground.affine)));
    const auto resolution_of = [&](const ImageInfo& image) {
        return resolution({std::abs(glm::determinant(image.steps)) / sample, 1.0});
    };
    std::stable_sort(state->images.begin(), state->images.end(),
                     [&](const ImageInfo& a, const ImageInfo& b) {
                         return resolution_of(a) < resolution_of(b);
                     });
    return ImagerySet(std::move(state));
}

std::size_t ImagerySet::size() const {
    return state_->images.size();
}

std::span<const std::string> ImagerySet::notes() const {
    return state_->notes;
}

std::span<const std::string> ImagerySet::errors() const {
    return state_->errors;
}

double ImagerySet::white() const {
    return state_->white;
}

std::optional<glm::dvec2> ImagerySet::finest_pixels_in(const TexelGrid& grid) const {
    const auto box = state_->box_of(grid);
    const auto finest =
        std::find_if(state_->images.begin(), state_->images.end(),
                     [&](const ImageInfo& image) { return !state_->turns_of(image, box).empty(); });
    return finest != state_->images.end()
               ? std::optional(lengths(glm::inverse(finest->steps) * steps_of(grid.affine)))
               : std::nullopt;
}

ImageryWindow ImagerySet::read(const TexelGrid& grid, const ImageryReading& reading) const {
    const ReadScope scope(reading.stop);
    check(grid.cols >= 1 && grid.rows >= 1, "ImagerySet::read of an empty grid");
    const GdalMessages ignored_messages; // projections are undefined at some places
    const auto box = state_->box_of(grid);
    const glm::dmat2 texels_from_ground = glm::inverse(steps_of(grid.affine));
    const double texels = static_cast<double>(grid.cols) * grid.rows;
    const std::size_t count = size();
    std::size_t done = 0;
    ImageryReading part = reading;
    if (reading.progress) {
        part.progress = [&](double fraction) {
            reading.progress((static_cast<double>(done) + fraction) / static_cast<double>(count));
        };
    }
    State::Job job{
        grid, part, {Image(grid.cols, grid.rows, Rgba8{0, 0, 0, 0}), state_->complete, false, {}}};
    for (; done < count && !is_opaque(job.window.texels) && !reading.stop.stop_requested();
         ++done) {
        const ImageInfo& image = state_->images[done];
        const std::vector<double> turns = state_->turns_of(image, box);
        if (turns.empty()) {
            continue;
        }
        const glm::dvec2 pixel = lengths(texels_from_ground * image.steps);
        const Choice choice = choice_for(image, pixel, texels);
        const bool shows = state_->add(image, choice, turns, job);
        const glm::dvec2 sides = pixel * glm::dvec2(image.size);
        const bool is_tiny = std::min(sides.x, sides.y) < 2.0; // may lie between the texels
        job.window.has_more =
            job.window.has_more || (std::min(pixel.x, pixel.y) < 0.999 && (shows || is_tiny));
    }
    return std::move(job.window);
}

std::uint64_t ImagerySet::changes() const {
    return state_->pool.changes();
}

std::vector<std::string> ImagerySet::take_new_notes() const {
    return state_->new_notes.take();
}

std::optional<std::string> ImagerySet::missing_overviews() const {
    for (const ImageInfo& image : state_->images) {
        const bool has_overviews = std::any_of(image.overviews.begin(), image.overviews.end(),
                                               [](double factor) { return factor > 1.0; });
        const double pixels = static_cast<double>(image.size.x) * image.size.y;
        if (!has_overviews && pixels > ImageryReading().max_pixels) {
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
