#include <algorithm>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "engine/scene/technique/technique.h"

namespace reljef::app {
namespace {

using Json = nlohmann::ordered_json;

template <class Infos, class Convert> Json list_of(const Infos& infos, const Convert& json_of) {
    Json list = Json::array();
    for (const auto& info : infos) {
        list.push_back(json_of(info));
    }
    return list;
}

Json number_json(const scene::NumberInfo& number) {
    Json json{{"name", number.name},   {"default", number.default_value},
              {"low", number.low},     {"high", number.high},
              {"whole", number.whole}, {"meaning", number.meaning}};
    if (number.min_above_low > number.low) {
        json["min_above_low"] = number.min_above_low;
    }
    return json;
}

Json option_json(const scene::OptionInfo& option) {
    return {{"name", option.name},
            {"form", scene::form_of(option)},
            {"default", option.default_value},
            {"meaning", option.meaning},
            {"source", option.source},
            {"numbers", list_of(option.numbers, number_json)}};
}

Json technique_json(const scene::TechniqueInfo& technique) {
    return {{"id", technique.name},
            {"meaning", technique.meaning},
            {"source", technique.source},
            {"parameters", list_of(technique.parameters, number_json)},
            {"options", list_of(scene::options_of(technique.id), option_json)}};
}

// The names of the techniques that accept an option.
std::vector<std::string_view> takers_of(const scene::OptionInfo& option) {
    std::vector<std::string_view> takers;
    for (const scene::TechniqueInfo& technique : scene::technique_catalogue()) {
        const auto taken = scene::options_of(technique.id);
        if (std::any_of(taken.begin(), taken.end(),
                        [&](const auto& info) { return info.name == option.name; })) {
            takers.push_back(technique.name);
        }
    }
    return takers;
}

void print_number(const scene::NumberInfo& number) {
    fmt::print("{:<12}   {}={} ({} to {}): {}\n", "", number.name, number.default_value, number.low,
               number.high, number.meaning);
}

void print_options() {
    scene::Technique example{scene::Relief{}};
    example.options.shadow = scene::Shadow{.depth = 0.3};
    fmt::print("\nOptions, behind the parameters of those that take them: {}\n",
               scene::to_string(example));
    for (const scene::OptionInfo& option : scene::option_catalogue()) {
        fmt::print("{:<12} {}={} ({})\n{:<12} {}\n{:<12} with {}\n", option.name, option.name,
                   scene::form_of(option), option.default_value, "", option.meaning, "",
                   fmt::join(takers_of(option), ", "));
        for (const scene::OptionNumberInfo& number : option.numbers) {
            print_number(number);
        }
    }
}

void print_text() {
    for (const scene::TechniqueInfo& technique : scene::technique_catalogue()) {
        fmt::print("{:<12} {}\n{:<12} {}\n", technique.name, technique.meaning, "",
                   technique.source);
        for (const scene::ParameterInfo& parameter : technique.parameters) {
            print_number(parameter);
        }
    }
    print_options();
}

} // namespace

cli::Command add_techniques_command(CLI::App& program, cli::Interrupt& /*interrupt*/) {
    auto* arguments = program.add_subcommand("techniques", "list the ways to draw a surface");
    auto json = std::make_shared<bool>(false);
    arguments->add_flag("--json", *json, "print JSON");
    arguments->footer("Examples:\n  reljef techniques\n  reljef techniques --json");
    return {arguments, [json]() -> Result<void> {
                if (*json) {
                    fmt::print("{}\n",
                               list_of(scene::technique_catalogue(), technique_json).dump(2));
                } else {
                    print_text();
                }
                return {};
            }};
}

} // namespace reljef::app
