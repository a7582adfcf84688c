#include "app/cli/interrupt.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <optional>
#include <utility>

#include "app/cli/message.h"
#include "engine/core/atomic_file.h"

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

} // namespace

struct Interrupt::Patience {
    std::mutex mutex; // of both
    std::chrono::milliseconds time{0};
    std::string message;

    // `status`: of a program without a message; 0: it requested the stop itself.
    void end_if_over(std::chrono::steady_clock::duration since_first, int status) {
        const std::lock_guard lock(mutex);
        if (time.count() == 0 || since_first <= time) {
            return;
        }
        remove_own_temporaries();
        write_stderr(status == 0 ? std::string() : message);
        std::_Exit(status == 0 || message.empty() ? status : 1);
    }
};

void Interrupt::watch(const std::stop_token& end, std::stop_source& source, Patience& patience) {
    const sigset_t signals = stop_signals();
    const timespec pause{0, 50'000'000}; // longest delay at the program's end
    std::optional<std::chrono::steady_clock::time_point> first;
    int status = 0;
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
        if (first) {
            patience.end_if_over(now - *first, status);
        }
    }
}

void Interrupt::end_after(std::chrono::milliseconds time, std::string message) const {
    const std::lock_guard lock(patience_->mutex);
    patience_->time = time;
    patience_->message = std::move(message);
}

Interrupt::Interrupt() : patience_(std::make_shared<Patience>()) {
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
