#include "app/cli/console_log.h"

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

std::string_view kind_text(session::MessageKind kind) {
    switch (kind) {
    case session::MessageKind::note:
        return "note";
    case session::MessageKind::left_out:
        return "left out";
    case session::MessageKind::shown_coarser:
        return "shown coarser";
    }
    return "note";
}

} // namespace

void ConsoleLog::message(session::MessageKind kind, std::string_view sentence) {
    if (!quiet_) {
        write_stderr(fmt::format("reljef: {}: {}\n", kind_text(kind), sentence));
    }
}

std::unique_ptr<session::Task> ConsoleLog::start(const std::string& label) {
    return std::make_unique<LineTask>(label, quiet_);
}

} // namespace reljef::cli
