#include "app/cli/progress_line.h"

#include <cmath>

#include <fmt/format.h>
#include <unistd.h>

#include "app/cli/message.h"

namespace reljef::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds silence{500};
constexpr std::chrono::milliseconds between_redraws{100};

std::string time_left(double elapsed, double fraction) {
    if (fraction <= 0.0) {
        return {};
    }
    const double left = elapsed * (1.0 - fraction) / fraction;
    return left < 90.0 ? fmt::format(", {:.0f} s left", left)
                       : fmt::format(", {:.0f} min left", left / 60.0);
}

} // namespace

ProgressLine::ProgressLine(std::string label, bool quiet)
    : label_(std::move(label)), quiet_(quiet), terminal_(::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()), shown_at_(start_) {}

ProgressLine::~ProgressLine() {
    if (shown_ && terminal_) {
        write_stderr("\r\033[K");
    }
}

void ProgressLine::update(double fraction) {
    const auto now = Clock::now();
    if (quiet_ || now - start_ < silence) {
        return;
    }
    const int quarter = static_cast<int>(std::floor(4.0 * fraction));
    const bool is_due = terminal_ ? now - shown_at_ >= between_redraws : quarter > shown_quarter_;
    if (shown_ && !is_due) {
        return;
    }
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    write_stderr(fmt::format("{}{} {:.0f} %{}{}", terminal_ ? "\r\033[K" : "", label_,
                             100.0 * fraction, time_left(elapsed, fraction),
                             terminal_ ? "" : "\n"));
    shown_quarter_ = quarter;
    shown_ = true;
    shown_at_ = now;
}

} // namespace reljef::cli
