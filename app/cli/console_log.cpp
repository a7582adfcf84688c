#include "app/cli/console_log.h"

#include <array>
#include <cstddef>

#include <fmt/format.h>

#include "app/cli/message.h"
#include "app/cli/progress_line.h"

namespace reljef::cli {
namespace {

class LineTask : public session::Task {
public:
    LineTask(const std::string& label, bool quiet) : line_(label, quiet) {}
    void update(double fraction) override { line_.update(fraction); }

private:
    ProgressLine line_;
};

constexpr std::array kind_names{"note", "left out", "shown coarser"}; // by session::MessageKind

} // namespace

void ConsoleLog::message(session::MessageKind kind, std::string_view sentence) {
    if (!quiet_) {
        const auto index = static_cast<std::size_t>(kind);
        write_stderr(fmt::format("reljef: {}: {}\n", kind_names.at(index), sentence));
    }
}

std::unique_ptr<session::Task> ConsoleLog::start(const std::string& label) {
    return std::make_unique<LineTask>(label, quiet_);
}

} // namespace reljef::cli
