#pragma once

#include <functional>

#include "app/cli/interrupt.h"
#include "engine/core/result.h"

namespace CLI {
class App;
}

namespace reljef::cli {

/// A verb of the program.
struct Command {
    CLI::App* arguments = nullptr;     ///< owned by the program's parser
    std::function<Result<void>()> run; ///< after parsing
};

} // namespace reljef::cli
