#include "app/choice/show_option.h"

#include <fmt/format.h>

#include "app/cli/parsed_option.h"
#include "app/cli/usage_error.h"
#include "engine/scene/technique/technique.h"

namespace reljef::app {

void add_show_option(CLI::App& command, bool& shows_choice) {
    cli::add_parsed(
        command, "--show", shows_choice,
        cli::word_of<bool>("--show", {{"picture", false}, {"choice", true}}),
        "picture; choice: false colours of what auto draws: triangles orange, rays over samples "
        "blue, over coarser tiles light blue, green, yellow and pink (picture)",
        "KIND");
}

void expect_choice(bool shows_choice, const cli::ViewChoice& view, bool draws_truth) {
    const scene::TechniqueId id = session::technique_of(view).id();
    if (shows_choice && (draws_truth || id != scene::TechniqueId::automatic)) {
        cli::fail_usage(fmt::format(
            "--show: choice found with {}, --technique auto was expected, which chooses",
            draws_truth ? std::string("--truth")
                        : fmt::format("technique {}", scene::technique_info(id).name)));
    }
}

} // namespace reljef::app
