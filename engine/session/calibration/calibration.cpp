#include "engine/session/calibration/calibration.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/atomic_file.h"
#include "engine/platform/processor.h"

namespace reljef::session {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view schema = "reljef-calibration/3";
constexpr double max_cost = 1e9; // a second for a pixel

struct CostField {
    const char* name;
    double Costs::*member;
};
constexpr std::array cost_fields{CostField{"frame_ms", &Costs::frame_ms},
                                 CostField{"triangle_ns", &Costs::triangle_ns},
                                 CostField{"touched_pixel_ns", &Costs::touched_pixel_ns},
                                 CostField{"covered_pixel_ns", &Costs::covered_pixel_ns},
                                 CostField{"rays_ms", &Costs::rays_ms},
                                 CostField{"ray_pixel_ns", &Costs::ray_pixel_ns},
                                 CostField{"search_pixel_ns", &Costs::search_pixel_ns},
                                 CostField{"search_step_ns", &Costs::search_step_ns},
                                 CostField{"frame_sample_ms", &Costs::frame_sample_ms},
                                 CostField{"touched_sample_ns", &Costs::touched_sample_ns},
                                 CostField{"covered_sample_ns", &Costs::covered_sample_ns}};

struct PlaceField {
    const char* name;
    std::string CalibrationPlace::*member;
};
constexpr std::array place_fields{PlaceField{"machine", &CalibrationPlace::machine},
                                  PlaceField{"version", &CalibrationPlace::version},
                                  PlaceField{"context", &CalibrationPlace::context},
                                  PlaceField{"renderer", &CalibrationPlace::renderer}};

std::string shortened(std::string text) {
    constexpr std::size_t longest = 100;
    return text.size() > longest ? text.substr(0, longest) + "…" : text;
}

// "triangle_ns -1", or "no triangle_ns".
std::string found_text(const Json& json, const char* name) {
    if (!json.is_object() || !json.contains(name)) {
        return fmt::format("no {}", name);
    }
    return fmt::format("{} {}", name,
                       shortened(json[name].dump(-1, ' ', true, Json::error_handler_t::replace)));
}

constexpr const char* remedy = "'reljef calibrate -o FILE' measures this machine, and without "
                               "--calibration built-in costs hold";

} // namespace

CalibrationPlace place_of(const platform::RendererInfo& info, std::string version) {
    return {platform::processor_name(), std::move(version), info.context, info.renderer};
}

std::string costs_text(const Costs& costs) {
    if (costs == Costs{}) {
        return "built-in";
    }
    std::string text;
    for (const CostField& field : cost_fields) {
        std::string name = field.name;
        const std::size_t unit = name.rfind('_');
        std::replace(name.begin(), name.end(), '_', ' ');
        text += fmt::format("{}{} {:.4g} {}", text.empty() ? "" : ", ", name.substr(0, unit),
                            costs.*field.member, name.substr(unit + 1));
    }
    return text;
}

std::string to_text(const Calibration& calibration) {
    Json json{{"schema", schema}};
    for (const PlaceField& field : place_fields) {
        json[field.name] = calibration.place.*field.member;
    }
    Json& costs = json["costs"] = Json::object();
    for (const CostField& field : cost_fields) {
        costs[field.name] = calibration.costs.*field.member;
    }
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<Calibration> parse_calibration(const std::string& text, const std::string& file) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object() || !json.contains("schema") || json["schema"] != schema) {
        return Error{fmt::format("{}: {} found, a calibration of schema {} was expected; {}", file,
                                 json.is_object() ? found_text(json, "schema") : "no JSON object",
                                 schema, remedy)};
    }
    Calibration calibration;
    for (const PlaceField& field : place_fields) {
        const auto found = json.find(field.name);
        if (found == json.end() || !found->is_string()) {
            return Error{fmt::format("{}: {} found, a text was expected; {}", file,
                                     found_text(json, field.name), remedy)};
        }
        calibration.place.*field.member = found->get<std::string>();
    }
    const Json costs = json.value("costs", Json::object());
    for (const CostField& field : cost_fields) {
        const bool is_number =
            costs.is_object() && costs.contains(field.name) && costs[field.name].is_number();
        const double value = is_number ? costs[field.name].get<double>() : -1.0;
        if (!(value >= 0.0 && value <= max_cost)) {
            return Error{fmt::format("{}: {} found among its costs, a number from 0 to {:g} was "
                                     "expected; {}",
                                     file, found_text(costs, field.name), max_cost, remedy)};
        }
        calibration.costs.*field.member = value;
    }
    return calibration;
}

Result<Calibration> read_calibration(const std::filesystem::path& file) {
    const auto text = read_text_file(file);
    return text ? parse_calibration(*text, file.string()) : text.error();
}

Result<Costs> read_costs(const std::filesystem::path& file, const CalibrationPlace& here) {
    const auto calibration = read_calibration(file);
    if (!calibration) {
        return calibration.error();
    }
    for (const PlaceField& field : place_fields) {
        const std::string& found = calibration->place.*field.member;
        const std::string& expected = here.*field.member;
        if (found != expected) {
            return Error{fmt::format("{}: {} '{}' found, '{}' was expected; {}", file.string(),
                                     field.name, shortened(found), expected, remedy)};
        }
    }
    return calibration->costs;
}

} // namespace reljef::session
