#include "app/objects/object_option.h"

#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/parsed_option.h"
#include "app/objects/assignments.h"
#include "app/objects/footprints_option.h"

namespace reljef::app {
namespace {

constexpr const char* form = "FILE:at=LAT,LON[,height=M][,heading=DEG][,scale=S]";

Result<void> set_key(io::ObjectDescription& object, const Assignment& assignment) {
    const std::string& value = assignment.value;
    if (assignment.key == "at") {
        const auto place = parse_place(value, "--object: at");
        if (!place) {
            return place.error();
        }
        object.at = *place;
        return {};
    }
    if (assignment.key == "height") {
        return set_number(object.height, cli::number_in("--object: height", -io::max_object_height,
                                                        io::max_object_height)(value));
    }
    if (assignment.key == "heading") {
        return set_number(object.heading,
                          cli::number_in("--object: heading", -360.0, 360.0)(value));
    }
    if (assignment.key == "scale") {
        return set_number(object.scale, cli::number_in("--object: scale", io::min_object_scale,
                                                       io::max_object_scale)(value));
    }
    return Error{fmt::format("--object: '{}' found, at, height, heading or scale was expected",
                             assignment.key)};
}

} // namespace

Result<io::ObjectDescription> parse_object(const std::string& text) {
    const std::size_t colon = text.rfind(":at=");
    io::ObjectDescription object;
    object.file = text.substr(0, colon);
    if (object.file.empty()) {
        return Error{fmt::format("--object: '{}' found, {} was expected", text, form)};
    }
    if (colon == std::string::npos) {
        return object;
    }
    const auto assignments = assignments_of(text.substr(colon + 1), "--object");
    if (!assignments) {
        return assignments.error();
    }
    for (const Assignment& assignment : *assignments) {
        if (auto set = set_key(object, assignment); !set) {
            return set.error();
        }
    }
    return object;
}

std::string to_text(const io::ObjectDescription& object) {
    std::string text = object.file.string();
    if (!object.at) {
        return text;
    }
    text += fmt::format(":at={},{}", object.at->x, object.at->y);
    if (object.height != 0.0) {
        text += fmt::format(",height={}", object.height);
    }
    if (object.heading != 0.0) {
        text += fmt::format(",heading={}", object.heading);
    }
    if (object.scale != 1.0) {
        text += fmt::format(",scale={}", object.scale);
    }
    return text;
}

void add_object_options(CLI::App& command, std::vector<io::ObjectDescription>& objects,
                        std::vector<io::FootprintsDescription>& footprints) {
    command
        .add_option_function<std::vector<std::string>>(
            "--object",
            [&objects](const std::vector<std::string>& texts) {
                if (texts.size() > io::max_objects) {
                    throw CLI::ValidationError(
                        fmt::format("--object: found {} times, at most {} were expected",
                                    texts.size(), io::max_objects));
                }
                objects.clear();
                for (const std::string& text : texts) {
                    auto object = parse_object(text);
                    if (!object) {
                        throw CLI::ValidationError(object.error().message);
                    }
                    objects.push_back(std::move(*object));
                }
            },
            "mesh (OBJ, or glTF 2.0: .gltf, .glb) that stands on the terrain; may be repeated. "
            "at: latitude and longitude, or x and y in scene metres on terrain that is not "
            "georeferenced; height: of its lowest point above the ground, metres (0); heading: "
            "degrees clockwise from north (0); scale: 1e-6 to 10000 (1). If the ground keeps an "
            "error bound (--max-error), view and pictures of a path draw far objects with fewer "
            "triangles, within it. In the gallery, FILE alone is shown with every technique")
        ->allow_extra_args(false)
        ->type_name(form);
    add_footprints_option(command, footprints);
}

} // namespace reljef::app
