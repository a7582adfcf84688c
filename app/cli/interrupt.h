#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <stop_token>
#include <thread>

namespace reljef::cli {

/// Turns SIGINT (Ctrl-C), SIGTERM and SIGHUP into a stop request. Signals that are ignored at the
/// start, as by nohup, remain ignored. A second signal, at least half a second later, ends the
/// program at once without cleanup; the next run removes its temporary files. Construct it before
/// other threads start.
class Interrupt {
public:
    Interrupt();

    [[nodiscard]] std::stop_token token() const { return source_.get_token(); }
    [[nodiscard]] bool requested() const { return source_.stop_requested(); }

    /// Requests a stop as a signal does, with which the program succeeds.
    void request_stop() const { source().request_stop(); }
    [[nodiscard]] std::stop_source source() const { return source_; }

    /// If the program still runs so long after the first signal or request, it ends at once: for
    /// loops that may wait for a driver, which nothing interrupts. `time` > 0.
    void end_after(std::chrono::milliseconds time) const { *patience_ = time; }

private:
    std::stop_source source_;
    std::shared_ptr<std::atomic<std::chrono::milliseconds>> patience_; // 0: for ever
    std::jthread watcher_;
};

} // namespace reljef::cli
