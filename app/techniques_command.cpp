#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/command.h"
#include "engine/scene/technique.h"

namespace reljef::app {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const scene::ParameterInfo& parameter) {
    return {{"name", parameter.name},   {"default", parameter.default_value},
            {"low", parameter.low},     {"high", parameter.high},
            {"whole", parameter.whole}, {"meaning", parameter.meaning}};
}

Json catalogue_json() {
    Json list = Json::array();
    for (const scene::TechniqueInfo& technique : scene::technique_catalogue()) {
        Json parameters = Json::array();
        for (const scene::ParameterInfo& parameter : technique.parameters) {
            parameters.push_back(to_json(parameter));
        }
        list.push_back({{"id", technique.name},
                        {"meaning", technique.meaning},
                        {"source", technique.source},
                        {"parameters", parameters}});
    }
    return list;
}

void print_text() {
    for (const scene::TechniqueInfo& technique : scene::technique_catalogue()) {
        fmt::print("{:<12} {}\n{:<12} {}\n", technique.name, technique.meaning, "",
                   technique.source);
        for (const scene::ParameterInfo& parameter : technique.parameters) {
            fmt::print("{:<12}   {}={} ({} to {}): {}\n", "", parameter.name,
                       parameter.default_value, parameter.low, parameter.high, parameter.meaning);
        }
    }
}

} // namespace

Command add_techniques_command(CLI::App& program, Interrupt& /*interrupt*/) {
    auto* arguments = program.add_subcommand("techniques", "list the ways to draw a surface");
    auto json = std::make_shared<bool>(false);
    arguments->add_flag("--json", *json, "as JSON");
    arguments->footer("Examples:\n  reljef techniques\n  reljef techniques --json");
    return {arguments, [json]() -> Result<void> {
                if (*json) {
                    fmt::print("{}\n", catalogue_json().dump(2));
                } else {
                    print_text();
                }
                return {};
            }};
}

} // namespace reljef::app
