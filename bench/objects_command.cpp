#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/parsed_option.h"
#include "bench/commands.h"
#include "bench/objects/objects_suite.h"
#include "bench/options/output_options.h"
#include "bench/options/suite_arguments.h"

namespace reljef::bench {
namespace {

constexpr glm::ivec2 objects_quick_size{512, 384};

struct ObjectsChoice {
    ObjectsOptions options;
    OutputChoice outputs;
};

template <class Number>
void add_numbers(CLI::App& command, const char* name, std::vector<Number>& numbers,
                 std::pair<Number, Number> range, const char* text) {
    command
        .add_option_function<std::vector<std::string>>(
            name,
            [&numbers, range, name](const std::vector<std::string>& texts) {
                for (const std::string& each : texts) {
                    const auto number =
                        cli::number_in<Number>(name, range.first, range.second)(each);
                    if (!number) {
                        throw CLI::ValidationError(number.error().message);
                    }
                    numbers.push_back(*number);
                }
            },
            text)
        ->type_name("N")
        ->allow_extra_args(false);
}

void add_objects_options(CLI::App& command, ObjectsChoice& choice) {
    command
        .add_option("--terrain", choice.options.terrains,
                    "urban, or a scene file of bare ground with [[footprints]]; "
                    "may be repeated (urban)")
        ->type_name("TERRAIN")
        ->allow_extra_args(false);
    add_numbers<int>(command, "--city", choice.options.sizes, {16, 4096},
                     "samples a side of urban, half a metre each: more samples, more buildings; "
                     "may be repeated (256, 512 and 1024; with --quick 512)");
    add_numbers<double>(command, "--distance", choice.options.distances, {1.0, 1e6},
                        "of the eye from the middle of the city, metres; may be repeated (100, "
                        "300, 1000 and 3000; with --quick 300)");
    add_numbers<double>(command, "--down", choice.options.downs, {1.0, 90.0},
                        "degrees that the camera looks down; may be repeated (15 and 45; with "
                        "--quick 30)");
    add_suite_options(command, choice.options.suite);
    add_drawing_options(command, choice.options.suite);
    add_output_options(command, choice.outputs);
}

Result<void> run_objects_command(const ObjectsChoice& choice, const CLI::App& command,
                                 const cli::Interrupt& interrupt) {
    const auto inputs = terrain_files(choice.options.terrains);
    if (auto good = check_outputs(choice.outputs, inputs); !good) {
        return good;
    }
    ObjectsOptions options = choice.options;
    options.suite = with_quick_size(options.suite, command, objects_quick_size);
    options.suite.keep_views = !choice.outputs.html.empty();
    return report(run_objects(options, interrupt.token()), choice.outputs);
}

} // namespace

cli::Command add_objects_command(CLI::App& program, cli::Interrupt& interrupt) {
    auto* arguments = program.add_subcommand(
        "objects", "buildings as heights of the terrain and as meshes: time, memory and error");
    auto choice = std::make_shared<ObjectsChoice>();
    add_objects_options(*arguments, *choice);
    arguments->footer(
        "The same city is drawn as heights (texture, parallax, relief, exact rays, polygons), as\n"
        "meshes on the bare ground, and as meshes on a level plane. Errors are those against the\n"
        "exact picture of the meshes. A city without buildings, and a view from inside one, are\n"
        "left out with a note. With --context cpu, rays on the CPU draw exact, polygons, auto and\n"
        "meshes beside OpenGL.\n"
        "Examples:\n"
        "  reljef-bench objects --quick\n"
        "  reljef-bench objects --city 1024 --distance 500 --json objects.json --html report\n"
        "  reljef-bench objects --terrain delft.toml --down 20");
    return {arguments, [arguments, choice, &interrupt] {
                return run_objects_command(*choice, *arguments, interrupt);
            }};
}

} // namespace reljef::bench
