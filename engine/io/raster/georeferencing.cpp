#include "engine/io/raster/georeferencing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/geo/place.h"
#include "engine/io/raster/geodetic_fit.h"
#include "engine/io/raster/globe.h"

namespace reljef::io {
namespace {

constexpr double max_crs_coordinate = 1e12; // any unit
constexpr double min_area = 1e-6;           // of a pixel over that of a rectangle with its sides
constexpr double wgs84_radius = 6378137.0;
constexpr double near_pole = 85.0; // degrees
constexpr double tolerated_distortion = 0.01;
constexpr double noted_rotation = 10.0;     // degrees; above usual grid convergence
constexpr double tolerated_map_error = 0.1; // samples

/// One step along the columns and one along the rows.
struct Steps {
    glm::dvec2 col{0.0};
    glm::dvec2 row{0.0};
};

Steps crs_steps(const geo::PixelAffine& affine, const SampleGrid& grid) {
    return {glm::dvec2(affine.x_col, affine.y_col) * grid.step.x,
            glm::dvec2(affine.x_row, affine.y_row) * grid.step.y};
}

glm::dvec2 middle_of(const SampleGrid& grid) {
    return 0.5 * glm::dvec2(grid.cols - 1, grid.rows - 1) + grid.to_middle;
}

/// Mirrors the grid so that col grows along +x, if the steps are not steep, and so that rows run to
/// the right of columns, as seen from above.
void orient(const Steps& steps, Place& place) {
    if (std::abs(steps.col.x) > std::abs(steps.col.y) && steps.col.x < 0.0) {
        place.grid.flip_cols();
        place.flipped_cols = true;
    }
    const double to_left = steps.col.x * steps.row.y - steps.col.y * steps.row.x;
    if (place.flipped_cols ? to_left < 0.0 : to_left > 0.0) {
        place.grid.flip_rows();
        place.flipped_rows = true;
    }
}

void note_rotation(const Steps& steps, std::vector<std::string>& notes) {
    const double angle = glm::degrees(std::atan2(steps.col.y, steps.col.x));
    if (std::abs(angle) > noted_rotation) {
        notes.push_back(fmt::format("its rows run {:.1f}° from east: placement plane draws it "
                                    "unturned, ellipsoid as it lies",
                                    angle));
    }
}

double straight_metres(glm::dvec2 a, glm::dvec2 b) {
    return glm::distance(geo::geocentric_from_geodetic({a.x, a.y, 0.0}),
                         geo::geocentric_from_geodetic({b.x, b.y, 0.0}));
}

/// Steps at the middle of the grid in metres east and north. Near a pole only their lengths.
std::optional<Steps> ground_steps(const ExactTransform& exact, const SampleGrid& grid) {
    const glm::dvec2 middle = middle_of(grid);
    std::array<glm::dvec2, 4> points{middle - glm::dvec2(0.5, 0.0), middle + glm::dvec2(0.5, 0.0),
                                     middle - glm::dvec2(0.0, 0.5), middle + glm::dvec2(0.0, 0.5)};
    if (!exact.positions(grid, points)) {
        return std::nullopt;
    }
    if (std::abs(points[0].x) > near_pole) {
        return Steps{{straight_metres(points[0], points[1]), 0.0},
                     {0.0, straight_metres(points[2], points[3])}};
    }
    const glm::dvec2 metres = geo::metres_per_degree(points[0].x);
    const auto step = [&](glm::dvec2 from, glm::dvec2 to) {
        const double degrees_east = std::remainder(to.y - from.y, 360.0);
        return glm::dvec2(degrees_east * metres.x, (to.x - from.x) * metres.y);
    };
    return Steps{step(points[0], points[1]), step(points[2], points[3])};
}

/// Spacing by the CRS's units at the middle of the grid, metres.
glm::dvec2 spacing_in_crs(const OGRSpatialReference& crs, const geo::PixelAffine& affine,
                          const SampleGrid& grid) {
    const Steps steps = crs_steps(affine, grid);
    glm::dvec2 metres(1.0);
    if (crs.IsGeographic() != 0) {
        const double degrees = glm::degrees(crs.GetAngularUnits());
        const double latitude = crs_from_sample(affine, grid, middle_of(grid)).y * degrees;
        metres = geo::metres_per_degree(std::clamp(latitude, -89.9, 89.9)) * degrees *
                 (crs.GetSemiMajor() / wgs84_radius);
    } else {
        metres = glm::dvec2(crs.GetLinearUnits());
    }
    return {glm::length(steps.col * metres), glm::length(steps.row * metres)};
}

/// The true spacing if the projection distorts it (Web Mercator far from the equator).
glm::dvec2 checked_spacing(glm::dvec2 in_crs, const std::optional<Steps>& ground,
                           std::vector<std::string>& notes) {
    if (!ground) {
        return in_crs;
    }
    const glm::dvec2 true_spacing(glm::length(ground->col), glm::length(ground->row));
    if (!(std::min(true_spacing.x, true_spacing.y) > 0.0)) {
        return true_spacing; // an error of the caller's
    }
    const glm::dvec2 ratio = in_crs / true_spacing;
    if (std::abs(ratio.x - 1.0) <= tolerated_distortion &&
        std::abs(ratio.y - 1.0) <= tolerated_distortion) {
        return in_crs;
    }
    notes.push_back(
        fmt::format("its projection stretches by {:.3g}: samples are {:.4g} m apart on the "
                    "ground, not {:.4g} m",
                    ratio.x, true_spacing.x, in_crs.x));
    return true_spacing;
}

std::optional<geo::Georeference> georeference_of(GDALDataset& dataset,
                                                 const OGRSpatialReference& crs,
                                                 const geo::PixelAffine& affine,
                                                 const ExactTransform& exact, const Place& place,
                                                 std::vector<std::string>& notes) {
    const SampleGrid& grid = place.grid;
    const auto fit = fit_geodetic_map(exact, grid);
    const double spacing = std::min(place.spacing.x, place.spacing.y);
    if (!fit || !(fit->error <= std::max(map_tolerance, tolerated_map_error * spacing))) {
        notes.emplace_back("part of it lies where its coordinate system has no position on Earth: "
                           "treated as without a place");
        return std::nullopt;
    }
    if (fit->error > map_tolerance) {
        notes.push_back(
            fmt::format("positions are within {:.2g} m of its coordinate system's", fit->error));
    }
    CrsNames names = names_of(crs);
    return geo::Georeference{
        std::move(names.name),
        std::move(names.code),
        wkt_of(dataset.GetSpatialRef() != nullptr ? *dataset.GetSpatialRef() : crs),
        affine_of_samples(affine, closed(grid, place.wrap)),
        std::move(names.horizontal_unit),
        vertical_datum_of(dataset),
        fit->map.closed(place.wrap, grid.cols, grid.rows),
        std::nullopt};
}

Place placed_on_earth(GDALDataset& dataset, const OGRSpatialReference& crs,
                      const geo::PixelAffine& affine, const SampleGrid& grid,
                      std::vector<std::string>& notes) {
    Place place;
    place.grid = grid;
    place.spacing = spacing_in_crs(crs, affine, grid);
    const auto exact = ExactTransform::create(crs, affine, grid);
    auto ground = exact ? ground_steps(*exact, grid) : std::nullopt;
    if (!ground) {
        orient(crs_steps(affine, grid), place);
        notes.push_back(
            fmt::format("is in {}, which does not lead to WGS 84: treated as without a place",
                        names_of(crs).name));
        return place;
    }
    std::array<glm::dvec2, 1> middle{middle_of(grid)};
    const bool polar = exact->positions(grid, middle) && std::abs(middle[0].x) > near_pole;
    orient(polar ? crs_steps(affine, grid) : *ground, place);
    place.spacing = checked_spacing(place.spacing, ground, notes);
    ground = ground_steps(*exact, place.grid);
    if (!polar && ground) {
        note_rotation(*ground, notes);
    }
    place.wrap =
        closing_of(crs, affine_of_samples(affine, place.grid), place.grid.cols, place.grid.rows);
    place.georeference = georeference_of(dataset, crs, affine, *exact, place, notes);
    place.wrap = place.georeference ? place.wrap : geo::GlobalWrap{};
    return place;
}

/// Gives unnamed UTM zones their EPSG name.
OGRSpatialReference with_name(const OGRSpatialReference& crs) {
    int north = 0;
    const int zone = crs.GetUTMZone(&north);
    const char* base = crs.GetAttrValue("GEOGCS");
    OGRSpatialReference named(crs);
    if (zone > 0 && base != nullptr && crs.GetName() == std::string_view("unnamed")) {
        named.SetProjCS(
            fmt::format("{} / UTM zone {}{}", base, zone, north != 0 ? 'N' : 'S').c_str());
    }
    return named;
}

/// For rasters without a CRS or with a local one.
Place place_without_crs(const std::optional<OGRSpatialReference>& local,
                        const std::optional<geo::PixelAffine>& affine, const SampleGrid& grid,
                        const RasterOptions& options, std::vector<std::string>& notes) {
    Place place;
    place.grid = grid;
    const bool has_own = affine.has_value();
    if (has_own) {
        const Steps steps = crs_steps(*affine, grid);
        const double unit = local ? local->GetLinearUnits() : 1.0;
        place.spacing = glm::dvec2(glm::length(steps.col), glm::length(steps.row)) * unit;
        if (!local) {
            orient(steps, place);
        }
    } else {
        place.spacing = glm::abs(grid.step);
    }
    if (options.spacing) {
        place.spacing = *options.spacing * glm::abs(grid.step);
    } else if (local) {
        notes.push_back(
            fmt::format("is in {}, which names no place on Earth", names_of(*local).name));
    } else if (has_own) {
        notes.push_back(fmt::format("no coordinate system: its coordinates are taken for metres, "
                                    "{:.6g} m spacing",
                                    place.spacing.x));
    } else {
        place.spacing_assumed = true;
    }
    return place;
}

/// Coordinates on the globe in small steps that do not start at 0.
bool look_like_degrees(const geo::PixelAffine& affine, glm::dvec2 size) {
    const glm::dvec2 first = affine.crs_from_pixel(glm::dvec2(0.0));
    const glm::dvec2 last = affine.crs_from_pixel(size);
    const bool small = std::abs(affine.x_col) < 0.1 && std::abs(affine.y_row) < 0.1;
    const bool on_globe = std::max(std::abs(first.x), std::abs(last.x)) <= 180.5 &&
                          std::max(std::abs(first.y), std::abs(last.y)) <= 90.5;
    const bool from_zero = first.x == 0.0 && (first.y == 0.0 || last.y == 0.0);
    return small && on_globe && !from_zero;
}

} // namespace

std::optional<geo::PixelAffine> affine_of(GDALDataset& dataset) {
    std::array<double, 6> t{};
    if (dataset.GetGeoTransform(t.data()) != CE_None) {
        return std::nullopt;
    }
    const geo::PixelAffine affine{t[0], t[1], t[2], t[3], t[4], t[5]};
    const bool identity = t == std::array{0.0, 1.0, 0.0, 0.0, 0.0, 1.0} ||
                          t == std::array{0.0, 1.0, 0.0, 0.0, 0.0, -1.0};
    return identity ? std::nullopt : std::optional(affine);
}

geo::PixelAffine affine_of_samples(const geo::PixelAffine& affine, const SampleGrid& grid) {
    const glm::dvec2 origin = crs_from_sample(affine, grid, glm::dvec2(0.0));
    const Steps steps = crs_steps(affine, grid);
    return {origin.x, steps.col.x, steps.row.x, origin.y, steps.col.y, steps.row.y};
}

bool place_raster(GDALDataset& dataset, const geo::PixelAffine& affine,
                  const OGRSpatialReference* crs) {
    std::array<double, 6> t{affine.x0, affine.x_col, affine.x_row,
                            affine.y0, affine.y_col, affine.y_row};
    return dataset.SetSpatialRef(crs) == CE_None && dataset.SetGeoTransform(t.data()) == CE_None;
}

std::string vertical_datum_of(GDALDataset& dataset) {
    const OGRSpatialReference* crs = dataset.GetSpatialRef();
    if (crs != nullptr && crs->GetAxesCount() == 3 && crs->IsCompound() == 0) {
        return "ellipsoidal height"; // EPSG:4979
    }
    if (crs != nullptr && crs->IsVertical() != 0) {
        const char* name = crs->GetAttrValue("VERT_CS");
        return name != nullptr ? name : "";
    }
    const std::string_view format = dataset.GetDriver()->GetDescription();
    const char* dted = dataset.GetMetadataItem("DTED_VerticalDatum");
    const bool is_egm96 =
        format == "SRTMHGT" || (dted != nullptr && std::string_view(dted) == "E96");
    return is_egm96 ? "EGM96 height" : "";
}

bool is_usable(const geo::PixelAffine& affine) {
    const std::array numbers{affine.x0, affine.x_col, affine.x_row,
                             affine.y0, affine.y_col, affine.y_row};
    const double area = affine.x_col * affine.y_row - affine.x_row * affine.y_col;
    const double rectangle =
        std::hypot(affine.x_col, affine.y_col) * std::hypot(affine.x_row, affine.y_row);
    return std::abs(area) > min_area * rectangle &&
           std::all_of(numbers.begin(), numbers.end(),
                       [](double v) { return std::abs(v) <= max_crs_coordinate; });
}

Result<void> check_affine(GDALDataset& dataset, const std::string& name) {
    std::array<double, 6> t{};
    if (dataset.GetGeoTransform(t.data()) != CE_None) {
        return {};
    }
    if (is_usable({t[0], t[1], t[2], t[3], t[4], t[5]})) {
        return {};
    }
    return Error{fmt::format("{}: its geotransform is {}, numbers of at most {} and pixels with an "
                             "area were expected",
                             name, fmt::join(t, ", "), max_crs_coordinate)};
}

std::optional<OGRSpatialReference> horizontal_crs(GDALDataset& dataset,
                                                  std::vector<std::string>& notes) {
    if (const OGRSpatialReference* own = dataset.GetSpatialRef()) {
        OGRSpatialReference crs(*own);
        crs.StripVertical();
        crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        return crs;
    }
    const auto affine = affine_of(dataset);
    const glm::dvec2 size(dataset.GetRasterXSize(), dataset.GetRasterYSize());
    if (!affine || !look_like_degrees(*affine, size)) {
        return std::nullopt;
    }
    notes.emplace_back(
        "no coordinate system, but its coordinates look like degrees: WGS 84 assumed");
    return crs_from_text(wgs84_degrees);
}

CrsNames names_of(const OGRSpatialReference& given) {
    const OGRSpatialReference crs = with_name(given);
    const auto text = [](const char* value) { return std::string(value != nullptr ? value : ""); };
    CrsNames names;
    const char* unit = nullptr;
    if (crs.IsGeographic() != 0) {
        crs.GetAngularUnits(&unit);
    } else {
        crs.GetLinearUnits(&unit);
    }
    names.horizontal_unit = text(unit);
    names.name = text(crs.GetName());
    // GDAL and PROJ fill in the last two.
    if (names.name.empty() || names.name == "unnamed" || names.name == "unknown") {
        names.name = "a coordinate system without a name";
    }
    const char* authority = crs.GetAuthorityName(nullptr);
    const char* code = crs.GetAuthorityCode(nullptr);
    if (authority != nullptr && code != nullptr) {
        names.code = fmt::format("{}:{}", authority, code);
        return names;
    }
    const std::unique_ptr<OGRSpatialReference> match(crs.FindBestMatch(90, "EPSG", nullptr));
    if (match != nullptr && match->GetAuthorityCode(nullptr) != nullptr) {
        names.name = text(match->GetName());
        names.code = fmt::format("EPSG:{}", match->GetAuthorityCode(nullptr));
    }
    return names;
}

Result<Place> place_of(GDALDataset& dataset, const SampleGrid& grid, const std::string& name,
                       const RasterOptions& options, std::vector<std::string>& notes) {
    using terrain::max_spacing;
    using terrain::min_spacing;
    if (options.spacing && !(*options.spacing >= min_spacing && *options.spacing <= max_spacing)) {
        return Error{
            fmt::format("{}: spacing {} was asked for, a number of metres from {} to {} was "
                        "expected",
                        name, *options.spacing, min_spacing, max_spacing)};
    }
    if (auto good = check_affine(dataset, name); !good) {
        return good.error();
    }
    const auto affine = affine_of(dataset);
    const auto crs = affine ? horizontal_crs(dataset, notes) : std::nullopt;
    if (!affine && dataset.GetGCPCount() > 0) {
        notes.emplace_back("is placed by ground control points, which are not used for heights");
    }
    const bool on_earth = crs && crs->IsLocal() == 0;
    if (on_earth && options.spacing) {
        return Error{
            fmt::format("{}: spacing {} was asked for, but the file's own is that of {}; none "
                        "was expected",
                        name, *options.spacing, names_of(*crs).name)};
    }
    Place place = on_earth ? placed_on_earth(dataset, *crs, *affine, grid, notes)
                           : place_without_crs(crs, affine, grid, options, notes);
    const auto fits = [](double spacing) {
        return spacing >= min_spacing && spacing <= max_spacing;
    };
    if (!fits(place.spacing.x) || !fits(place.spacing.y)) {
        return Error{fmt::format("{}: its samples are {} × {} m apart, {} to {} m were expected",
                                 name, place.spacing.x, place.spacing.y, min_spacing, max_spacing)};
    }
    return place;
}

} // namespace reljef::io
