#include "app/comparing/compare_option.h"

#include <cstdio>

#include <fmt/format.h>

#include "app/cli/parsed_option.h"

namespace reljef::app {

void add_compare_option(CLI::App& command, CompareChoice& choice) {
    auto* const compare = command.add_option_function<std::string>(
        "--compare",
        [&choice](const std::string& text) {
            auto request = session::parse_compare_request(text);
            if (!request) {
                throw CLI::ValidationError(request.error().message);
            }
            choice.request = *request;
            choice.text = text;
        },
        "divide the picture by a line: the technique on the left; on the right 'truth', 'errors' "
        "(the truth with a colour for each pixel's error: 0.1 px violet, 1 px red, 10 px yellow; "
        "green: ground behind the true one, light blue: a hole, pink: terrain where there is sky) "
        "or "
        "another technique. Prints the errors of the view");
    compare->type_name("WHAT");
    cli::add_parsed(command, "--wipe", choice.share, cli::number_in<double>("--wipe", 0.0, 1.0),
                    "with --compare: share of the picture left of the line, 0 to 1 (0.5)", "X")
        ->needs(compare);
}

void print_figures(const CompareChoice& choice, const session::TerrainScene& scene,
                   const std::vector<session::ErrorFigures>& figures) {
    const std::string technique = scene::to_string(scene.materials().front()->technique);
    fmt::print("{}: {}\n", technique, session::to_string(figures.front()));
    if (figures.size() > 1) {
        fmt::print("{}: {}\n", choice.text, session::to_string(figures.back()));
    }
    std::fflush(stdout);
}

} // namespace reljef::app
