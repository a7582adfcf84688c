#include "engine/io/footprints/footprint_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <system_error>
#include <utility>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogrsf_frmts.h>

#include "engine/core/atomic_file.h"
#include "engine/io/checks/kml_archive.h"
#include "engine/io/checks/xml_elements.h"
#include "engine/io/footprints/geometry_on_earth.h"
#include "engine/io/footprints/polygon_parts.h"
#include "engine/io/raster/crs_transform.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/gdal_drivers.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

// Each holds its data in one file, or beside it under its own name.
constexpr std::array<const char*, 7> vector_formats{
    "GeoJSON", "ESRI Shapefile", "GPKG", "FlatGeobuf", "LIBKML", "KML", nullptr};
constexpr std::string_view expected_file =
    "a file with outlines of buildings (GeoJSON, Shapefile, GeoPackage, FlatGeobuf, KML)";

/// The name by which GDAL opens it.
Result<std::string> checked_footprints(const fs::path& path) {
    std::error_code code;
    if (!fs::is_regular_file(path, code)) {
        return Error{fmt::format("{}: {} found, {} was expected", path.string(), kind_of_file(path),
                                 expected_file)};
    }
    const std::uintmax_t size = fs::file_size(path, code);
    if (code || size > max_footprint_bytes) {
        return Error{fmt::format("{}: {} found, a file of at most {} was expected", path.string(),
                                 size_text(static_cast<double>(size)),
                                 size_text(static_cast<double>(max_footprint_bytes)))};
    }
    auto outlines = vector_file_name(path, max_footprint_bytes);
    if (!outlines) {
        return outlines;
    }
    const auto good = check_xml(*outlines, path);
    return good ? std::move(outlines) : good.error();
}

Result<Dataset> open_footprints(const fs::path& path, const GdalMessages& messages) {
    const auto file = checked_footprints(path);
    if (!file) {
        return file.error();
    }
    Dataset dataset(GDALDataset::Open(file->c_str(),
                                      GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                      allows_external() ? nullptr : vector_formats.data()));
    if (dataset == nullptr) {
        return Error{fmt::format("{}: cannot be opened{}, {} was expected", path.string(),
                                 messages.reason(), expected_file)};
    }
    return dataset;
}

// The number of metres in "12.5" or "12.5 m".
std::optional<double> metres_in(std::string text) {
    for (const std::string_view end : {" m", "m", " "}) {
        if (text.ends_with(end)) {
            text.resize(text.size() - end.size());
            break;
        }
    }
    if (text.find_first_not_of("0123456789.+-eE") != std::string::npos) {
        return std::nullopt; // such as 0x20, which is a number to C
    }
    char* end = nullptr;
    const double number = CPLStrtod(text.c_str(), &end);
    const bool is_number = !text.empty() && end == text.c_str() + text.size();
    return is_number && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::optional<double> height_of(const OGRFeature& feature, int field) {
    const bool has_number = field >= 0 && feature.IsFieldSetAndNotNull(field) != 0 &&
                            feature.GetFieldDefnRef(field)->GetSubType() != OFSTBoolean;
    if (!has_number) {
        return std::nullopt;
    }
    return metres_in(feature.GetFieldAsString(field));
}

class FootprintReader {
public:
    FootprintReader(std::string name, const FootprintOptions& options)
        : name_(std::move(name)), options_(options) {}

    Result<void> add_layer(OGRLayer& layer, const std::stop_token& stop) {
        const OGRFeatureDefn& fields = *layer.GetLayerDefn();
        const int field =
            options_.height.empty() ? -1 : fields.GetFieldIndex(options_.height.c_str());
        has_field_ = has_field_ || field >= 0;
        for (int i = 0; i < fields.GetFieldCount(); ++i) {
            field_names_.emplace_back(fields.GetFieldDefn(i)->GetNameRef());
        }
        layer.ResetReading();
        while (OGRFeatureUniquePtr feature{layer.GetNextFeature()}) {
            if (stop.stop_requested()) {
                return Error{fmt::format("{}: reading was stopped", name_)};
            }
            if (auto added = add(*feature, field); !added) {
                return added;
            }
        }
        return {};
    }

    Result<FootprintFile> finish() {
        if (file_.footprints.empty() && !has_polygons_) {
            return Error{
                fmt::format("{}: no polygon found, outlines of buildings were expected", name_)};
        }
        if (!options_.height.empty() && !has_field_) {
            constexpr std::size_t max_names = 20;
            field_names_.resize(std::min(field_names_.size(), max_names));
            return Error{fmt::format(
                "{}: no attribute '{}' found, {} was expected", name_, options_.height,
                field_names_.empty() ? std::string("one with heights")
                                     : fmt::format("one of {}", fmt::join(field_names_, ", ")))};
        }
        return std::move(file_);
    }

private:
    Result<void> add(const OGRFeature& feature, int field) {
        const OGRGeometry* const geometry = feature.GetGeometryRef();
        if (geometry == nullptr) {
            ++file_.counts.no_polygons;
            return {};
        }
        const std::unique_ptr<OGRGeometry> placed(geometry->getLinearGeometry());
        if (placed == nullptr || !has_polygon(*placed)) {
            ++file_.counts.no_polygons;
            return {};
        }
        has_polygons_ = true;
        if (options_.on_earth) {
            if (auto known = set_crs(geometry->getSpatialReference()); !known) {
                return known;
            }
            if (!place_on_earth(*placed, *transform_)) {
                ++file_.counts.off_earth;
                return {};
            }
        }
        PolygonParts found = polygon_parts(*placed);
        if (auto good = count(found); !good) {
            return good;
        }
        const auto height = height_of(feature, field);
        if (found.parts.empty() || !is_height(height)) {
            return {};
        }
        for (building::Footprint& part : found.parts) {
            file_.footprints.push_back({std::move(part), height});
        }
        return {};
    }

    // Counts heights that are none.
    bool is_height(std::optional<double> height) {
        if (options_.height.empty()) {
            return true;
        }
        const bool is_odd = height && !(*height > 0.0 && *height <= max_building_height);
        file_.counts.no_height += static_cast<std::size_t>(!height);
        file_.counts.odd_height += static_cast<std::size_t>(is_odd);
        return height && !is_odd;
    }

    Result<void> count(const PolygonParts& found) {
        file_.counts.repaired +=
            static_cast<std::size_t>(found.is_repaired && !found.parts.empty());
        file_.counts.broken += static_cast<std::size_t>(found.broken > 0);
        file_.counts.too_large += static_cast<std::size_t>(found.too_large > 0);
        for (const building::Footprint& part : found.parts) {
            for (const building::Ring& ring : part.rings) {
                corners_ += ring.size();
            }
        }
        if (corners_ > max_footprint_corners) {
            return Error{fmt::format("{}: more than {} corners found, at most as many were "
                                     "expected",
                                     name_, max_footprint_corners)};
        }
        return {};
    }

    Result<void> set_crs(const OGRSpatialReference* crs) {
        if (crs == nullptr) {
            return Error{fmt::format("{}: names no coordinate system, one that leads to WGS 84 was "
                                     "expected",
                                     name_)};
        }
        if (transform_ && crs == crs_) {
            return {};
        }
        OGRSpatialReference from(*crs);
        from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        transform_ = CrsTransform::create(from, crs_from_text(wgs84_degrees));
        crs_ = crs;
        return transform_ ? Result<void>()
                          : Error{fmt::format("{}: its coordinate system does not lead to WGS 84, "
                                              "one that does was expected",
                                              name_)};
    }

    std::string name_;
    const FootprintOptions& options_;
    FootprintFile file_;
    std::vector<std::string> field_names_;
    std::optional<CrsTransform> transform_;
    const OGRSpatialReference* crs_ = nullptr; // of the transform
    std::size_t corners_ = 0;
    bool has_polygons_ = false;
    bool has_field_ = false;
};

} // namespace

Result<FootprintFile> read_footprints(const fs::path& path, const FootprintOptions& options,
                                      const std::stop_token& stop) {
    register_drivers();
    const GdalMessages messages;
    const auto dataset = open_footprints(path, messages);
    if (!dataset) {
        return dataset.error();
    }
    FootprintReader reader(path.string(), options);
    for (OGRLayer* layer : (*dataset)->GetLayers()) {
        if (auto added = reader.add_layer(*layer, stop); !added) {
            return added.error();
        }
    }
    return reader.finish();
}

} // namespace reljef::io
