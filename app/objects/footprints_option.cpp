#include "app/objects/footprints_option.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/objects/assignments.h"

namespace reljef::app {
namespace {

constexpr const char* footprints_form = "FILE:height=ATTRIBUTE|surface=TERRAIN[,roof=flat|hipped]";

// Where the first key of the option begins.
std::size_t colon_before_keys(const std::string& text) {
    std::size_t first = std::string::npos;
    for (const std::string_view key : {":height=", ":surface=", ":roof="}) {
        first = std::min(first, text.find(key));
    }
    return first;
}

Result<void> set_key(io::FootprintsDescription& footprints, const Assignment& assignment) {
    const auto& [key, value] = assignment;
    if (key == "height") {
        footprints.height = value;
    } else if (key == "surface") {
        footprints.surface = value;
    } else if (key != "roof") {
        return Error{
            fmt::format("--footprints: '{}' found, height, surface or roof was expected", key)};
    } else if (value != "flat" && value != "hipped") {
        return Error{
            fmt::format("--footprints: roof '{}' found, flat or hipped was expected", value)};
    } else {
        footprints.roof = value == "flat" ? building::RoofKind::flat : building::RoofKind::hipped;
    }
    return {};
}

} // namespace

Result<io::FootprintsDescription> parse_footprints(const std::string& text) {
    const std::size_t colon = colon_before_keys(text);
    io::FootprintsDescription footprints;
    footprints.file = text.substr(0, colon);
    if (colon != std::string::npos) {
        const auto assignments = assignments_of(text.substr(colon + 1), "--footprints");
        if (!assignments) {
            return assignments.error();
        }
        for (const Assignment& assignment : *assignments) {
            if (auto set = set_key(footprints, assignment); !set) {
                return set.error();
            }
        }
    }
    if (footprints.file.empty() || footprints.height.empty() == footprints.surface.empty()) {
        return Error{
            fmt::format("--footprints: '{}' found, {} was expected", text, footprints_form)};
    }
    return footprints;
}

std::string to_text(const io::FootprintsDescription& footprints) {
    return fmt::format("{}:{}{}", footprints.file.string(),
                       footprints.surface.empty() ? "height=" + footprints.height
                                                  : "surface=" + footprints.surface.string(),
                       footprints.roof == building::RoofKind::hipped ? ",roof=hipped" : "");
}

void add_footprints_option(CLI::App& command, std::vector<io::FootprintsDescription>& footprints) {
    command
        .add_option_function<std::vector<std::string>>(
            "--footprints",
            [&footprints](const std::vector<std::string>& texts) {
                if (texts.size() > io::max_footprint_files) {
                    throw CLI::ValidationError(
                        fmt::format("--footprints: found {} times, at most {} were expected",
                                    texts.size(), io::max_footprint_files));
                }
                footprints.clear();
                for (const std::string& text : texts) {
                    auto parsed = parse_footprints(text);
                    if (!parsed) {
                        throw CLI::ValidationError(parsed.error().message);
                    }
                    footprints.push_back(std::move(*parsed));
                }
            },
            "buildings on the outlines of a vector file (GeoJSON, Shapefile, GeoPackage, "
            "FlatGeobuf, KML; others with --allow-external), in any coordinate system; may be "
            "repeated. height: attribute with metres above the lowest ground at the outline, or "
            "surface: a surface model (any TERRAIN file or folder), whose median within the "
            "outline is the roof; roof: flat (default), or hipped on convex outlines. On terrain "
            "that is not georeferenced, corners are x and y in scene metres. Example: --footprints "
            "houses.gpkg:height=h,roof=hipped")
        ->allow_extra_args(false)
        ->type_name(footprints_form);
}

} // namespace reljef::app
