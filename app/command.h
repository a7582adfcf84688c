#pragma once

#include <functional>

#include "app/interrupt.h"
#include "engine/core/result.h"

namespace CLI {
class App;
}

namespace reljef::app {

/// One verb of the program: its arguments, and what runs it once they are parsed.
struct Command {
    CLI::App* arguments = nullptr; ///< owned by the program's parser
    std::function<Result<void>()> run;
};

Command add_view_command(CLI::App& program, Interrupt& interrupt);
Command add_render_command(CLI::App& program, Interrupt& interrupt);
Command add_info_command(CLI::App& program, Interrupt& interrupt);
Command add_height_command(CLI::App& program, Interrupt& interrupt);
Command add_maps_command(CLI::App& program, Interrupt& interrupt);
Command add_techniques_command(CLI::App& program, Interrupt& interrupt);

} // namespace reljef::app
