#include "app/cli/console_log.h"

#include <array>
#include <cstddef>

#include <fmt/format.h>

#include "app/cli/message.h"
#include "app/cli/progress_line.h"

namespace reljef::cli {
namespace {

constexpr std::array kind_names{"note", "left out", "shown coarser"}; // by session::MessageKind

} // namespace

void ConsoleLog::message(session::MessageKind kind, std::string_view sentence) {
    if (!quiet_) {
        const auto index = static_cast<std::size_t>(kind);
        write_stderr(fmt::format("reljef: {}: {}\n", kind_names.at(index), sentence));
    }
}

std::unique_ptr<session::Task> ConsoleLog::start(const std::string& label) {
    return std::make_unique<ProgressLine>(label, quiet_);
}

} // namespace reljef::cli
