#include "engine/io/tile_layer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "engine/io/raster/georeferencing.h"
#include "engine/terrain/field/heightfield.h"

namespace reljef::io {
namespace {

constexpr double max_turns = 2.0;  // of longitudes from the prime meridian
constexpr double max_metres = 1e8; // from a projection's origin; eastings "60 500 000" name zone 60
constexpr double max_ratio = 1e6;  // of spacings: a map of the Earth beside a scan of a stone
constexpr double max_aspect = 1e4; // of samples; those in degrees reach it 0.006° from a pole

/// A coordinate system of the index.
struct IndexedCrs {
    OGRSpatialReference crs;
    std::string wkt; ///< of the first equal system
    double period = 0.0;
    double max_coordinate = 0.0;
    std::optional<CrsTransform> to_degrees;
};

std::vector<IndexedCrs> indexed_systems(const FileIndex& index) {
    std::vector<IndexedCrs> systems;
    for (const std::string& wkt : index.crs) {
        const OGRSpatialReference crs = crs_from_text(wkt);
        const auto same =
            std::find_if(systems.begin(), systems.end(),
                         [&](const IndexedCrs& other) { return crs.IsSame(&other.crs) != 0; });
        const double period =
            crs.IsGeographic() != 0 ? 360.0 / glm::degrees(crs.GetAngularUnits()) : 0.0;
        const std::string first_wkt = same == systems.end() ? wkt : same->wkt;
        const double max_coordinate =
            period > 0.0 ? max_turns * period : max_metres / crs.GetLinearUnits();
        systems.push_back(
            {crs, first_wkt, period, max_coordinate, CrsTransform::create(wkt, wgs84_degrees)});
    }
    return systems;
}

geo::PixelAffine at_sample_centres(geo::PixelAffine affine) {
    const glm::dvec2 first = affine.crs_from_pixel(glm::dvec2(0.5));
    affine.x0 = first.x;
    affine.y0 = first.y;
    return affine;
}

/// (longitude, latitude) of 3×3 points, then of the middle sample's neighbours east and south.
std::vector<glm::dvec2> degrees_of(const PlacedFile& file, const IndexedFile& indexed,
                                   const CrsTransform& to_degrees) {
    std::vector<glm::dvec2> points;
    const glm::dvec2 last(indexed.cols - 1, indexed.rows - 1);
    for (int j = 0; j <= 2; ++j) {
        for (int i = 0; i <= 2; ++i) {
            points.push_back(file.crs_from_sample.crs_from_pixel(0.5 * last * glm::dvec2(i, j)));
        }
    }
    const glm::dvec2 middle = 0.5 * last;
    points.push_back(file.crs_from_sample.crs_from_pixel(middle + glm::dvec2(1.0, 0.0)));
    points.push_back(file.crs_from_sample.crs_from_pixel(middle + glm::dvec2(0.0, 1.0)));
    to_degrees.apply(points);
    for (glm::dvec2& point : points) {
        point.x += 360.0 * std::round((points[4].x - point.x) / 360.0);
    }
    return points;
}

constexpr std::size_t outline_points = 9;

bool all_known(const std::vector<glm::dvec2>& points) {
    return std::none_of(points.begin(), points.end(), [](glm::dvec2 p) {
        return std::isnan(p.x) || std::abs(p.y) > 90.0 + 1e-9;
    });
}

/// A file in degrees keeps its own width: a whole globe is 360 wide.
DegreeBox box_in_degrees(const PlacedFile& file, const IndexedFile& indexed,
                         std::span<const glm::dvec2> outline) {
    DegreeBox box{outline[0].x, outline[0].y, outline[0].x, outline[0].y};
    for (const glm::dvec2 point : outline) {
        box = united(box, {point.x, point.y, point.x, point.y});
    }
    if (file.period > 0.0) {
        const double half_width =
            0.5 * std::abs(file.crs_from_sample.x_col) * (indexed.cols - 1) * 360.0 / file.period;
        box[0] = outline[4].x - half_width;
        box[2] = outline[4].x + half_width;
    }
    return box;
}

/// The coordinate of an outermost sample that is farthest from the origin.
double farthest_coordinate(const geo::PixelAffine& crs_from_sample, const IndexedFile& indexed) {
    const glm::dvec2 last(indexed.cols - 1, indexed.rows - 1);
    double farthest = 0.0;
    for (const glm::dvec2 corner :
         {glm::dvec2(0.0, 0.0), glm::dvec2(1.0, 0.0), glm::dvec2(0.0, 1.0), glm::dvec2(1.0, 1.0)}) {
        const glm::dvec2 point = crs_from_sample.crs_from_pixel(last * corner);
        for (const double coordinate : {point.x, point.y}) {
            farthest = std::abs(coordinate) > std::abs(farthest) ? coordinate : farthest;
        }
    }
    return farthest;
}

bool fits(glm::dvec2 spacing) {
    const auto [low, high] = std::minmax(spacing.x, spacing.y);
    return low >= terrain::min_spacing && high <= terrain::max_spacing && high <= max_aspect * low;
}

Error wrong_spacing(glm::dvec2 spacing, const std::string& name) {
    return {fmt::format("{}: its samples are {:.4g} × {:.4g} m apart, {} to {} m, one at "
                        "most {} times the other, were expected",
                        name, spacing.x, spacing.y, terrain::min_spacing, terrain::max_spacing,
                        max_aspect)};
}

Result<PlacedFile> placed_on_plane(int number, const IndexedFile& indexed,
                                   const std::string& name) {
    PlacedFile file;
    file.file = number;
    file.crs = plane_metres;
    file.crs_from_sample = at_sample_centres(indexed.crs_from_pixel);
    file.spacing = {std::abs(file.crs_from_sample.x_col), std::abs(file.crs_from_sample.y_row)};
    return fits(file.spacing) ? Result<PlacedFile>(std::move(file))
                              : wrong_spacing(file.spacing, name);
}

Result<PlacedFile> placed(int number, const IndexedFile& indexed, const IndexedCrs& crs,
                          const std::string& name) {
    const Error nowhere{fmt::format("{}: lies where its coordinate system has no position on "
                                    "Earth, a tile on Earth was expected",
                                    name)};
    if (!crs.to_degrees) {
        return nowhere;
    }
    if (crs.crs.IsGeocentric() != 0) {
        return Error{fmt::format("{}: its coordinates count from the Earth's centre (geocentric), "
                                 "those of a map or degrees were expected of a tile",
                                 name)};
    }
    PlacedFile file;
    file.file = number;
    file.crs = crs.wkt;
    file.period = crs.period;
    file.crs_from_sample = at_sample_centres(indexed.crs_from_pixel);
    const double farthest = farthest_coordinate(file.crs_from_sample, indexed);
    if (!(std::abs(farthest) <= crs.max_coordinate)) {
        return Error{fmt::format("{}: lies at coordinate {:.6g} of its coordinate system, {:.6g} "
                                 "to {:.6g} were expected",
                                 name, farthest, -crs.max_coordinate, crs.max_coordinate)};
    }
    const auto points = degrees_of(file, indexed, *crs.to_degrees);
    if (!all_known(points)) {
        return nowhere;
    }
    file.box = box_in_degrees(file, indexed, std::span(points).first(outline_points));
    file.spacing = {metres_between(points[4], points[outline_points]),
                    metres_between(points[4], points[outline_points + 1])};
    if (!fits(file.spacing)) {
        return wrong_spacing(file.spacing, name);
    }
    return file;
}

double mean_spacing(const PlacedFile& file) {
    return std::sqrt(file.spacing.x * file.spacing.y);
}

/// Leaves out files of another scale than most of the set; of two files, none is.
void drop_other_scales(std::vector<PlacedFile>& files, const FileIndex& index,
                       const std::filesystem::path& folder, std::vector<FileError>& errors) {
    if (files.size() < 3) {
        return;
    }
    std::vector<double> spacings(files.size());
    std::transform(files.begin(), files.end(), spacings.begin(), mean_spacing);
    const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
    std::nth_element(spacings.begin(), middle, spacings.end());
    const double median = *middle;
    const auto is_other = [&](const PlacedFile& file) {
        const double ratio = mean_spacing(file) / median;
        if (ratio <= max_ratio && ratio >= 1.0 / max_ratio) {
            return false;
        }
        const auto path = folder / index.files[static_cast<std::size_t>(file.file)].path;
        errors.push_back({path, fmt::format("{}: its samples are {:.4g} m apart, within a factor "
                                            "of {} of the other files' {:.4g} m was expected",
                                            path.string(), mean_spacing(file), max_ratio, median)});
        return true;
    };
    files.erase(std::remove_if(files.begin(), files.end(), is_other), files.end());
}

/// The east end of the widest strip of longitudes without a source file.
double west_of_all(std::span<const PlacedFile> files) {
    std::vector<glm::dvec2> spans; // west in [-180, 180), east
    for (const PlacedFile& file : files) {
        const double west = file.box[0] - 360.0 * std::floor((file.box[0] + 180.0) / 360.0);
        spans.emplace_back(west, west + file.box[2] - file.box[0]);
    }
    std::sort(spans.begin(), spans.end(), [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x; });
    double reached = spans.front().y;
    double widest = 0.0;
    double start = spans.front().x;
    for (std::size_t i = 1; i < spans.size(); ++i) {
        if (spans[i].x - reached > widest) {
            widest = spans[i].x - reached;
            start = spans[i].x;
        }
        reached = std::max(reached, spans[i].y);
    }
    return spans.front().x + 360.0 - reached >= widest ? spans.front().x : start;
}

/// Moves all files by multiples of 360 degrees to lie east of that strip.
void make_continuous(std::vector<PlacedFile>& files, std::span<const IndexedFile> indexed) {
    constexpr double rounding = 1e-9; // degrees
    const double west = west_of_all(files);
    for (PlacedFile& file : files) {
        const double turns = std::ceil((west - rounding - file.box[0]) / 360.0);
        file.box[0] += 360.0 * turns;
        file.box[2] += 360.0 * turns;
        if (file.period > 0.0) {
            const double last = indexed[static_cast<std::size_t>(file.file)].cols - 1.0;
            const double x = std::min(file.crs_from_sample.crs_from_pixel({0.0, 0.0}).x,
                                      file.crs_from_sample.crs_from_pixel({last, 0.0}).x);
            const double degrees = x * 360.0 / file.period; // from the CRS's prime meridian
            const double own_turns = std::round((file.box[0] - degrees) / 360.0);
            file.crs_from_sample.x0 += own_turns * file.period;
        }
    }
}

} // namespace

std::vector<PlacedFile> place_files(const FileIndex& index, const std::filesystem::path& folder,
                                    std::vector<FileError>& errors) {
    const std::vector<IndexedCrs> systems = indexed_systems(index);
    std::vector<PlacedFile> files;
    for (std::size_t i = 0; i < index.files.size(); ++i) {
        const IndexedFile& file = index.files[i];
        const std::filesystem::path path = folder / file.path;
        if (file.use == FileKind::error) {
            errors.push_back({path, file.error});
        }
        if (file.use != FileKind::heights) {
            continue;
        }
        const IndexedCrs& crs = systems[static_cast<std::size_t>(file.crs)];
        const int number = static_cast<int>(i);
        auto place = crs.wkt == plane_metres ? placed_on_plane(number, file, path.string())
                                             : placed(number, file, crs, path.string());
        if (place) {
            files.push_back(std::move(*place));
        } else {
            errors.push_back({path, place.error().message});
        }
    }
    drop_other_scales(files, index, folder, errors);
    if (!files.empty()) {
        make_continuous(files, index.files);
    }
    return files;
}

} // namespace reljef::io
