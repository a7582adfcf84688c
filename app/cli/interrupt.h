#pragma once

#include <chrono>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>

namespace reljef::cli {

/// Turns SIGINT (Ctrl-C), SIGTERM and SIGHUP into a stop request. Signals that are ignored at the
/// start, as by nohup, remain ignored. A second signal, at least half a second later, ends the
/// program at once without cleanup; the next run removes its temporary files. Construct it before
/// other threads start.
class Interrupt {
public:
    /// For end_after(): a frame in a driver. That of a slow shader takes as long as it likes.
    static constexpr std::chrono::milliseconds longest_frame{1000};

    Interrupt();

    [[nodiscard]] std::stop_token token() const { return source_.get_token(); }
    [[nodiscard]] bool requested() const { return source_.stop_requested(); }

    /// Requests a stop as a signal does, with which the program succeeds.
    void request_stop() const { source().request_stop(); }
    [[nodiscard]] std::stop_source source() const { return source_; }

    /// If the program still runs so long after the first signal or request, it removes its
    /// temporary files and ends: for work that may wait for a driver, which nothing interrupts.
    /// `time` 0: it goes on. After a signal with a message, which is written to stderr, the exit
    /// status is 1; without, that of a second signal. After a request it is 0.
    void end_after(std::chrono::milliseconds time, std::string message = {}) const;

private:
    struct Patience;
    static void watch(const std::stop_token& end, std::stop_source& source, Patience& patience);

    std::stop_source source_;
    std::shared_ptr<Patience> patience_;
    std::jthread watcher_;
};

} // namespace reljef::cli
