#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench/baselines/baseline_entry.h"
#include "bench/baselines/baseline_process.h"

namespace reljef::bench {

/// A program beside this one that draws with another library, see program/protocol.h.
struct BaselineProgram {
    std::string_view name;
    std::string_view library;
    std::string_view package; ///< of Debian
};

/// Starts it with the view's terrain. Fails as program_beside() and BaselineProcess::start().
Result<std::shared_ptr<BaselineProcess>> start_program(const BaselineProgram& program,
                                                       const BaselineView& view);

/// A row that the process draws: with its lines "view", "draw" and "depth".
BaselineEntry process_entry(const BaselineView& view, std::shared_ptr<BaselineProcess> process,
                            BaselineRow row);

/// The floats that it writes after a line, to which the file's name is added: one per pixel, by
/// rows from the top.
Result<std::vector<float>> read_numbers(const BaselineView& view, BaselineProcess& process,
                                        const std::string& line);

} // namespace reljef::bench
