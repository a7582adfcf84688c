#pragma once

#include <stop_token>
#include <thread>

namespace reljef::cli {

/// Turns Ctrl-C (SIGINT), SIGTERM and SIGHUP into a stop request; a second one, half
/// a second later or more, ends the program at once, without tidying up.
/// Make it first thing in main(), before other threads begin.
class Interrupt {
public:
    Interrupt();

    [[nodiscard]] std::stop_token token() const { return source_.get_token(); }
    [[nodiscard]] bool requested() const { return source_.stop_requested(); }

private:
    std::stop_source source_;
    std::jthread watcher_;
};

} // namespace reljef::cli
