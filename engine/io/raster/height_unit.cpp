#include "engine/io/raster/height_unit.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <ogr_spatialref.h>

namespace reljef::io {
namespace {

constexpr double us_survey_foot = 1200.0 / 3937.0;

struct Name {
    std::string_view name;
    std::string_view unit;
    double metres;
};
constexpr std::array names{
    Name{"m", "metre", 1.0},
    Name{"metre", "metre", 1.0},
    Name{"meter", "metre", 1.0},
    Name{"metres", "metre", 1.0},
    Name{"meters", "metre", 1.0},
    Name{"ft", "foot", 0.3048},
    Name{"foot", "foot", 0.3048},
    Name{"feet", "foot", 0.3048},
    Name{"international foot", "foot", 0.3048},
    Name{"us survey foot", "US survey foot", us_survey_foot},
    Name{"us survey feet", "US survey foot", us_survey_foot},
    Name{"us_survey_foot", "US survey foot", us_survey_foot},
    Name{"foot_us", "US survey foot", us_survey_foot},
    Name{"ftus", "US survey foot", us_survey_foot},
    Name{"us-ft", "US survey foot", us_survey_foot},
    Name{"km", "kilometre", 1000.0},
    Name{"kilometre", "kilometre", 1000.0},
    Name{"kilometer", "kilometre", 1000.0},
    Name{"dm", "decimetre", 0.1},
    Name{"decimetre", "decimetre", 0.1},
    Name{"decimeter", "decimetre", 0.1},
    Name{"cm", "centimetre", 0.01},
    Name{"centimetre", "centimetre", 0.01},
    Name{"centimeter", "centimetre", 0.01},
    Name{"mm", "millimetre", 0.001},
    Name{"millimetre", "millimetre", 0.001},
    Name{"millimeter", "millimetre", 0.001},
    Name{"yard", "yard", 0.9144},
    Name{"fathom", "fathom", 1.8288},
};

} // namespace

std::optional<HeightUnit> height_unit_by_name(std::string_view name) {
    std::string lower(name);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto* found = std::find_if(names.begin(), names.end(),
                                     [&](const Name& entry) { return entry.name == lower; });
    if (found == names.end()) {
        return std::nullopt;
    }
    return HeightUnit{std::string(found->unit), found->metres, true, true};
}

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

} // namespace reljef::io
