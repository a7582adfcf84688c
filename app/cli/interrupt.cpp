#include "app/cli/interrupt.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <optional>

namespace reljef::cli {
namespace {

// Without those that are ignored at the start, as SIGHUP is by nohup.
sigset_t stop_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        if (::sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) {
            sigaddset(&signals, signal);
        }
    }
    return signals;
}

// Signals within this time count as one: `timeout` and some shells deliver a signal twice.
constexpr std::chrono::milliseconds one_signal{500};

void watch(const std::stop_token& end, std::stop_source& source,
           const std::atomic<std::chrono::milliseconds>& patience) {
    const sigset_t signals = stop_signals();
    const timespec pause{0, 50'000'000}; // longest delay at the program's end
    std::optional<std::chrono::steady_clock::time_point> first;
    int status = 0; // if nothing but the program itself requested the stop
    while (!end.stop_requested()) {
        const int signal = sigtimedwait(&signals, nullptr, &pause);
        const auto now = std::chrono::steady_clock::now();
        if (signal > 0 && first && now - *first > one_signal) {
            std::_Exit(128 + signal);
        }
        if (!first && (signal > 0 || source.stop_requested())) {
            first = now;
            status = signal > 0 ? 128 + signal : 0;
            source.request_stop();
        }
        const std::chrono::milliseconds longest = patience;
        if (first && longest.count() > 0 && now - *first > longest) {
            std::_Exit(status);
        }
    }
}

} // namespace

Interrupt::Interrupt()
    : patience_(
          std::make_shared<std::atomic<std::chrono::milliseconds>>(std::chrono::milliseconds(0))) {
    const sigset_t signals = stop_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    // A file that is too large and a closed pipe become errors of writing.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    watcher_ =
        std::jthread([source = source_, patience = patience_](const std::stop_token& end) mutable {
            watch(end, source, *patience);
        });
}

} // namespace reljef::cli
