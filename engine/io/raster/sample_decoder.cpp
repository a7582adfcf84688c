#include "engine/io/raster/sample_decoder.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/io/checks/lowercase.h"

namespace reljef::io {
namespace {

/// Rec. 601 luma in thousandths: exact for greys.
double luminance(double red, double green, double blue) {
    return (299.0 * red + 587.0 * green + 114.0 * blue) / 1000.0;
}

const GDALColorTable* palette_of(GDALRasterBand& band) {
    const bool indexed =
        band.GetColorInterpretation() == GCI_PaletteIndex && band.GetRasterDataType() == GDT_Byte;
    return indexed ? band.GetColorTable() : nullptr;
}

std::array<double, 256> palette_values(const GDALColorTable& table) {
    std::array<double, 256> values{};
    const int count = std::min(table.GetColorEntryCount(), 256);
    for (int i = 0; i < count; ++i) {
        const GDALColorEntry* entry = table.GetColorEntry(i);
        values[static_cast<std::size_t>(i)] = luminance(entry->c1, entry->c2, entry->c3);
    }
    return values;
}

// Metres.
constexpr double highest_height = 1e8;
constexpr std::array usual_voids{-9999.0, -32768.0, -32767.0, -99999.0, -999999.0};
constexpr double usual_void_of_uint16 = 65535.0;
constexpr double isolation = 0.1; // of the void: its least distance from all other values

/// Scaled values may use all numbers of their type. A picture without a coordinate system may be
/// stretched to 65535.
std::span<const double> usual_voids_of(GDALDataset& dataset, GDALRasterBand& band, ValueKind kind) {
    const GDALDataType type = band.GetRasterDataType();
    if (kind != ValueKind::plain || band.GetScale() != 1.0 || band.GetOffset() != 0.0) {
        return {};
    }
    if (type == GDT_UInt16 && dataset.GetSpatialRef() != nullptr) {
        return {&usual_void_of_uint16, 1};
    }
    return GDALDataTypeIsFloating(type) != 0 || GDALDataTypeIsSigned(type) != 0
               ? std::span<const double>(usual_voids)
               : std::span<const double>();
}

/// The lowest numbers of Int16 are voids in any company: resampling leaves values near them.
bool is_lowest(double value) {
    return value == -32768.0 || value == -32767.0;
}

std::string count_text(std::size_t count) {
    return fmt::format("{} {}", count, count == 1 ? "sample is" : "samples are");
}

bool is_grey_ramp(const GDALColorTable& table) {
    const std::array<double, 256> values = palette_values(table);
    for (int i = 0; i < std::min(table.GetColorEntryCount(), 256); ++i) {
        if (values[static_cast<std::size_t>(i)] != i) {
            return false;
        }
    }
    return true;
}

bool is_picture(GDALRasterBand& band) {
    const GDALDataType type = band.GetRasterDataType();
    return type == GDT_Byte || type == GDT_UInt16;
}

/// The declared void, rounded to the band's type.
std::optional<double> declared_void(GDALRasterBand& band) {
    int has = 0;
    const double value = band.GetNoDataValue(&has);
    if (has == 0 || std::isnan(value)) {
        return std::nullopt;
    }
    if (band.GetRasterDataType() != GDT_Float32) {
        return value;
    }
    constexpr double max_float = std::numeric_limits<float>::max();
    return static_cast<double>(static_cast<float>(std::clamp(value, -max_float, max_float)));
}

bool declares_not_finite(GDALRasterBand& band) {
    int has = 0;
    return std::isnan(band.GetNoDataValue(&has)) && has != 0;
}

void note_kind(ValueKind kind, GDALDataset& dataset, std::vector<std::string>& notes) {
    if (kind == ValueKind::palette) {
        notes.emplace_back("palette image: the luminance of its colours is taken for heights");
    } else if (kind == ValueKind::color) {
        notes.emplace_back("colour image: its luminance is taken for heights");
    } else if (dataset.GetRasterCount() > 1 &&
               dataset.GetRasterBand(2)->GetColorInterpretation() != GCI_AlphaBand) {
        notes.push_back(
            fmt::format("has {} bands: the first is taken for heights", dataset.GetRasterCount()));
    }
}

struct UnitNames {
    std::string_view unit;
    double metres;
    std::array<std::string_view, 6> names;
};
constexpr std::array unit_names{
    UnitNames{"metre", 1.0, {"m", "metre", "meter", "metres", "meters"}},
    UnitNames{"foot", 0.3048, {"ft", "foot", "feet", "international foot"}},
    UnitNames{"US survey foot",
              1200.0 / 3937.0,
              {"us survey foot", "us survey feet", "us_survey_foot", "foot_us", "ftus", "us-ft"}},
    UnitNames{"kilometre", 1000.0, {"km", "kilometre", "kilometer"}},
    UnitNames{"decimetre", 0.1, {"dm", "decimetre", "decimeter"}},
    UnitNames{"centimetre", 0.01, {"cm", "centimetre", "centimeter"}},
    UnitNames{"millimetre", 0.001, {"mm", "millimetre", "millimeter"}},
    UnitNames{"yard", 0.9144, {"yard"}},
    UnitNames{"fathom", 1.8288, {"fathom"}},
};

std::optional<HeightUnit> height_unit_by_name(std::string_view name) {
    const std::string lower = lowercase(std::string(name));
    const auto* found = std::find_if(unit_names.begin(), unit_names.end(), [&](const auto& unit) {
        return !lower.empty() &&
               std::find(unit.names.begin(), unit.names.end(), lower) != unit.names.end();
    });
    return found != unit_names.end()
               ? std::optional(HeightUnit{std::string(found->unit), found->metres, true, true})
               : std::nullopt;
}

} // namespace

HeightUnit height_unit_of(GDALDataset& dataset, GDALRasterBand& band) {
    const std::string own = band.GetUnitType();
    if (!own.empty()) {
        const auto unit = height_unit_by_name(own);
        return unit ? *unit : HeightUnit{own, 1.0, true, false};
    }
    const OGRSpatialReference* crs = dataset.GetSpatialRef();
    if (crs == nullptr || crs->IsVertical() == 0) {
        return {};
    }
    const char* name = nullptr;
    const double metres = crs->GetTargetLinearUnits("VERT_CS", &name);
    if (name == nullptr || !(metres > 0.0)) {
        return {};
    }
    const auto unit = height_unit_by_name(name);
    return unit ? *unit : HeightUnit{name, metres, true, true};
}

ValueKind kind_of_values(GDALDataset& dataset) {
    GDALRasterBand& first = *dataset.GetRasterBand(1);
    if (const GDALColorTable* table = palette_of(first)) {
        return is_grey_ramp(*table) ? ValueKind::plain : ValueKind::palette;
    }
    const bool color = dataset.GetRasterCount() >= 3 && is_picture(first) &&
                       first.GetColorInterpretation() == GCI_RedBand;
    return color ? ValueKind::color : ValueKind::plain;
}

Result<SampleDecoder> SampleDecoder::create(GDALDataset& dataset, const std::string& name,
                                            const RasterOptions& options,
                                            std::vector<std::string>& notes) {
    GDALRasterBand& band = *dataset.GetRasterBand(1);
    const GDALDataType type = band.GetRasterDataType();
    if (type == GDT_Unknown || GDALDataTypeIsComplex(type) != 0) {
        return Error{fmt::format("{}: holds values of type {}, real numbers were expected", name,
                                 GDALGetDataTypeName(type))};
    }
    SampleDecoder decoder;
    decoder.kind_ = kind_of_values(dataset);
    decoder.encoding_ = height_encoding_of(name);
    if (decoder.encoding_ == HeightEncoding::none) {
        note_kind(decoder.kind_, dataset, notes);
    }
    if (decoder.kind_ == ValueKind::palette) {
        decoder.palette_ = palette_values(*band.GetColorTable());
    }
    decoder.nodata_ = declared_void(band);
    const double scale = band.GetScale();
    const double offset = band.GetOffset();
    for (const double value : usual_voids_of(dataset, band, decoder.kind_)) {
        const auto& voids = options.undeclared_voids;
        decoder.usual_.push_back(
            {value, !voids || std::find(voids->begin(), voids->end(), value) != voids->end()});
    }
    decoder.floating_ = GDALDataTypeIsFloating(type) != 0;
    decoder.not_finite_declared_ = declares_not_finite(band);
    const HeightUnit unit = height_unit_of(dataset, band);
    if (!unit.known) {
        notes.push_back(
            fmt::format("its unit of height \"{}\" is unknown: metres are assumed", unit.name));
    } else if (!unit.named && is_picture(band) && dataset.GetSpatialRef() == nullptr) {
        notes.emplace_back("names no unit of height: its values are taken for metres");
    }
    decoder.scale_ = scale * unit.metres * options.height_scale;
    decoder.offset_ = offset * unit.metres * options.height_scale + options.height_offset;
    return decoder;
}

double SampleDecoder::metres(double value) {
    if (nodata_ && value == *nodata_) {
        return void_value;
    }
    if (!std::isfinite(value)) {
        found_not_finite_ += not_finite_declared_ && std::isnan(value) ? 0U : 1U;
        return void_value;
    }
    for (UsualVoid& usual : usual_) {
        if (value == usual.value) {
            ++usual.found;
            return usual.is_void ? void_value : bounded(scale_ * value + offset_);
        }
    }
    return bounded(scale_ * value + offset_);
}

double SampleDecoder::of_color(double red, double green, double blue) {
    if (encoding_ == HeightEncoding::none) {
        return metres(luminance(red, green, blue));
    }
    const double height = encoded_height(encoding_, red, green, blue);
    return std::isnan(height) ? void_value : metres(height);
}

double SampleDecoder::bounded(double height) {
    if (std::abs(height) > highest_height) {
        ++found_absurd_;
        return void_value;
    }
    return height;
}

bool SampleDecoder::fits(std::span<const double> first, std::span<const double> others) const {
    return encoding_ == HeightEncoding::none || kind_ != ValueKind::color ||
           may_be_heights(first, others.first(first.size()), others.subspan(first.size()));
}

bool SampleDecoder::decode_heights(std::span<double> stored) const {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::array<double, 1 + usual_voids.size()> voids{};
    voids.fill(none);
    voids[0] = nodata_.value_or(none);
    for (std::size_t i = 0; i < usual_.size(); ++i) {
        voids.at(i + 1) = usual_[i].value;
    }
    // Plain pointers and no branches: vector code.
    double* const values = stored.data();
    int may_be_voids = 0;
    for (std::size_t i = 0; i < stored.size(); ++i) {
        may_be_voids |= std::abs(scale_ * values[i] + offset_) <= highest_height ? 0 : 1;
        for (const double value : voids) {
            may_be_voids |= values[i] == value ? 1 : 0;
        }
    }
    for (std::size_t i = 0; may_be_voids == 0 && i < stored.size(); ++i) {
        values[i] = scale_ * values[i] + offset_;
    }
    return may_be_voids == 0;
}

void SampleDecoder::decode(std::span<double> first, std::span<const double> others,
                           std::span<const unsigned char> mask) {
    if (kind_ == ValueKind::plain && mask.empty() && decode_heights(first)) {
        return;
    }
    for (std::size_t i = 0; i < first.size(); ++i) {
        const double value = first[i];
        if (!mask.empty() && mask[i] == 0) {
            first[i] = void_value;
        } else if (kind_ == ValueKind::color) {
            first[i] = of_color(value, others[i], others[first.size() + i]);
        } else if (kind_ == ValueKind::palette) {
            const auto index = static_cast<std::size_t>(clamped_int(value, 0, 255));
            first[i] = nodata_ == value ? void_value : bounded(scale_ * palette_[index] + offset_);
        } else {
            first[i] = metres(value);
        }
    }
}

SampleDecoder::FloatVoids SampleDecoder::float_voids() const {
    FloatVoids voids;
    voids.known.fill(std::numeric_limits<float>::quiet_NaN());
    voids.unknown.fill(std::numeric_limits<float>::quiet_NaN());
    std::size_t known = 0;
    if (nodata_) {
        voids.known.at(known++) = static_cast<float>(*nodata_);
    }
    for (std::size_t i = 0; i < usual_.size(); ++i) {
        const double value = usual_[i].value;
        if (value != nodata_) {
            float& place = is_lowest(value) ? voids.known.at(known++) : voids.unknown.at(i);
            place = static_cast<float>(value);
        }
    }
    return voids;
}

bool SampleDecoder::decode_floats(std::span<float> stored) const {
    const FloatVoids voids = float_voids();
    // Plain pointers and no branches: vector code.
    const auto is_any = [](float value, const auto& of) {
        int found = 0;
        for (const float one : of) {
            found |= value == one ? 1 : 0;
        }
        return found;
    };
    float* const values = stored.data();
    int found = 0;
    for (std::size_t i = 0; i < stored.size(); ++i) {
        found |= is_any(values[i], voids.unknown);
    }
    for (std::size_t i = 0; found == 0 && i < stored.size(); ++i) {
        const double height = scale_ * static_cast<double>(values[i]) + offset_;
        const int is_height = std::abs(height) <= highest_height ? 1 : 0;
        values[i] = is_height > is_any(values[i], voids.known)
                        ? static_cast<float>(height)
                        : std::numeric_limits<float>::quiet_NaN();
    }
    return found == 0;
}

std::vector<double> SampleDecoder::isolated_voids(std::span<const double> stored) const {
    const auto is_height = [&](double value) {
        return std::abs(value) <= highest_height && value != nodata_ &&
               std::none_of(usual_.begin(), usual_.end(),
                            [&](const UsualVoid& usual) { return usual.value == value; });
    };
    std::vector<double> isolated;
    for (const UsualVoid& usual : usual_) {
        const double gap = is_lowest(usual.value) ? 0.0 : isolation * std::abs(usual.value);
        if (std::none_of(stored.begin(), stored.end(), [&](double value) {
                return std::abs(value - usual.value) < gap && is_height(value);
            })) {
            isolated.push_back(usual.value);
        }
    }
    return isolated;
}

std::vector<std::string> SampleDecoder::counts_of_usual(bool voids) const {
    std::vector<std::string> counts;
    for (const UsualVoid& usual : usual_) {
        if (usual.found > 0 && usual.is_void == voids) {
            counts.push_back(fmt::format("{} {}", count_text(usual.found), usual.value));
        }
    }
    return counts;
}

std::string SampleDecoder::undeclared_voids_note(const std::string& name) const {
    std::vector<std::string> found = counts_of_usual(true);
    if (found_not_finite_ > 0) {
        found.push_back(fmt::format("{} NaN or infinite", count_text(found_not_finite_)));
    }
    if (found_absurd_ > 0) {
        found.push_back(fmt::format("{} beyond ±{} m", count_text(found_absurd_), highest_height));
    }
    return found.empty() ? ""
                         : fmt::format("{}, which {} does not declare: taken for voids",
                                       fmt::join(found, " and "), name);
}

std::string SampleDecoder::doubtful_heights_note(const std::string& name) const {
    const std::vector<std::string> found = counts_of_usual(false);
    return found.empty() ? ""
                         : fmt::format("{}, which {} does not declare as void: taken for heights",
                                       fmt::join(found, " and "), name);
}

std::vector<std::string> SampleDecoder::found_notes() const {
    std::vector<std::string> words;
    if (found_not_finite_ > 0) {
        words.emplace_back("undeclared NaN or infinity, taken for voids");
    }
    if (found_absurd_ > 0) {
        words.push_back(fmt::format("values beyond ±{} m, taken for voids", highest_height));
    }
    for (const UsualVoid& usual : usual_) {
        if (usual.found > 0) {
            words.push_back(fmt::format("undeclared {}, taken for {}", usual.value,
                                        usual.is_void ? "voids" : "heights"));
        }
    }
    return words;
}

} // namespace reljef::io
