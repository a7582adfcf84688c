#pragma once

#include <functional>

#include "app/cli/interrupt.h"
#include "engine/core/result.h"

namespace CLI {
class App;
}

namespace reljef::cli {

/// One verb of the program: its arguments, and what runs it once they are parsed.
struct Command {
    CLI::App* arguments = nullptr; ///< owned by the program's parser
    std::function<Result<void>()> run;
};

} // namespace reljef::cli
